// The exact predicates against integer arithmetic: orientation to the last bit, intersections of triangles by
// separating axes on small grids where nearly everything is degenerate, sizes at both ends of the doubles.
#include "muslin/contact/exact_predicates.hpp"

#include <cmath>
#include <cstdint>
#include <random>

#include <gtest/gtest.h>

namespace muslin {
namespace {

using Int3 = std::array<std::int64_t, 3>;

Vec3 as_vector(const Int3& p, double unit = 1) {
  return unit * Vec3(static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2]));
}
Int3 minus(const Int3& a, const Int3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Int3 cross(const Int3& a, const Int3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
std::int64_t dot(const Int3& a, const Int3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

__extension__ using Wide = __int128;

int exact_orientation(const Int3& a, const Int3& b, const Int3& c, const Int3& d) {
  const Int3 u = minus(b, a), v = minus(c, a), w = minus(d, a);
  const auto minor = [&](std::size_t i, std::size_t j) {
    return static_cast<Wide>(v[i]) * w[j] - static_cast<Wide>(v[j]) * w[i];
  };
  const Wide det = u[0] * minor(1, 2) + u[1] * minor(2, 0) + u[2] * minor(0, 1);
  return det > 0 ? 1 : det < 0 ? -1 : 0;
}

TEST(Orientation, IsExactForPointsNextToAPlane) {
  std::mt19937_64 random(1);
  std::uniform_int_distribution<std::int64_t> coordinate(-(1LL << 38), 1LL << 38), step(-1, 1);
  std::uniform_real_distribution<double> weight(-0.5, 0.5);
  int zeros = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    Int3 a, b, c, d;
    const double s = weight(random), t = trial % 2 == 0 ? weight(random) : 0;
    for (std::size_t i = 0; i < 3; ++i) {
      a[i] = coordinate(random);
      b[i] = trial % 3 == 0 ? a[i] + step(random) * 5 : coordinate(random);
      c[i] = coordinate(random);
      const double on_plane = static_cast<double>(a[i]) + s * static_cast<double>(b[i] - a[i]) +
                              t * static_cast<double>(c[i] - a[i]);
      d[i] = std::llround(on_plane) + (trial % 5 == 0 ? 0 : step(random));
    }
    const int expected = exact_orientation(a, b, c, d);
    zeros += expected == 0 ? 1 : 0;
    for (const double unit : {1.0, 0x1p-340, 0x1p280, 0x1p980, 0x1p-1074}) {
      const Vec3 p = as_vector(a, unit), q = as_vector(b, unit), r = as_vector(c, unit),
                 s4 = as_vector(d, unit);
      ASSERT_EQ(orientation(p, q, r, s4), expected) << trial << " unit " << unit;
      ASSERT_EQ(orientation(q, p, r, s4), -expected) << trial << " unit " << unit;
      ASSERT_EQ(orientation(s4, r, q, p), expected) << trial << " unit " << unit;
    }
  }
  EXPECT_GT(zeros, 50);  // else the test says little
}

TEST(Orientation, IsExactForTheLargestAndTheSmallestDoubles) {
  const double huge = 1.7e308, tiny = 5e-324;
  EXPECT_EQ(orientation({0, 0, 0}, {huge, 0, 0}, {0, huge, 0}, {0, 0, tiny}), 1);
  EXPECT_EQ(orientation({0, 0, 0}, {huge, 0, 0}, {0, huge, 0}, {0, 0, -tiny}), -1);
  EXPECT_EQ(orientation({0, 0, 0}, {tiny, 0, 0}, {0, tiny, 0}, {0, 0, tiny}), 1);
  EXPECT_EQ(orientation({-huge, -huge, 0}, {huge, -huge, 0}, {huge, huge, 0}, {1, 1, tiny}), 1);
  EXPECT_EQ(orientation({-huge, -huge, 0}, {huge, -huge, 0}, {huge, huge, 0}, {1, 1, 0}), 0);
  // x + y + z = 1 but for what rounding takes away.
  EXPECT_EQ(orientation({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {huge, -huge, 1}), 0);
  EXPECT_EQ(orientation({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {huge, -huge, 1 + 0x1p-52}), 1);
  EXPECT_EQ(orientation({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1e-200, -1e-200, 1 - 0x1p-53}), -1);
}

using IntTriangle = std::array<Int3, 3>;

/// Two convex sets with corners at integers are disjoint exactly if an axis separates them: one of the
/// normals of their Minkowski difference, or, if that is flat, of its sides within its plane or line.
bool separated(const IntTriangle& s, const IntTriangle& t) {
  std::vector<Int3> directions, axes;
  for (std::size_t i = 0; i < 3; ++i) {
    directions.push_back(minus(s[(i + 1) % 3], s[i]));
    directions.push_back(minus(t[(i + 1) % 3], t[i]));
  }
  for (const Int3& p : s)
    for (const Int3& q : t) directions.push_back(minus(p, q));
  axes = directions;
  for (const Int3& p : directions)
    for (const Int3& q : directions) axes.push_back(cross(p, q));
  const std::size_t normals = axes.size();
  for (std::size_t i = directions.size(); i < normals; ++i)
    for (std::size_t j = 0; j < 6; ++j) axes.push_back(cross(axes[i], directions[j]));
  for (const Int3& axis : axes) {
    std::array<std::int64_t, 4> range = {INT64_MAX, INT64_MIN, INT64_MAX, INT64_MIN};
    for (std::size_t i = 0; i < 3; ++i) {
      range[0] = std::min(range[0], dot(axis, s[i]));
      range[1] = std::max(range[1], dot(axis, s[i]));
      range[2] = std::min(range[2], dot(axis, t[i]));
      range[3] = std::max(range[3], dot(axis, t[i]));
    }
    if (range[1] < range[2] || range[3] < range[0]) return true;
  }
  return false;
}

class OnAGrid : public ::testing::TestWithParam<int> {};

TEST_P(OnAGrid, TrianglesMeetExactlyIfNoAxisSeparatesThem) {
  std::mt19937_64 random(static_cast<std::uint64_t>(GetParam()));
  std::uniform_int_distribution<std::int64_t> coordinate(-GetParam(), GetParam());
  std::uniform_int_distribution<int> kind(0, 9);
  int met = 0;
  const int trials = 3000;
  for (int trial = 0; trial < trials; ++trial) {
    IntTriangle s, t;
    const int flat = kind(random);  // often in one plane, sometimes needles and points
    for (IntTriangle* triangle : {&s, &t}) {
      for (Int3& corner : *triangle)
        for (std::size_t i = 0; i < 3; ++i) corner[i] = static_cast<int>(i) == flat ? 0 : coordinate(random);
      if (kind(random) == 0) (*triangle)[1] = (*triangle)[0];
      if (kind(random) == 0) (*triangle)[2] = (*triangle)[1];
    }
    const bool expected = !separated(s, t);
    met += expected ? 1 : 0;
    for (const double unit : {1.0, 1e-3, 0x1p-1070, 0x1p1000}) {
      // 1e-3 rounds, but only by multiples of the same whole numbers for |coordinate| ≤ 3: keep powers of
      // two.
      const double scale = unit == 1e-3 ? 0x1p-10 : unit;
      const Triangle p = {as_vector(s[0], scale), as_vector(s[1], scale), as_vector(s[2], scale)};
      const Triangle q = {as_vector(t[0], scale), as_vector(t[1], scale), as_vector(t[2], scale)};
      ASSERT_EQ(triangles_meet(p, q), expected) << "trial " << trial << " scale " << scale;
      ASSERT_EQ(triangles_meet(q, p), expected) << "trial " << trial << " scale " << scale;
      const Segment edge = {p[0], p[1]};
      ASSERT_EQ(segment_meets_triangle(edge, q), !separated({s[0], s[1], s[1]}, t)) << trial;
      ASSERT_EQ(segments_meet(edge, {q[0], q[1]}), !separated({s[0], s[1], s[1]}, {t[0], t[1], t[1]}))
          << trial;
    }
  }
  EXPECT_GT(met, trials / 20);
  EXPECT_LT(met, trials);
}

INSTANTIATE_TEST_SUITE_P(Sizes, OnAGrid, ::testing::Values(1, 2, 3, 20));

Segment segment(const Vec3& a, const Vec3& b) { return {a, b}; }

TEST(TrianglesThatShareAVertex, MeetBeyondItIfOneCutsTheOther) {
  const Vec3 v(0, 0, 0);
  const Segment ab = segment({2, 0, 0}, {0, 2, 0});
  EXPECT_TRUE(triangles_meet_beyond_vertex(v, ab, segment({0.5, 0.5, -1}, {0.5, 0.5, 1})));
  EXPECT_TRUE(triangles_meet_beyond_vertex(v, ab, segment({9, 9, -1}, {9, 9, 1})));  // cut by the edge a b
  EXPECT_FALSE(triangles_meet_beyond_vertex(v, ab, segment({-1, -1, -1}, {-1, -1, 1})));
  EXPECT_FALSE(triangles_meet_beyond_vertex(v, ab, segment({1, 1, 1}, {2, 2, 1})));
  EXPECT_TRUE(triangles_meet_beyond_vertex(v, ab, segment({1, 1, 0}, {-2, 2, 1})));   // an edge within
  EXPECT_TRUE(triangles_meet_beyond_vertex(v, ab, segment({1, 0.5, 0}, {3, 2, 0})));  // in one plane
  EXPECT_FALSE(triangles_meet_beyond_vertex(v, ab, segment({-1, 0, 0}, {0, -2, 0})));
  EXPECT_TRUE(triangles_meet_beyond_vertex(v, ab, segment({1, 0, 0}, {0, -2, 0})));  // along an edge
}

TEST(TrianglesThatShareAnEdge, MeetBeyondItOnlyWhenFoldedFlat) {
  const Segment uv = segment({0, 0, 0}, {1, 0, 0});
  EXPECT_FALSE(triangles_meet_beyond_edge(uv, {0.5, 1, 0}, {0.5, -1, 0}));
  EXPECT_TRUE(triangles_meet_beyond_edge(uv, {0.5, 1, 0}, {0.2, 1e-9, 0}));
  EXPECT_FALSE(triangles_meet_beyond_edge(uv, {0.5, 1, 0}, {0.2, 1, 1e-300}));
}

}  // namespace
}  // namespace muslin
