// MovingBoxes bounds every point of a surface by a box that moves linearly in time. Features that move
// together stay separated in such boxes, while boxes around whole displacements would overlap.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "muslin/core/vectors.hpp"

namespace muslin {

struct PointBox {
  Vec3 lower = Vec3::Zero(), upper = Vec3::Zero();  ///< [m]

  bool contains(const Vec3& x) const {
    return (x.array() >= lower.array()).all() && (x.array() <= upper.array()).all();
  }
  Vec3 middle() const { return (lower + upper) / 2; }
  Vec3 half() const { return (upper - lower) / 2; }
};

class MovingBoxes {
 public:
  explicit MovingBoxes(std::size_t count = 0) : boxes_{std::vector<PointBox>(count), {}} {
    boxes_[1] = boxes_[0];
  }

  std::size_t size() const { return boxes_[0].size(); }
  /// Call before setting all boxes.
  void restart() { moving_ = false; }
  /// Point p moves from `from` to `to`, ± `margin` [m].
  void move(std::size_t p, const Vec3& from, const Vec3& to, double margin) {
    moving_ = true;
    boxes_[0][p] = {from.array() - margin, from.array() + margin};
    boxes_[1][p] = {to.array() - margin, to.array() + margin};
  }
  /// Point p may be anywhere between `from` and `to` at any time, ± `margin` [m].
  void stay(std::size_t p, const Vec3& from, const Vec3& to, double margin) {
    boxes_[0][p] = {from.cwiseMin(to).array() - margin, from.cwiseMax(to).array() + margin};
    boxes_[1][p] = boxes_[0][p];
  }

  const PointBox& begin(std::size_t p) const { return boxes_[0][p]; }
  const PointBox& end(std::size_t p) const { return boxes_[1][p]; }
  const std::vector<PointBox>& at(int end) const { return boxes_[static_cast<std::size_t>(end)]; }
  /// Returns a box around the whole displacement.
  PointBox around(std::size_t p) const {
    const PointBox &b = begin(p), &e = end(p);
    return {b.lower.cwiseMin(e.lower), b.upper.cwiseMax(e.upper)};
  }
  /// True if any box may move.
  bool moving() const { return moving_; }

 private:
  bool moving_ = false;
  std::array<std::vector<PointBox>, 2> boxes_;
};

}  // namespace muslin
