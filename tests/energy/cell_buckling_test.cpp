// Compressed threads buckle: the relaxed energy is the least over the strains that folds take up, convex with
// continuous stresses, elastic under tension; folds across the mesh cost a quarter of the elastic energy at
// most.
#include "muslin/energy/cell_buckling.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "muslin/energy/measured_membrane.hpp"
#include "muslin/energy/membrane_energy.hpp"
#include "muslin/energy/shell_bending.hpp"
#include "muslin/geometry/triangulated_strip.hpp"

namespace muslin {
namespace {

constexpr double area = 2e-4;
/// Loads of 1 and 2 N/m.
constexpr Threads threads{110, 24, 65, area, 2 * area};

double elastic(double e1, double e2) {
  return 0.5 * (threads.c11 * e1 * e1 + 2 * threads.c12 * e1 * e2 + threads.c22 * e2 * e2);
}

/// The least over w, by minimising over one component at a time.
double relaxed(double e1, double e2) {
  const double n1 = threads.load_warp / area, n2 = threads.load_weft / area;
  double w1 = 0, w2 = 0;
  for (int i = 0; i < 200; ++i) {
    w1 = std::max(0.0, (-n1 - threads.c12 * (e2 + w2)) / threads.c11 - e1);
    w2 = std::max(0.0, (-n2 - threads.c12 * (e1 + w1)) / threads.c22 - e2);
  }
  return elastic(e1 + w1, e2 + w2) + n1 * w1 + n2 * w2;
}

double energy(double e1, double e2) { return 0.5 * state_of(threads, area, e1, e2).twice_energy; }

TEST(CellBuckling, EnergyIsTheLeastOverTheStrainsOfFolds) {
  int buckled = 0;
  for (double e1 = -0.4; e1 < 0.4; e1 += 0.013) {
    for (double e2 = -0.4; e2 < 0.4; e2 += 0.017) {
      const double least = relaxed(e1, e2), whole = elastic(e1, e2);
      EXPECT_NEAR(energy(e1, e2), (1 - elastic_share) * least + elastic_share * whole, 1e-12)
          << e1 << " " << e2;
      if (least < whole) ++buckled;
    }
  }
  EXPECT_GT(buckled, 1000);
}

TEST(CellBuckling, StressAndModuliAreItsDerivatives) {
  constexpr double d = 1e-6;
  for (double e1 = -0.301; e1 < 0.3; e1 += 0.037) {
    for (double e2 = -0.302; e2 < 0.3; e2 += 0.041) {
      const ThreadState at = state_of(threads, area, e1, e2);
      const ThreadState right = state_of(threads, area, e1 + d, e2),
                        left = state_of(threads, area, e1 - d, e2);
      const ThreadState up = state_of(threads, area, e1, e2 + d), down = state_of(threads, area, e1, e2 - d);
      EXPECT_NEAR(at.uu, (right.twice_energy - left.twice_energy) / (4 * d), 1e-6);
      EXPECT_NEAR(at.vv, (up.twice_energy - down.twice_energy) / (4 * d), 1e-6);
      EXPECT_NEAR(at.c11, (right.uu - left.uu) / (2 * d), 1e-6);
      EXPECT_NEAR(at.c12, (right.vv - left.vv) / (2 * d), 1e-6);
      EXPECT_NEAR(at.c22, (up.vv - down.vv) / (2 * d), 1e-6);
      EXPECT_GE(at.c11, 0);
      EXPECT_GE(at.c11 * at.c22, at.c12 * at.c12);
    }
  }
}

TEST(CellBuckling, StressesAreContinuousWhereThreadsBuckle) {
  // Along lines through all four states; a jump would not shrink with the steps.
  const double steepest = threads.c11 + threads.c12 + threads.c22;
  for (double angle = 0; angle < 6.3; angle += 0.1) {
    const double step = 1e-5;
    for (double r = 0; r < 0.3; r += step) {
      const ThreadState a = state_of(threads, area, r * std::cos(angle), r * std::sin(angle)),
                        b = state_of(threads, area, (r + step) * std::cos(angle),
                                     (r + step) * std::sin(angle));
      ASSERT_LE(std::abs(b.uu - a.uu), steepest * step) << angle << " " << r;
      ASSERT_LE(std::abs(b.vv - a.vv), steepest * step) << angle << " " << r;
    }
  }
}

TEST(CellBuckling, WithoutLimitOrUnderTensionIsElasticToTheBit) {
  const double infinite = buckling_load(BucklingRigidity().warp);
  for (const double e1 : {-0.3, 0.0, 0.2}) {
    for (const double e2 : {-0.4, 0.1}) {
      const ThreadState state = state_of({110, 24, 65, infinite, infinite}, area, e1, e2);
      EXPECT_EQ(state.uu, threads.c11 * e1 + threads.c12 * e2);
      EXPECT_EQ(state.twice_energy,
                threads.c11 * (e1 * e1) + 2 * threads.c12 * (e1 * e2) + threads.c22 * (e2 * e2));
      EXPECT_EQ(state.c12, threads.c12);
    }
  }
  EXPECT_EQ(state_of(threads, area, 0.2, 0.1).vv, threads.c12 * 0.2 + threads.c22 * 0.1);
}

TEST(CellBuckling, ThreadsWithoutStiffnessStayWithoutStress) {
  for (const Threads& slack :
       {Threads{0, 0, 65, area, area}, Threads{110, 0, 0, 0, 0}, Threads{0, 0, 0, 0, 0}}) {
    for (const double e1 : {-0.3, 0.2}) {
      for (const double e2 : {-0.4, 0.1}) {
        const ThreadState state = state_of(slack, area, e1, e2);
        EXPECT_TRUE(std::isfinite(state.twice_energy + state.uu + state.vv + state.c11 + state.c22));
        EXPECT_GE(state.twice_energy, 0);
        if (slack.c11 == 0) {
          EXPECT_EQ(state.uu, 0);
        }
        if (slack.c22 == 0) {
          EXPECT_EQ(state.vv, 0);
        }
      }
    }
  }
}

class FoldAcrossTheMesh : public testing::TestWithParam<const char*> {};

/// Waves of a developable sheet, sampled at the vertices: the real fabric stores bending alone. Chords of the
/// mesh are shorter than the arcs, so that an elastic membrane stores many times the energy of bending. What
/// is left is an upper bound: in equilibrium vertices move to where it is less.
TEST_P(FoldAcrossTheMesh, StoresLittleOfTheElasticEnergy) {
  constexpr double rigidity = 2.5e-6, stretch = 6125, shear = 17;  // a light silk
  constexpr double length = 0.36, wave = 0.12;
  Mesh mesh = triangulated_strip(GetParam(), 36, 1.0 / 3, false);  // edges of 1 cm
  for (Vec3& p : mesh.positions) p *= length;
  const Vec3 across(std::cos(0.6), std::sin(0.6), 0), along(-across.y(), across.x(), 0);
  double dearest = 0, elastic_dearest = 0;
  for (const double steepest : {0.2, 0.5, 1.0}) {
    // The angle of slope is steepest · sin(k s): integrated by the midpoint rule.
    const double k = 2 * std::numbers::pi / wave;
    std::vector<Vec3> x;
    for (const Vec3& p : mesh.positions) {
      const double s = p.dot(across);
      const int parts = 2000;
      Vec3 at = p.dot(along) * along;
      for (int i = 0; i < parts; ++i) {
        const double slope = steepest * std::sin(k * (i + 0.5) * s / parts);
        at += s / parts * (std::cos(slope) * across + std::sin(slope) * Vec3::UnitZ());
      }
      x.push_back(at);
    }
    const Shell shell = build_shell(mesh, mesh.positions, {Vec3::UnitX()});
    const MembraneModuli moduli{stretch, stretch, shear, 0.25};
    const double bent = ShellBending(shell, BendingModuli{rigidity, rigidity, rigidity, 0.25}).value(x);
    // A sheet that shrinks a little has no triangle under tension.
    const auto least = [&](const MembraneEnergy& membrane) {
      double energy = membrane.value(x);
      for (double shrunk = 0.999; shrunk > 0.96; shrunk -= 0.001) {
        std::vector<Vec3> small = x;
        for (Vec3& p : small) p *= shrunk;
        energy = std::min(energy, membrane.value(small));
      }
      return energy / bent;
    };
    dearest = std::max(dearest, least(MembraneEnergy(shell, moduli, nullptr, {rigidity, rigidity})));
    elastic_dearest = std::max(elastic_dearest, least(MembraneEnergy(shell, moduli)));
  }
  EXPECT_GT(elastic_dearest, 10);
  EXPECT_LT(dearest, elastic_dearest / 4);
}

INSTANTIATE_TEST_SUITE_P(Meshes, FoldAcrossTheMesh,
                         testing::Values("right", "left", "alternating", "crossed", "equilateral", "jittered",
                                         "random", "delaunay"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace muslin
