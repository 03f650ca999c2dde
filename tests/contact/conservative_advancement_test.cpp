// The time of closest approach: never too late, against a search that proves its answer; not much too early.
#include "muslin/contact/conservative_advancement.hpp"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace muslin {
namespace {

using Four = std::array<Vec3, 4>;

Four at_time(const Four& x, const Four& u, double t) {
  Four y;
  for (std::size_t i = 0; i < 4; ++i) y[i] = x[i] + t * u[i];
  return y;
}

double distance_at(PairKind kind, const Four& x, const Four& u, double t) {
  return closest_points(kind, at_time(x, u, t)).distance();
}

/// The smallest distance over [0, end], to within `tolerance`, by bisection of time: over an interval it is
/// no less than half of d(begin) + d(end) − length · speed.
double smallest_distance(PairKind kind, const Four& x, const Four& u, double end, double tolerance) {
  double speed = 0;
  const auto first = static_cast<std::size_t>(first_feature_size(kind));
  for (std::size_t i = 0; i < first; ++i)
    for (std::size_t j = first; j < 4; ++j) speed = std::max(speed, (u[i] - u[j]).norm());
  double best = std::min(distance_at(kind, x, u, 0), distance_at(kind, x, u, end));
  struct Interval {
    double begin, end, at_begin, at_end;
  };
  std::vector<Interval> open = {{0, end, distance_at(kind, x, u, 0), distance_at(kind, x, u, end)}};
  while (!open.empty()) {
    const Interval i = open.back();
    open.pop_back();
    if ((i.at_begin + i.at_end - (i.end - i.begin) * speed) / 2 >= best - tolerance) continue;
    const double middle = (i.begin + i.end) / 2, d = distance_at(kind, x, u, middle);
    best = std::min(best, d);
    open.push_back({i.begin, middle, i.at_begin, d});
    open.push_back({middle, i.end, d, i.at_end});
  }
  return best;
}

/// Random pairs of every kind of trouble; u ends somewhere, x is where it starts.
void make_pair(PairKind kind, int trouble, std::mt19937_64& random, Four& x, Four& u) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&](double size) {
    return Vec3(size * Vec3(unit(random), unit(random), unit(random)));
  };
  for (std::size_t i = 0; i < 4; ++i) {
    x[i] = vector(1);
    u[i] = vector(2);
  }
  const std::size_t first = kind == PairKind::vertex_triangle ? 1 : 2;
  switch (trouble) {
    case 1:  // heading exactly for each other's middle
      for (std::size_t i = 0; i < first; ++i) u[i] = (x[2] + x[3]) - 2 * x[i];
      break;
    case 2:  // nearly flat, grazing
      for (std::size_t i = 0; i < 4; ++i) {
        x[i].y() = i < first ? 1e-3 : 0;
        u[i].y() *= 1e-3;
      }
      break;
    case 3:  // parallel edges, needles
      x[1] = x[0] + (x[3] - x[2]);
      u[1] = u[0];
      break;
    case 4:  // fast and far
      for (Vec3& v : u) v *= 100;
      break;
    case 5:  // everything in one plane, all the time
      for (std::size_t i = 0; i < 4; ++i) x[i].y() = u[i].y() = 0;
      break;
    case 6:  // small and far from the origin
      for (std::size_t i = 0; i < 4; ++i) {
        x[i] = 1e-3 * x[i] + Vec3(1e3, -1e3, 1e3);
        u[i] *= 1e-3;
      }
      break;
    case 7:  // a common motion a thousand times larger than the relative one
      for (Vec3& v : u) v += Vec3(1000, 500, -300);
      break;
    default:
      break;
  }
}

class SafeFractionOf : public ::testing::TestWithParam<PairKind> {};

TEST_P(SafeFractionOf, NeverAllowsLessThanTheRequiredDistance) {
  std::mt19937_64 random(7);
  int stopped = 0, free = 0, early = 0;
  for (int trial = 0; trial < 1200; ++trial) {
    Four x, u;
    make_pair(GetParam(), trial % 8, random, x, u);
    const double start = distance_at(GetParam(), x, u, 0);
    const double required = (trial % 16 < 8 ? 0.3 : 0.001) * start;
    if (start < 1e-6) continue;  // they overlap, in one plane
    const double t = safe_fraction(GetParam(), x, u, required, 0.1 * required);
    ASSERT_GE(t, 0);
    ASSERT_LE(t, 1);
    const double tolerance = 1e-3 * required;
    const double reached = smallest_distance(GetParam(), x, u, t, tolerance);
    ASSERT_GE(reached, required * (1 - 1e-9) - 1e-11) << "trial " << trial << " t " << t;
    if (t < 1) {
      EXPECT_GT(t, 0) << "trial " << trial;
      ++stopped;
      // It stops because it is close, not because it gave up.
      if (distance_at(GetParam(), x, u, t) > 1.11 * required) ++early;
    } else {
      ++free;
    }
  }
  EXPECT_GT(stopped, 150);
  EXPECT_GT(free, 150);
  EXPECT_EQ(early, 0);
}

TEST_P(SafeFractionOf, DoesNotLimitSeparationAndSliding) {
  std::mt19937_64 random(8);
  for (int trial = 0; trial < 500; ++trial) {
    Four x, u;
    make_pair(GetParam(), 0, random, x, u);
    const ClosestPoints c = closest_points(GetParam(), x);
    const double d = c.distance();
    if (d < 1e-3) continue;
    const Vec3 n = c.difference / d;
    const auto first = static_cast<std::size_t>(first_feature_size(GetParam()));
    for (std::size_t i = 0; i < 4; ++i) {
      u[i] -= n.dot(u[i]) * n;         // along the separating plane
      if (i < first) u[i] += 0.1 * n;  // and slowly away from it
    }
    EXPECT_EQ(safe_fraction(GetParam(), x, u, d * (1 - 1e-6), 1e-4), 1) << "trial " << trial;
  }
}

INSTANTIATE_TEST_SUITE_P(Pairs, SafeFractionOf,
                         ::testing::Values(PairKind::vertex_triangle, PairKind::edge_edge),
                         [](const auto& kind) {
                           return kind.param == PairKind::vertex_triangle ? "VertexTriangle" : "EdgeEdge";
                         });

TEST(SafeFraction, StopsABulletBeforeASheet) {
  const Four x = {Vec3(0.2, 1, 0.2), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)};
  const Four u = {Vec3(0, -1000, 0), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  const double t = safe_fraction(PairKind::vertex_triangle, x, u, 1e-3, 1e-4);
  EXPECT_NEAR(t, 0.999e-3, 1.1e-7);
  EXPECT_LT(t, 0.999e-3 + 1e-12);
}

}  // namespace
}  // namespace muslin
