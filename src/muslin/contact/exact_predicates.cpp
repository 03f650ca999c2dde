#include "muslin/contact/exact_predicates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "muslin/contact/expansion.hpp"
#include "muslin/contact/long_integer.hpp"

namespace muslin {
namespace {

/// Computes a·(b×c) with rows given as exact differences.
template <class Number, class Product2, class Product3>
auto determinant(const std::array<Number, 3>& a, const std::array<Number, 3>& b,
                 const std::array<Number, 3>& c, const Product2& minor, const Product3& times) {
  return times(minor(b[1], c[2], b[2], c[1]), a[0]) + times(minor(b[2], c[0], b[0], c[2]), a[1]) +
         times(minor(b[0], c[1], b[1], c[0]), a[2]);
}

int orientation_by_expansions(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  std::array<Expansion<2>, 3> u, v, w;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    u[k] = exact_difference(b[i], a[i]);
    v[k] = exact_difference(c[i], a[i]);
    w[k] = exact_difference(d[i], a[i]);
  }
  const auto minor = [](const Expansion<2>& p, const Expansion<2>& q, const Expansion<2>& r,
                        const Expansion<2>& s) { return p * q + -(r * s); };
  const auto times = [](const Expansion<16>& m, const Expansion<2>& p) { return m * p; };
  return determinant(u, v, w, minor, times).sign();
}

int orientation_by_integers(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  // All coordinates times 2^shift are whole numbers.
  int shift = -2000;
  for (const Vec3* p : {&a, &b, &c, &d}) {
    for (const double value : *p) {
      if (value == 0) continue;
      int exponent = 0;
      std::frexp(value, &exponent);
      shift = std::max(shift, 53 - std::max(exponent, -1021));
    }
  }
  std::array<LongInteger, 3> u, v, w;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const LongInteger origin(a[i], shift);
    u[k] = LongInteger(b[i], shift) - origin;
    v[k] = LongInteger(c[i], shift) - origin;
    w[k] = LongInteger(d[i], shift) - origin;
  }
  const auto minor = [](const LongInteger& p, const LongInteger& q, const LongInteger& r,
                        const LongInteger& s) { return p * q - r * s; };
  const auto times = [](const LongInteger& m, const LongInteger& p) { return m * p; };
  return determinant(u, v, w, minor, times).sign();
}

/// Neither products of three differences nor their errors leave the range of doubles: the lowest bit of such
/// a product is at least (2^−305−53)³ = 2^−1074.
bool fits_expansions(const Vec3& p) {
  for (const double value : p) {
    const double size = std::fabs(value);
    if (size > 0x1p330 || (size != 0 && size < 0x1p-305)) return false;
  }
  return true;
}

/// Returns the orientation of a b c, projected along the coordinate axis `dropped`.
int orientation_in_plane(const Vec3& a, const Vec3& b, const Vec3& c, int dropped) {
  Vec3 p = a, q = b, r = c, apex = a;
  p[dropped] = q[dropped] = r[dropped] = 0;
  apex[dropped] = 1;
  return orientation(p, q, r, apex);
}

