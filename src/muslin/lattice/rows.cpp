#include "muslin/lattice/rows.hpp"

#include <algorithm>

namespace muslin {

RowIndex::RowIndex(std::span<const Vec3i> items) : items_(items) {
  const int count = static_cast<int>(items.size());
  for (int begin = 0; begin < count;) {
    int end = begin + 1;
    while (end < count && items[end].y() == items[begin].y() && items[end].z() == items[begin].z()) ++end;
    rows_.push_back({items[begin].y(), items[begin].z(), begin, end});
    begin = end;
  }
}

const Row* RowIndex::find(int j, int k) const {
  const auto row = std::lower_bound(rows_.begin(), rows_.end(), Row{j, k}, [](const Row& a, const Row& b) {
    return a.j != b.j ? a.j < b.j : a.k < b.k;
  });
  return row != rows_.end() && row->j == j && row->k == k ? &*row : nullptr;
}

}  // namespace muslin
