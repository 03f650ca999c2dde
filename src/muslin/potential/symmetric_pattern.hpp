// SymmetricPattern lists the 3×3 blocks of a symmetric matrix between the vertices of a mesh: one for every
// pair of vertices that share an element, and the diagonal ones.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace muslin {

/// Only blocks of the diagonal and the upper triangle are stored; row v reads blocks of earlier rows
/// transposed.
class SymmetricPattern {
 public:
  /// `pairs`: first and second vertex, in any order and number.
  SymmetricPattern(std::vector<std::pair<int, int>> pairs, std::size_t vertex_count);

  std::size_t vertex_count() const { return first_.size() - 1; }
  std::size_t block_count() const { return columns_.size(); }
  /// Row v has blocks first()[v] … first()[v+1] − 1: the diagonal one, then those of later columns,
  /// ascending.
  const std::vector<int>& first() const { return first_; }
  const std::vector<int>& columns() const { return columns_; }
  /// Returns the block of a row and a column not before it, which must exist.
  int find(int row, int column) const;

  /// A block of an earlier row whose column is this row.
  struct Mirrored {
    int block, row;
  };
  /// Row v has the transposes of mirrored()[first_mirrored()[v]] … [first_mirrored()[v+1] − 1].
  const std::vector<int>& first_mirrored() const { return first_mirrored_; }
  const std::vector<Mirrored>& mirrored() const { return mirrored_; }

  std::size_t bytes() const {
    return (first_.capacity() + columns_.capacity() + first_mirrored_.capacity()) * sizeof(int) +
           mirrored_.capacity() * sizeof(Mirrored);
  }

 private:
  std::vector<int> first_, columns_, first_mirrored_;
  std::vector<Mirrored> mirrored_;
};

}  // namespace muslin
