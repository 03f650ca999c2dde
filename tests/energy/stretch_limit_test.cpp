// The limit of stretch: derivatives on both sides of onset and limit, closed forms, nothing below the onset.
#include "muslin/energy/stretch_limit.hpp"

#include <cmath>

#include "support/sheet.hpp"
#include <gtest/gtest.h>

#include "muslin/energy/shell_pattern.hpp"
#include "muslin/solver/symmetric_matrix.hpp"

namespace muslin {
namespace {

const Weave along_x{Vec3::UnitX()};
constexpr double stiffness = 700;  // [N/m]

std::vector<Vec3> mapped(const std::vector<Vec3>& rest, const Mat3& f) {
  std::vector<Vec3> x = rest;
  for (Vec3& p : x) p = f * p;
  return x;
}

/// A jittered sheet stretched to (warp, weft), turned, its vertices moved by up to `noise` [m].
std::vector<Vec3> stretched(const Mesh& mesh, double warp, double weft, double noise = 0) {
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(0.2, 0.9, -0.4).normalized()).toRotationMatrix();
  return test::sum(mapped(mesh.positions, turn * Vec3(warp, 1, weft).asDiagonal()), 1,
                   test::random_vectors(mesh.vertex_count(), noise, 5));
}

double inner_product(const StretchLimitEnergy& energy, Stiffness kind, ConstVectors x, ConstVectors p) {
  std::vector<Vec3> y(x.size(), Vec3::Zero());
  energy.add_stiffness_product(kind, x, p, y);
  return test::inner(p, y);
}

TEST(StretchBarrier, IsTwiceContinuouslyDifferentiableAndConvex) {
  for (const double limit : {1.002, 1.05, 2.0}) {
    const StretchBarrier barrier(limit);
    const double width = barrier.limit() - barrier.onset(), parabola = barrier.onset() + width / 2;
    EXPECT_DOUBLE_EQ(barrier.onset(), 0.5 * (1 + limit));
    for (const double joint : {barrier.onset(), parabola}) {
      const double step = 1e-7 * width;
      const auto below = barrier.at(joint - step), above = barrier.at(joint + step);
      EXPECT_NEAR(below.value, above.value, 1e-5 * width * width);
      EXPECT_NEAR(below.slope, above.slope, 1e-3 * width);
      EXPECT_NEAR(below.curvature, above.curvature, 0.1);
    }
    double slope = 0, curvature = 0;
    for (double depth = 0.01; depth < 4; depth += 0.01) {
      const double stretch = barrier.onset() + depth * width, step = 1e-4 * width;
      const auto law = barrier.at(stretch), before = barrier.at(stretch - step),
                 after = barrier.at(stretch + step);
      EXPECT_NEAR((after.value - before.value) / (2 * step), law.slope, 1e-4 * law.slope + 1e-7 * width);
      EXPECT_NEAR((after.slope - before.slope) / (2 * step), law.curvature, 1e-4 * law.curvature + 1e-4);
      EXPECT_GT(law.slope, slope);
      EXPECT_GE(law.curvature, curvature);
      EXPECT_LT(law.curvature, 6.387);
      slope = law.slope, curvature = law.curvature;
    }
    EXPECT_EQ(barrier.at(barrier.onset()).curvature, 0);
    EXPECT_EQ(barrier.at(0).value, 0);
    EXPECT_TRUE(std::isfinite(barrier.at(1000).value));
  }
}

TEST(StretchLimitEnergy, PassesTheBatteryOnBothSidesOfTheLimit) {
  const Mesh mesh = test::flat_sheet(7, 6, 0.7, 0.6, 0.2);
  const StretchLimitEnergy energy(build_shell(mesh, mesh.positions, along_x), 1.3, stiffness);
  {
    SCOPED_TRACE("some triangles beyond the onset");
    test::expect_elastic_energy_is_sound(energy, mesh.positions, stretched(mesh, 1.12, 1.05, 0.01), 0.01);
  }
  {
    SCOPED_TRACE("near the limit in one direction, compressed in the other");
    test::expect_elastic_energy_is_sound(energy, mesh.positions, stretched(mesh, 1.26, 0.6, 0.001), 0.01);
  }
  {
    SCOPED_TRACE("far above the limit in both");
    test::expect_elastic_energy_is_sound(energy, mesh.positions, stretched(mesh, 3, 1.5, 0.02), 0.1);
  }
}

TEST(StretchLimitEnergy, EqualStretchesAndCollapsedTrianglesHaveDerivatives) {
  const Mesh mesh = test::flat_sheet(4, 3, 0.4, 0.3, 0.2);
  const StretchLimitEnergy energy(build_shell(mesh, mesh.positions, along_x), 1.3, stiffness);
  for (const double difference : {0.0, 1e-14, 1e-10, 1e-8, 3e-7, 1e-5}) {
    SCOPED_TRACE(difference);
    for (const double stretch : {1.2, 1.28, 1.6}) {
      const std::vector<Vec3> x = stretched(mesh, stretch + difference, stretch);
      test::expect_hessian_matches_gradient(energy, x, 1e-3);
      test::expect_hessian_symmetric(energy, x);
      test::expect_gradient_matches_value(energy, x, 1e-3);
    }
  }
  {
    SCOPED_TRACE("a line");
    const std::vector<Vec3> x = stretched(mesh, 1.25, 0);
    test::expect_hessian_matches_gradient(energy, x, 1e-3);
    test::expect_gradient_matches_value(energy, x, 1e-3);
  }
  const std::vector<Vec3> point(mesh.vertex_count(), Vec3(1, 2, 3));
  EXPECT_EQ(energy.value(point), 0);
  EXPECT_EQ(inner_product(energy, Stiffness::exact, point, stretched(mesh, 1, 1)), 0);
}

TEST(StretchLimitEnergy, IsZeroBelowTheOnset) {
  const Mesh mesh = test::flat_sheet(5, 4, 0.5, 0.4);
  const StretchLimitEnergy energy(build_shell(mesh, mesh.positions, along_x), 1.1, stiffness);
  for (const auto& [warp, weft] : {std::pair{1.0, 1.0}, {1.049, 1.049}, {0.5, 1.04}, {0.0, 0.9}}) {
    const std::vector<Vec3> x = stretched(mesh, warp, weft);
    EXPECT_EQ(energy.value(x), 0);
    EXPECT_EQ(test::norm(test::gradient(energy, x)), 0);
    EXPECT_EQ(inner_product(energy, Stiffness::exact, x, test::random_vectors(x.size(), 1, 3)), 0);
  }
}

TEST(StretchLimitEnergy, HasTheClosedFormOfAStripInEveryDirection) {
  const double limit = 1.1, onset = 1.05, stretch = 1.07, depth = (stretch - onset) / (limit - onset);
  const double expected =
      -stiffness * 0.24 * std::pow(stretch - onset, 2) * std::log(1 - depth);  // on 0.24 m²
  const Mesh mesh = test::flat_sheet(3, 2, 0.6, 0.4);
  for (const double angle : {0.0, 0.4, 1.3}) {
    const Weave weave{Vec3(std::cos(angle), 0, std::sin(angle))};
    const StretchLimitEnergy energy(build_shell(mesh, mesh.positions, weave), limit, stiffness);
    EXPECT_NEAR(energy.value(stretched(mesh, stretch, 1)) / expected, 1, 1e-11);
    EXPECT_NEAR(energy.value(stretched(mesh, 0.7, stretch)) / expected, 1, 1e-11);
    EXPECT_NEAR(energy.value(stretched(mesh, stretch, stretch)) / expected, 2, 1e-11);
  }
}

TEST(StretchLimitEnergy, ProjectedAndExactStiffnessAreEqualAndPositive) {
  const Mesh mesh = test::flat_sheet(5, 4, 0.5, 0.4, 0.2);
  const Shell shell = build_shell(mesh, mesh.positions, along_x);
  const auto pattern = block_pattern(shell);
  const StretchLimitEnergy energy(shell, 1.1, stiffness, pattern);
  for (const auto& [warp, weft] : {std::pair{1.07, 0.3}, {1.07, 1.07}, {1.0999, 1.06}, {2.5, 0.01}}) {
    const std::vector<Vec3> x = stretched(mesh, warp, weft, 1e-3);
    SymmetricMatrix matrix;
    matrix.reset(pattern, 0);
    energy.add_stiffness_matrix(Stiffness::projected, x, 2, {}, matrix.blocks());
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
      std::vector<Vec3> p = test::random_vectors(x.size(), 1, seed);
      const double exact = inner_product(energy, Stiffness::exact, x, p),
                   projected = inner_product(energy, Stiffness::projected, x, p),
                   material = inner_product(energy, Stiffness::material, x, p);
      EXPECT_GT(exact, 0);
      EXPECT_EQ(exact, projected);
      EXPECT_GE(material, 0);
      EXPECT_LE(material, exact * (1 + 1e-12));
      std::vector<Float4> in(x.size()), out(x.size());
      for (std::size_t v = 0; v < x.size(); ++v) {
        in[v] = Float4{static_cast<float>(p[v].x()), static_cast<float>(p[v].y()),
                       static_cast<float>(p[v].z()), 0};
      }
      EXPECT_NEAR(matrix.add_product(in.data(), out.data()) / (2 * exact), 1, 1e-5);
    }
    // Motions that change a stretch least of all: the smallest eigenvalue, from all products.
    const std::size_t n = 3 * x.size();
    Eigen::MatrixXd hessian(n, n);
    for (std::size_t column = 0; column < n; ++column) {
      std::vector<Vec3> unit(x.size(), Vec3::Zero());
      unit[column / 3][static_cast<Eigen::Index>(column % 3)] = 1;
      const std::vector<Vec3> y = test::hessian_product(energy, x, unit);
      for (std::size_t row = 0; row < n; ++row)
        hessian(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) =
            y[row / 3][static_cast<Eigen::Index>(row % 3)];
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(hessian, Eigen::EigenvaluesOnly);
    EXPECT_GE(eigen.eigenvalues().minCoeff(), -1e-12 * eigen.eigenvalues().maxCoeff());
  }
}

TEST(StretchLimitEnergy, LargeSheetHasTheSameBitsForAnyThreadCount) {
  const Mesh mesh = test::flat_sheet(60, 50, 1, 1);
  const StretchLimitEnergy energy(build_shell(mesh, mesh.positions, along_x), 1.1, stiffness);
  test::expect_same_bits_for_any_thread_count(energy, stretched(mesh, 1.05, 1.02, 0.001));
}

TEST(StretchLimitEnergy, StiffnessFollowsTheFabricOrItsWeight) {
  EXPECT_EQ(stretch_limit_stiffness(16340, 0.5, 0.02, 1.05), 2 * 16340);
  EXPECT_DOUBLE_EQ(stretch_limit_stiffness(1, 0.15, 0.02, 1.05), 2 * 0.15 * 9.81 / 0.02 / (1.05 - 1));
}

}  // namespace
}  // namespace muslin
