#include "muslin/potential/block_matrix.hpp"

#include <algorithm>
#include <cassert>

#include "muslin/core/parallel.hpp"
#include "muslin/core/vector_code.hpp"

namespace muslin {
namespace {

constexpr std::size_t grain = 256;  // rows

MUSLIN_VECTOR_CODE double add_rows(const int* first, const int* columns, const Float4* blocks, Floats p,
                                   Floats y, std::size_t begin, std::size_t end) {
  double sum = 0;
  for (std::size_t v = begin; v < end; ++v) {
    Float4 a = {0, 0, 0, 0}, b = a;
    const int row_end = first[v + 1];
    int k = first[v];
    for (; k + 1 < row_end; k += 2) {
      const Float4* c = blocks + 3 * static_cast<std::size_t>(k);
      const int i = columns[k], j = columns[k + 1];
      a += c[0] * p.x[i] + c[1] * p.y[i] + c[2] * p.z[i];
      b += c[3] * p.x[j] + c[4] * p.y[j] + c[5] * p.z[j];
    }
    if (k < row_end) {
      const Float4* c = blocks + 3 * static_cast<std::size_t>(k);
      const int i = columns[k];
      a += c[0] * p.x[i] + c[1] * p.y[i] + c[2] * p.z[i];
    }
    a += b;
    y.x[v] += a[0];
    y.y[v] += a[1];
    y.z[v] += a[2];
    sum += static_cast<double>(p.x[v]) * a[0] + static_cast<double>(p.y[v]) * a[1] +
           static_cast<double>(p.z[v]) * a[2];
  }
  return sum;
}

}  // namespace

BlockPattern::BlockPattern(std::vector<std::pair<int, int>> pairs, std::size_t vertex_count) {
  const std::size_t given = pairs.size();
  pairs.reserve(2 * given + vertex_count);
  for (std::size_t i = 0; i < given; ++i) pairs.emplace_back(pairs[i].second, pairs[i].first);
  for (std::size_t v = 0; v < vertex_count; ++v) pairs.emplace_back(static_cast<int>(v), static_cast<int>(v));
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  first_.assign(vertex_count + 1, 0);
  columns_.reserve(pairs.size());
  for (const auto& [row, column] : pairs) {
    ++first_[static_cast<std::size_t>(row) + 1];
    if (row == column) diagonal_.push_back(static_cast<int>(columns_.size()));
    columns_.push_back(column);
  }
  for (std::size_t v = 0; v < vertex_count; ++v) first_[v + 1] += first_[v];
}

int BlockPattern::find(int row, int column) const {
  const auto begin = columns_.begin() + first_[static_cast<std::size_t>(row)];
  const auto end = columns_.begin() + first_[static_cast<std::size_t>(row) + 1];
  const auto at = std::lower_bound(begin, end, column);
  assert(at != end && *at == column);
  return static_cast<int>(at - columns_.begin());
}

void BlockMatrix::reset(std::shared_ptr<const BlockPattern> pattern, std::size_t first) {
  pattern_ = std::move(pattern);
  first_ = first;
  columns_.resize(3 * pattern_->block_count());
  constexpr std::size_t columns_per_block = 1 << 16;
  parallel_for(columns_.size(), columns_per_block, [&](std::size_t begin, std::size_t end) {
    std::fill(columns_.data() + begin, columns_.data() + end, Float4{0, 0, 0, 0});
  });
}

double BlockMatrix::add_product(Floats p, Floats y) const {
  return parallel_sum(pattern_->vertex_count(), grain, 0.0, [&](std::size_t begin, std::size_t end) {
    return add_rows(pattern_->first().data(), pattern_->columns().data(), columns_.data(), p, y, begin, end);
  });
}

void BlockMatrix::add_diagonal(Floats upper, Floats lower) const {
  parallel_for(pattern_->vertex_count(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const Float4* c = block(pattern_->diagonal()[v]);
      upper.x[v] += c[0][0];
      upper.y[v] += c[1][0];
      upper.z[v] += c[2][0];
      lower.x[v] += c[1][1];
      lower.y[v] += c[2][1];
      lower.z[v] += c[2][2];
    }
  });
}

}  // namespace muslin
