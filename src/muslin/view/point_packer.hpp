// Points over time in few bytes: 16-bit numbers over the box of their whole motion, as differences from what
// the frames before and the neighbours let expect.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "muslin/cache/point_cache.hpp"

namespace muslin {

/// Packs frame after frame of the same points. A coordinate x becomes q = round(65535 (x − low) / size), so
/// that what is shown lies within size / 131070 of x. Of q, per frame and axis, the record holds
///
///   1 byte     how q was predicted: bit 0 set: along a straight line through the two frames before, else as
///              in the frame before; bit 1 set: and by as much beside it as the point before in the list
///   #P bytes   low bytes of the differences, signs folded in: 0, −1, 1, −2, … become 0, 1, 2, 3, …
///   #P bytes   their high bytes
///
/// with the way that gives the smallest differences. Differences are taken modulo 2¹⁶. The frames before the
/// first are zero.
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
