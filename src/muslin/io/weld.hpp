// Welder merges the corners of formats that store each face, or each side of a seam, separately.
#pragma once

#include <vector>

#include "muslin/core/vectors.hpp"

namespace muslin {

/// Gives equal positions (bit for bit, except that −0 equals 0) one vertex, in order of first appearance.
class Welder {
 public:
  /// Vertices are appended to `positions`; vertices that are already there are not merged with new ones.
  explicit Welder(std::vector<Vec3>& positions) : positions_(positions), slots_(64, -1) {}
  /// Returns the vertex at this position, which must be finite.
  int vertex(const Vec3& position);
  /// Starts a new set: later positions are not merged with earlier ones.
  void start_anew();

 private:
  std::size_t slot(const Vec3& position) const;

  std::vector<Vec3>& positions_;
  std::vector<int> slots_;  // open addressing; −1 empty
  std::size_t used_ = 0;
};

}  // namespace muslin