bool lexicographically_less(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

/// Returns an axis along which three points project onto a triangle, −1 if they lie on one line.
int projection_axis(const Vec3& a, const Vec3& b, const Vec3& c) {
  for (int axis = 0; axis < 3; ++axis)
    if (orientation_in_plane(a, b, c, axis) != 0) return axis;
  return -1;
}

/// Returns true if q is on the segment p r, all three on one line.
bool between(const Vec3& p, const Vec3& q, const Vec3& r) {
  const auto ascend = [&](const Vec3& low, const Vec3& high) {
    return !lexicographically_less(q, low) && !lexicographically_less(high, q);
  };
  return ascend(p, r) || ascend(r, p);
}

bool boxes_meet(const Vec3& low_a, const Vec3& high_a, const Vec3& low_b, const Vec3& high_b) {
  return (low_a.array() <= high_b.array()).all() && (low_b.array() <= high_a.array()).all();
}

/// Segments in one plane that projects well along `axis`.
bool segments_meet_in_plane(const Segment& s, const Segment& t, int axis) {
  const auto side = [&](const Segment& line, const Vec3& p) {
    return orientation_in_plane(line[0], line[1], p, axis);
  };
  const int s0 = side(t, s[0]), s1 = side(t, s[1]), t0 = side(s, t[0]), t1 = side(s, t[1]);
  if (s0 * s1 < 0 && t0 * t1 < 0) return true;
  // Touching in an end point. For a segment that is a point, all points are on its line, and only itself
  // between its ends.
  const auto on = [](int sign, const Vec3& p, const Segment& line) {
    return sign == 0 && between(line[0], p, line[1]);
  };
  return on(s0, s[0], t) || on(s1, s[1], t) || on(t0, t[0], s) || on(t1, t[1], s);
}

/// The triangle, not flat, and the segment lie in one plane that projects well along `axis`.
bool segment_meets_triangle_in_plane(const Segment& s, const Triangle& t, int axis) {
  int inside = 0;
  for (std::size_t i = 0; i < 3; ++i) inside += orientation_in_plane(t[i], t[(i + 1) % 3], s[0], axis);
  if (inside == 3 || inside == -3) return true;
  for (std::size_t i = 0; i < 3; ++i)
    if (segments_meet_in_plane(s, {t[i], t[(i + 1) % 3]}, axis)) return true;
  return false;
}

/// As segment_meets_triangle, given the sides of the segment's ends.
bool segment_crosses_triangle(const Segment& s, const Triangle& t, int side0, int side1) {
  if (side0 * side1 > 0) return false;
  if (side0 != 0 || side1 != 0) {
    // The line pierces the plane in one point, of the segment; inside if it passes all edges on one side.
    bool left = false, right = false;
    for (std::size_t i = 0; i < 3; ++i) {
      const int turn = orientation(s[0], s[1], t[i], t[(i + 1) % 3]);
      left |= turn > 0;
      right |= turn < 0;
    }
    return !(left && right);
  }
  const int axis = projection_axis(t[0], t[1], t[2]);
  if (axis >= 0) return segment_meets_triangle_in_plane(s, t, axis);
  return segments_meet(s, {t[0], t[1]}) || segments_meet(s, {t[1], t[2]}) || segments_meet(s, {t[2], t[0]});
}

std::array<int, 3> sides(const Triangle& plane, const Triangle& points) {
  return {orientation(plane[0], plane[1], plane[2], points[0]),
          orientation(plane[0], plane[1], plane[2], points[1]),
          orientation(plane[0], plane[1], plane[2], points[2])};
}

bool all_on_one_side(const std::array<int, 3>& s) { return s[0] != 0 && s[0] == s[1] && s[1] == s[2]; }

}  // namespace

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const double yz = v.y() * w.z(), zy = v.z() * w.y();
  const double zx = v.z() * w.x(), xz = v.x() * w.z();
  const double xy = v.x() * w.y(), yx = v.y() * w.x();
  const double det = u.x() * (yz - zy) + u.y() * (zx - xz) + u.z() * (xy - yx);
  const double size = (std::fabs(yz) + std::fabs(zy)) * std::fabs(u.x()) +
                      (std::fabs(zx) + std::fabs(xz)) * std::fabs(u.y()) +
                      (std::fabs(xy) + std::fabs(yx)) * std::fabs(u.z());
  // Shewchuk's bound is (7 + 56 ε) ε, ε = 2^−53; products that underflow add at most 2^−1074 each, times |u|.
  const double error = 8e-16 * size + 1e-320 * (u.cwiseAbs().sum() + 1);
  if (det > error && det <= std::numeric_limits<double>::max()) return 1;
  if (-det > error && -det <= std::numeric_limits<double>::max()) return -1;
  if (fits_expansions(a) && fits_expansions(b) && fits_expansions(c) && fits_expansions(d))
    return size == 0 ? 0 : orientation_by_expansions(a, b, c, d);
  return orientation_by_integers(a, b, c, d);
}

bool segments_meet(const Segment& s, const Segment& t) {
  if (orientation(s[0], s[1], t[0], t[1]) != 0) return false;
  int axis = projection_axis(s[0], s[1], t[0]);
  if (axis < 0) axis = projection_axis(s[0], s[1], t[1]);
  if (axis < 0) axis = projection_axis(t[0], t[1], s[0]);
  if (axis < 0) axis = projection_axis(t[0], t[1], s[1]);
  if (axis >= 0) return segments_meet_in_plane(s, t, axis);
  // All on one line: their order along it is that of the coordinates.
  return between(t[0], s[0], t[1]) || between(t[0], s[1], t[1]) || between(s[0], t[0], s[1]);
}

bool segment_meets_triangle(const Segment& s, const Triangle& t) {
  return segment_crosses_triangle(s, t, orientation(t[0], t[1], t[2], s[0]),
                                  orientation(t[0], t[1], t[2], s[1]));
}

bool triangles_meet(const Triangle& s, const Triangle& t) {
  if (!boxes_meet(s[0].cwiseMin(s[1]).cwiseMin(s[2]), s[0].cwiseMax(s[1]).cwiseMax(s[2]),
                  t[0].cwiseMin(t[1]).cwiseMin(t[2]), t[0].cwiseMax(t[1]).cwiseMax(t[2])))
    return false;
  const std::array<int, 3> of_t = sides(s, t);
  if (all_on_one_side(of_t)) return false;
  const std::array<int, 3> of_s = sides(t, s);
  if (all_on_one_side(of_s)) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if (segment_crosses_triangle({s[i], s[j]}, t, of_s[i], of_s[j]) ||
        segment_crosses_triangle({t[i], t[j]}, s, of_t[i], of_t[j]))
      return true;
  }
  return false;
}

bool triangles_meet_beyond_vertex(const Vec3& v, const Segment& ab, const Segment& cd) {
  // The triangles are convex: with p they share the segment v p, which leaves one of them through the edge
  // opposite to v.
  return segment_meets_triangle(ab, {v, cd[0], cd[1]}) || segment_meets_triangle(cd, {v, ab[0], ab[1]});
}

bool triangles_meet_beyond_edge(const Segment& uv, const Vec3& a, const Vec3& b) {
  if (orientation(uv[0], uv[1], a, b) != 0) return false;
  int axis = projection_axis(uv[0], uv[1], a);
  if (axis < 0) axis = projection_axis(uv[0], uv[1], b);
  if (axis < 0) return false;
  return orientation_in_plane(uv[0], uv[1], a, axis) * orientation_in_plane(uv[0], uv[1], b, axis) > 0;
}

}  // namespace muslin
