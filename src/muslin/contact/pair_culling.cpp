#include "muslin/contact/pair_culling.hpp"

#include <algorithm>
#include <cmath>

#include "muslin/contact/feature_lanes.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/core/vector_code.hpp"

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wpsabi"  // the ABI of vectors is irrelevant in inlined code
#endif

namespace muslin {
namespace {

constexpr std::size_t grain = 512;

/// Eight vectors.
struct Lanes3 {
  Float8 x, y, z;
};
MUSLIN_INLINE Lanes3 minus(const Lanes3& a, const Lanes3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
MUSLIN_INLINE Lanes3 times(const Float8& s, const Lanes3& a) { return {s * a.x, s * a.y, s * a.z}; }
MUSLIN_INLINE Float8 dot(const Lanes3& a, const Lanes3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
MUSLIN_INLINE Lanes3 cross(const Lanes3& a, const Lanes3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
MUSLIN_INLINE Float8 larger(const Float8& a, const Float8& b) { return a > b ? a : b; }
MUSLIN_INLINE Float8 smaller(const Float8& a, const Float8& b) { return a < b ? a : b; }
MUSLIN_INLINE Float8 magnitude(const Float8& a) { return larger(a, -a); }
MUSLIN_INLINE Lanes3 select(const Int8& mask, const Lanes3& a, const Lanes3& b) {
  return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}
constexpr float tiny = 1e-30F;

/// Returns p − the nearest point of the segment a … a + u, w = p − a.
MUSLIN_INLINE Lanes3 to_segment(const Lanes3& w, const Lanes3& u) {
  const Float8 zero = {}, one = zero + 1;
  const Float8 t = smaller(larger(dot(u, w) / larger(dot(u, u), zero + tiny), zero), one);
  return minus(w, times(t, u));
}

MUSLIN_INLINE void keep_nearer(const Lanes3& d, Lanes3& best, Float8& square) {
  const Float8 s = dot(d, d);
  const Int8 nearer = s < square;
  best = select(nearer, d, best);
  square = nearer ? s : square;
}

/// Finds the point of the triangle x[1], x[2], x[3] closest to x[0].
MUSLIN_INLINE Lanes3 vertex_triangle(const Lanes3* x) {
  const Float8 zero = {}, one = zero + 1;
  const Lanes3 u = minus(x[2], x[1]), v = minus(x[3], x[1]), w = minus(x[0], x[1]);
  const Lanes3 n = cross(u, v);
  const Float8 area = larger(dot(n, n), zero + tiny);
  const Float8 s = dot(cross(w, v), n) / area, t = dot(cross(u, w), n) / area;
  Lanes3 best = to_segment(w, u);
  Float8 square = dot(best, best);
  keep_nearer(to_segment(w, v), best, square);
  keep_nearer(to_segment(minus(x[0], x[2]), minus(x[3], x[2])), best, square);
  return select((s >= zero) & (t >= zero) & (s + t <= one), times(dot(w, n) / area, n), best);
}

/// Finds the closest points of the edges x[0] x[1] and x[2] x[3].
MUSLIN_INLINE Lanes3 edge_edge(const Lanes3* x) {
  const Float8 zero = {}, one = zero + 1;
  const Lanes3 u = minus(x[1], x[0]), v = minus(x[3], x[2]), r = minus(x[0], x[2]);
  const Lanes3 n = cross(u, v);
  const Float8 area = larger(dot(n, n), zero + tiny);
  const Float8 s = -dot(cross(r, v), n) / area, t = -dot(cross(r, u), n) / area;
  Lanes3 best = to_segment(r, v);
  Float8 square = dot(best, best);
  keep_nearer(to_segment(minus(x[1], x[2]), v), best, square);
  const Lanes3 back = to_segment(minus(x[2], x[0]), u), back1 = to_segment(minus(x[3], x[0]), u);
  keep_nearer(minus(Lanes3{}, back), best, square);
  keep_nearer(minus(Lanes3{}, back1), best, square);
  const Int8 inside = (s >= zero) & (s <= one) & (t >= zero) & (t <= one) & (area > zero + tiny);
  return select(inside, times(dot(r, n) / area, n), best);
}

}  // namespace

void PairCulling::set_points(const ContactSurface& surface, ConstVectors at, const MovingBoxes& boxes) {
  Box all;
  for (std::size_t p = 0; p < at.size(); ++p) {
    const PointBox around = boxes.around(p);
    all.extend(at[p]);
    all.extend(around.lower);
    all.extend(around.upper);
  }
  centre_ = all.isEmpty() ? Vec3(Vec3::Zero()) : all.center();
  // About ten roundings of coordinates of twice this size.
  rounding_ = all.isEmpty() ? 0 : static_cast<float>(4e-6 * all.sizes().maxCoeff());
  moving_ = boxes.moving();
  points_.resize(at.size());
  parallel_for(at.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      for (int k = 0; k < 3; ++k) points_[p].at[k] = static_cast<float>(at[p][k] - centre_[k]);
      points_[p].radius = static_cast<float>(surface.radius_of(static_cast<int>(p)));
      set_box(p, boxes);
    }
  });
}

void PairCulling::set_boxes(std::span<const std::uint8_t> moved, const MovingBoxes& boxes) {
  double farthest = 0;
  for (std::size_t p = 0; p < moved.size(); ++p) {
    if (moved[p] == 0) continue;
    set_box(p, boxes);
    const PointBox around = boxes.around(p);
    farthest = std::max({farthest, (around.lower - centre_).cwiseAbs().maxCoeff(),
                         (around.upper - centre_).cwiseAbs().maxCoeff()});
  }
  rounding_ = std::max(rounding_, static_cast<float>(4e-6 * farthest));
}

void PairCulling::set_box(std::size_t p, const MovingBoxes& boxes) {
  Point& point = points_[p];
  for (int e = 0; e < 2; ++e) {
    const PointBox& box = boxes.at(e)[p];
    const Vec3 middle = box.middle() - centre_, half = box.half();
    for (int k = 0; k < 3; ++k) {
      point.middle[e][k] = static_cast<float>(middle[k]);
      point.half[e][k] = static_cast<float>(half[k]);
    }
  }
}

namespace {

/// The extent of four points along n, of which the first are of feature A: min n·a − max n·b.
template <PairKind kind>
MUSLIN_INLINE Float8 separation(const Lanes3& n, const Lanes3* x, const Float8* half) {
  constexpr int size_a = first_feature_size(kind);
  Float8 a = dot(n, x[0]) - half[0], b = dot(n, x[3]) + half[3];
  for (int i = 1; i < 3; ++i) {
    if (i < size_a) {
      a = smaller(a, dot(n, x[i]) - half[i]);
    } else {
      b = larger(b, dot(n, x[i]) + half[i]);
    }
  }
  return a - b;
}

/// One group of eight pairs, whose point i is corners[i]: least distances, negative if they cannot come near.
template <PairKind kind, int ends, class Point>
MUSLIN_INLINE Float8 near_lanes(const Point* const (*corners)[lane_count], float reach, float rounding) {
  Lanes3 at[4], middle[ends][4], half[ends][4];
  Float8 radius[2];
  for (int i = 0; i < 4; ++i) {
    for (int l = 0; l < lane_count; ++l) {
      const Point& p = *corners[i][l];
      at[i].x[l] = p.at[0], at[i].y[l] = p.at[1], at[i].z[l] = p.at[2];
      for (int e = 0; e < ends; ++e) {
        Lanes3 &m = middle[e][i], &h = half[e][i];
        m.x[l] = p.middle[e][0], m.y[l] = p.middle[e][1], m.z[l] = p.middle[e][2];
        h.x[l] = p.half[e][0], h.y[l] = p.half[e][1], h.z[l] = p.half[e][2];
      }
      if (i == 0) radius[0][l] = p.radius;
      if (i == 3) radius[1][l] = p.radius;
    }
  }
  Lanes3 n;
  if constexpr (kind == PairKind::vertex_triangle) {
    n = vertex_triangle(at);
  } else {
    n = edge_edge(at);
  }
  const Lanes3 extent = {magnitude(n.x), magnitude(n.y), magnitude(n.z)};
  const Float8 zero = {}, none[4] = {};
  // The least distance along one direction is concave in time: no less than at its ends.
  Float8 gap = zero + INFINITY;
  for (int e = 0; e < ends; ++e) {
    Float8 width[4];
    for (int i = 0; i < 4; ++i) width[i] = dot(extent, half[e][i]);
    gap = smaller(gap, separation<kind>(n, middle[e], width));
  }
  const Float8 r = radius[0] + radius[1] + (reach + rounding), square = dot(n, n);
  const Int8 far = (gap > zero) & (gap * gap > r * r * square);
  Float8 length = zero;
  for (int l = 0; l < lane_count; ++l) length[l] = std::sqrt(square[l]);
  const Float8 apart = separation<kind>(n, at, none) / larger(length, zero + tiny) - rounding;
  return far ? zero - 1 : larger(apart, zero);
}

template <PairKind kind, int ends, class Point>
MUSLIN_INLINE void find_lanes(const Point* points, const std::array<int, 4>* pairs, std::size_t count,
                              float reach, float rounding, float* distance) {
  for (std::size_t first = 0; first < count; first += lane_count) {
    const auto used = static_cast<int>(std::min<std::size_t>(lane_count, count - first));
    const Point* corners[4][lane_count];
    for (int l = 0; l < lane_count; ++l) {
      const std::array<int, 4>& pair = pairs[first + static_cast<std::size_t>(std::min(l, used - 1))];
      for (std::size_t i = 0; i < 4; ++i) corners[i][l] = points + pair[i];
    }
    const Float8 least = near_lanes<kind, ends>(corners, reach, rounding);
    for (int l = 0; l < used; ++l) distance[first + static_cast<std::size_t>(l)] = least[l];
  }
}

template <class Point>
MUSLIN_VECTOR_CODE void find_vertex_triangle(const Point* points, const std::array<int, 4>* pairs,
                                             std::size_t count, float reach, float rounding,
                                             float* distance) {
  find_lanes<PairKind::vertex_triangle, 1>(points, pairs, count, reach, rounding, distance);
}
template <class Point>
MUSLIN_VECTOR_CODE void find_edge_edge(const Point* points, const std::array<int, 4>* pairs,
                                       std::size_t count, float reach, float rounding, float* distance) {
  find_lanes<PairKind::edge_edge, 1>(points, pairs, count, reach, rounding, distance);
}
template <class Point>
MUSLIN_VECTOR_CODE void find_moving_vertex_triangle(const Point* points, const std::array<int, 4>* pairs,
                                                    std::size_t count, float reach, float rounding,
                                                    float* distance) {
  find_lanes<PairKind::vertex_triangle, 2>(points, pairs, count, reach, rounding, distance);
}
template <class Point>
MUSLIN_VECTOR_CODE void find_moving_edge_edge(const Point* points, const std::array<int, 4>* pairs,
                                              std::size_t count, float reach, float rounding,
                                              float* distance) {
  find_lanes<PairKind::edge_edge, 2>(points, pairs, count, reach, rounding, distance);
}

}  // namespace

void PairCulling::find_near(PairKind kind, std::span<const std::array<int, 4>> pairs, double reach,
                            float* distance) const {
  const auto r = static_cast<float>(reach * (1 + 1e-6));
  const auto find = kind == PairKind::vertex_triangle
                        ? (moving_ ? find_moving_vertex_triangle<Point> : find_vertex_triangle<Point>)
                        : (moving_ ? find_moving_edge_edge<Point> : find_edge_edge<Point>);
  find(points_.data(), pairs.data(), pairs.size(), r, rounding_, distance);
}

}  // namespace muslin
