#include "muslin/solver/block_matrix.hpp"

#include <algorithm>
#include <cassert>

namespace muslin {

BlockPattern::BlockPattern(std::vector<std::pair<int, int>> pairs, std::size_t node_count) {
  const std::size_t given = pairs.size();
  pairs.reserve(2 * given + node_count);
  for (std::size_t i = 0; i < given; ++i) pairs.emplace_back(pairs[i].second, pairs[i].first);
  for (std::size_t v = 0; v < node_count; ++v) pairs.emplace_back(static_cast<int>(v), static_cast<int>(v));
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  first_.assign(node_count + 1, 0);
  columns_.reserve(pairs.size());
  for (const auto& [row, column] : pairs) {
    ++first_[static_cast<std::size_t>(row) + 1];
    if (row == column) diagonal_.push_back(static_cast<int>(columns_.size()));
    columns_.push_back(column);
  }
  for (std::size_t v = 0; v < node_count; ++v) first_[v + 1] += first_[v];
}

int BlockPattern::find(int row, int column) const {
  const auto begin = columns_.begin() + first_[static_cast<std::size_t>(row)];
  const auto end = columns_.begin() + first_[static_cast<std::size_t>(row) + 1];
  const auto at = std::lower_bound(begin, end, column);
  assert(at != end && *at == column);
  return static_cast<int>(at - columns_.begin());
}

void BlockMatrix::reset(const BlockPattern& pattern) {
  columns_.resize(3 * pattern.block_count());
  std::fill(columns_.data(), columns_.data() + columns_.size(), Float4{0, 0, 0, 0});
}

}  // namespace muslin
