#include "muslin/geometry/ear_clipping.hpp"

#include <algorithm>
#include <cmath>

#include "muslin/geometry/mesh.hpp"

namespace muslin {
namespace {

constexpr int clipped = -1;  // as next_ of a corner that is gone

double area2(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

bool in_closed_triangle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& point) {
  return area2(a, b, point) >= 0 && area2(b, c, point) >= 0 && area2(c, a, point) >= 0;
}

}  // namespace

// Dropping the largest axis of the normal is an affine map on the polygon's plane, so it preserves convexity
// and inclusion, and keeps the coordinates exact.
bool EarClipping::project(ConstVectors positions, std::span<const int> face) {
  const Vec3 normal = newell_normal(positions, face);
  int axis = 2;
  if (normal.allFinite()) normal.cwiseAbs().maxCoeff(&axis);
  int u = (axis + 1) % 3, v = (axis + 2) % 3;
  if (normal[axis] < 0) std::swap(u, v);
  points_.resize(face.size());
  for (std::size_t c = 0; c < face.size(); ++c) {
    const Vec3& position = positions[static_cast<std::size_t>(face[c])];
    points_[c] = {position[u], position[v]};
  }
  bool convex = true;
  double turned = 0;
  const std::size_t n = face.size();
  for (std::size_t c = 0; c < n && convex; ++c) {
    const Vec2 in = points_[(c + 1) % n] - points_[c], out = points_[(c + 2) % n] - points_[(c + 1) % n];
    const double cross = in.x() * out.y() - in.y() * out.x();
    convex = cross > 0;
    turned += std::atan2(cross, in.dot(out));
  }
  return convex && turned < 3 * EIGEN_PI;  // a star turns left everywhere, but more than once around
}

double EarClipping::turn(int corner) const {
  const auto c = static_cast<std::size_t>(corner);
  return area2(points_[static_cast<std::size_t>(previous_[c])], points_[c],
               points_[static_cast<std::size_t>(next_[c])]);
}

std::size_t EarClipping::bucket(const Vec2& point) const {
  const auto cell = [&](int axis) {
    const double at = (point[axis] - grid_origin_[axis]) * cells_per_length_[axis];
    return at > 0 ? static_cast<std::size_t>(std::min(at, cells_ - 1.0)) : std::size_t{0};
  };
  return cell(1) * static_cast<std::size_t>(cells_) + cell(0);
}

void EarClipping::fill_buckets() {
  std::size_t count = 0;
  Eigen::AlignedBox2d box;
  for (std::size_t c = 0; c < points_.size(); ++c) {
    count += blocking_[c] ? 1 : 0;
    box.extend(points_[c]);
  }
  cells_ = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count) / 2 + 1)));
  grid_origin_ = box.min();
  for (int axis = 0; axis < 2; ++axis) {
    const double size = box.sizes()[axis];
    cells_per_length_[axis] = std::isfinite(size) && size > 0 ? cells_ / size : 0;
    if (!std::isfinite(cells_per_length_[axis])) cells_per_length_[axis] = 0;
  }
  bucket_end_.assign(static_cast<std::size_t>(cells_) * static_cast<std::size_t>(cells_) + 1, 0);
  for (std::size_t c = 0; c < points_.size(); ++c)
    if (blocking_[c]) ++bucket_end_[bucket(points_[c]) + 1];
  for (std::size_t b = 1; b < bucket_end_.size(); ++b) bucket_end_[b] += bucket_end_[b - 1];
  in_bucket_.resize(count);
  for (std::size_t c = 0; c < points_.size(); ++c)
    if (blocking_[c])
      in_bucket_[static_cast<std::size_t>(bucket_end_[bucket(points_[c])]++)] = static_cast<int>(c);
}

