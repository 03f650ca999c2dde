// PointPacker compresses moving points: 16-bit numbers over the box of their whole motion, as differences
// from a prediction made from earlier frames and neighbours.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "muslin/cache/point_cache.hpp"

namespace muslin {

/// Packs frame after frame of the same points. A coordinate x becomes q = round(65535 (x − low) / size), so
/// that the shown value is within size / 131070 of x. Per frame and axis the record holds, of q,
///
///   1 byte     prediction of q: bit 0 set: along a straight line through the two frames before, else as
///              in the frame before; bit 1 set: plus the deviation of the point before in the list
///   #P bytes   low bytes of the differences, signs folded in: 0, −1, 1, −2, … become 0, 1, 2, 3, …
///   #P bytes   their high bytes
///
/// with the prediction that gives the smallest differences. Differences are taken modulo 2¹⁶. The frames
/// before the first are zero.
class PointPacker {
 public:
  PointPacker(const Vec3& low, const Vec3& size, std::size_t points);
  /// Appends the record of a frame. Points must lie in the box.
  void append(const std::vector<Vec3f>& points, std::string& record);

 private:
  using Words = std::vector<std::uint16_t>;
  Vec3 low_, scale_;
  std::array<Words, 3> before_, earlier_;  // by axis, the last frame and the one before it
  int frames_ = 0;
};

}  // namespace muslin
