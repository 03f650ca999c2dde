// RowIndex holds the rows along x of sorted lattice coordinates: neighbours are found by traversing rows in
// parallel, with one binary search per row instead of one per voxel.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "muslin/core/vectors.hpp"

namespace muslin {

/// Compares in the lattice's order: by y, then z, then x.
inline bool row_order(const Vec3i& a, const Vec3i& b) {
  if (a.y() != b.y()) return a.y() < b.y();
  if (a.z() != b.z()) return a.z() < b.z();
  return a.x() < b.x();
}

/// Items [begin, end) share y = j and z = k.
struct Row {
  int j = 0, k = 0;
  int begin = 0, end = 0;
};

/// Rows of coordinates sorted by row_order. Keeps a view of them.
class RowIndex {
 public:
  explicit RowIndex(std::span<const Vec3i> items);

  std::size_t size() const { return rows_.size(); }
  const Row& operator[](std::size_t r) const { return rows_[r]; }
  std::span<const Vec3i> items() const { return items_; }
  /// Returns the row at (j,k), null if it has no items.
  const Row* find(int j, int k) const;

 private:
  std::span<const Vec3i> items_;
  std::vector<Row> rows_;
};

/// Looks up ascending x in one row; an absent row is empty.
class RowCursor {
 public:
  RowCursor() = default;
  RowCursor(const RowIndex& index, int j, int k) : items_(index.items().data()) {
    if (const Row* row = index.find(j, k)) at_ = row->begin, end_ = row->end;
  }
  /// Returns the index of the item with this x, −1 if there is none. x must not be below that of the last
  /// call.
  int find(int x) {
    while (at_ < end_ && items_[at_].x() < x) ++at_;
    return at_ < end_ && items_[at_].x() == x ? at_ : -1;
  }
  /// Returns x of the first item that is not below `x`; `none` if the row has ended.
  int next(int x, int none) {
    while (at_ < end_ && items_[at_].x() < x) ++at_;
    return at_ < end_ ? items_[at_].x() : none;
  }

 private:
  const Vec3i* items_ = nullptr;
  int at_ = 0, end_ = 0;
};

}  // namespace muslin