// An ear turns left and holds no other corner. Only corners that are not strictly convex need to be looked
// at: if any corner lies in the triangle, one of those does.
bool EarClipping::is_ear(int corner, Rule rule) const {
  const int before = previous_[static_cast<std::size_t>(corner)],
            after = next_[static_cast<std::size_t>(corner)];
  const Vec2 &a = points_[static_cast<std::size_t>(before)], &b = points_[static_cast<std::size_t>(corner)],
             &c = points_[static_cast<std::size_t>(after)];
  if (!(area2(a, b, c) > 0)) return false;
  const std::size_t low = bucket(a.cwiseMin(b).cwiseMin(c)), high = bucket(a.cwiseMax(b).cwiseMax(c));
  const auto width = static_cast<std::size_t>(cells_);
  for (std::size_t row = low / width; row <= high / width; ++row) {
    const std::size_t first = row * width + low % width, last = row * width + high % width;
    const int begin = first == 0 ? 0 : bucket_end_[first - 1], end = bucket_end_[last];
    for (int entry = begin; entry < end; ++entry) {
      const int other = in_bucket_[static_cast<std::size_t>(entry)];
      if (!blocking_[static_cast<std::size_t>(other)] || other == before || other == corner || other == after)
        continue;
      const Vec2& point = points_[static_cast<std::size_t>(other)];
      // The two sides of a slit to a hole share points: they block each other only under the strict rule.
      if (rule == Rule::touching && (point == a || point == b || point == c)) continue;
      if (in_closed_triangle(a, b, c, point)) return false;
    }
  }
  return true;
}

void EarClipping::clip(int corner) {
  const auto c = static_cast<std::size_t>(corner);
  const int before = previous_[c], after = next_[c];
  next_[static_cast<std::size_t>(before)] = after;
  previous_[static_cast<std::size_t>(after)] = before;
  next_[c] = clipped;
  blocking_[c] = 0;
  for (const int neighbour : {before, after}) {
    if (turn(neighbour) > 0) {
      blocking_[static_cast<std::size_t>(neighbour)] = 0;
      queue_.push_back(neighbour);
    }
  }
}

// A cut changes its two neighbours only, so every corner is tested once and then after each cut beside it.
// When no candidate is left, all corners are tried again: first with the weaker rule, at last by cutting
// off any corner. The number of such rounds is limited, so that malicious outlines terminate.
int EarClipping::next_ear(int any, Rule& rule, int& rounds) {
  for (;;) {
    while (head_ < queue_.size()) {
      const int corner = queue_[head_++];
      if (next_[static_cast<std::size_t>(corner)] != clipped && is_ear(corner, rule)) {
        found_since_round_ = true;
        return corner;
      }
    }
    if (rounds == 0) return any;
    --rounds;
    const bool hopeless = rule == Rule::touching && !found_since_round_;
    rule = Rule::touching;
    found_since_round_ = false;
    queue_.clear();
    head_ = 0;
    int corner = any;
    do {
      queue_.push_back(corner);
      corner = next_[static_cast<std::size_t>(corner)];
    } while (corner != any);
    if (hopeless) return any;
  }
}

void EarClipping::cut(ConstVectors positions, std::span<const int> face, std::span<Vec3i> triangles) {
  const std::size_t n = face.size();
  if (project(positions, face)) {
    for (std::size_t t = 0; t < n - 2; ++t) triangles[t] = {face[0], face[t + 1], face[t + 2]};
    return;
  }
  previous_.resize(n);
  next_.resize(n);
  blocking_.resize(n);
  queue_.resize(n);
  head_ = 0;
  found_since_round_ = false;
  for (std::size_t c = 0; c < n; ++c) {
    previous_[c] = static_cast<int>((c + n - 1) % n);
    next_[c] = static_cast<int>((c + 1) % n);
    queue_[c] = static_cast<int>(c);
  }
  for (std::size_t c = 0; c < n; ++c) blocking_[c] = !(turn(static_cast<int>(c)) > 0);
  fill_buckets();

  int corner = 0, rounds = 64;
  Rule rule = Rule::strict;
  for (std::size_t t = 0; t < n - 2; ++t) {
    if (t + 3 < n) corner = next_ear(corner, rule, rounds);
    const int before = previous_[static_cast<std::size_t>(corner)],
              after = next_[static_cast<std::size_t>(corner)];
    triangles[t] = {face[static_cast<std::size_t>(before)], face[static_cast<std::size_t>(corner)],
                    face[static_cast<std::size_t>(after)]};
    clip(corner);
    corner = after;
  }
}

}  // namespace muslin
