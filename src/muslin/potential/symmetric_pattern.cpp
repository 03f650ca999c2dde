#include "muslin/potential/symmetric_pattern.hpp"

#include <algorithm>
#include <cassert>

#include "muslin/core/index.hpp"

namespace muslin {

SymmetricPattern::SymmetricPattern(std::vector<std::pair<int, int>> pairs, std::size_t vertex_count) {
  for (auto& [row, column] : pairs)
    if (row > column) std::swap(row, column);
  for (std::size_t v = 0; v < vertex_count; ++v) pairs.emplace_back(static_cast<int>(v), static_cast<int>(v));
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  first_.assign(vertex_count + 1, 0);
  first_mirrored_ = first_;
  columns_.reserve(pairs.size());
  for (const auto& [row, column] : pairs) {
    ++first_[at(row) + 1];
    if (row != column) ++first_mirrored_[at(column) + 1];
    columns_.push_back(column);
  }
  for (std::size_t v = 0; v < vertex_count; ++v) {
    first_[v + 1] += first_[v];
    first_mirrored_[v + 1] += first_mirrored_[v];
  }
  mirrored_.resize(at(first_mirrored_.back()));
  std::vector<int> next = first_mirrored_;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto& [row, column] = pairs[k];
    if (row != column) mirrored_[at(next[at(column)]++)] = {static_cast<int>(k), row};
  }
}

int SymmetricPattern::find(int row, int column) const {
  const auto begin = columns_.begin() + first_[at(row)], end = columns_.begin() + first_[at(row) + 1];
  const auto found = std::lower_bound(begin, end, column);
  assert(found != end && *found == column);
  return static_cast<int>(found - columns_.begin());
}

}  // namespace muslin
