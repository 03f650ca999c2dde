// The energy that keeps rigid bodies rigid: derivatives, rigid motions, how stiff it is, and that thin bodies
// are no worse than round ones.
#include "muslin/energy/affine_body.hpp"

#include "support/potential_battery.hpp"
#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/geometry/affine_frame.hpp"
#include "muslin/solver/linearization.hpp"

namespace muslin {
namespace {

std::vector<Vec3> corners(const AffineFrame& frame) {
  const auto c = frame.corners();
  return {c.begin(), c.end()};
}

AffineFrame tilted(const Vec3& radii) {
  return {Vec3(0.3, -1, 2), Eigen::AngleAxisd(0.8, Vec3(1, 1, 2).normalized()).toRotationMatrix(), radii};
}

TEST(AffineBodyEnergy, PassesTheBattery) {
  for (const Vec3& radii : {Vec3(0.2, 0.2, 0.2), Vec3(0.5, 0.1, 0.02)}) {
    const AffineFrame frame = tilted(radii);
    const AffineBodyEnergy energy(radii, 700);
    const std::vector<Vec3> rest = corners(frame);
    for (const double size : {0.01, 0.3}) {
      const std::vector<Vec3> x = test::sum(rest, 1, test::random_vectors(4, size, 3));
      test::expect_elastic_energy_is_sound(energy, rest, x, 0.1);
    }
  }
}

Eigen::Matrix<double, 12, 12> hessian(const Potential& energy, ConstVectors x) {
  Eigen::Matrix<double, 12, 12> h;
  for (int i = 0; i < 12; ++i) {
    std::vector<Vec3> e(4, Vec3::Zero());
    e[static_cast<std::size_t>(i / 3)][i % 3] = 1;
    const std::vector<Vec3> y = test::hessian_product(energy, x, e);
    for (int j = 0; j < 12; ++j) h(j, i) = y[static_cast<std::size_t>(j / 3)][j % 3];
  }
  return h;
}

TEST(AffineBodyEnergy, DistortionsHaveTheSameStiffnessForAnyShape) {
  // Masses of ¼ kg: squared frequencies are 4 × eigenvalues. Six rigid motions, six distortions of ω² = k/m
  // within a factor of two.
  for (const Vec3& radii : {Vec3(0.2, 0.2, 0.2), Vec3(1, 1, 1e-3), Vec3(1, 1e-3, 1e-3), Vec3(3, 0.2, 0.01)}) {
    const AffineBodyEnergy energy(radii, 100);
    const auto h = hessian(energy, corners(tilted(radii)));
    const Eigen::VectorXd squares =
        4 * Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 12, 12>>(h).eigenvalues();
    EXPECT_LT(squares.head<6>().cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_GT(squares[6], 49);
    EXPECT_LT(squares[11], 101);
  }
}

TEST(AffineBodyEnergy, LinearizationIsPositiveSemidefiniteAndTheHessianWhereStretched) {
  const Vec3 radii(0.5, 0.3, 0.1);
  const AffineBodyEnergy energy(radii, 50);
  const std::vector<double> masses(4, 1e-9);
  const std::vector<std::uint8_t> fixed(4, 0);
  for (const double scale : {1.3, 0.6}) {
    std::vector<Vec3> x = corners(tilted(scale * radii));
    Linearization h;
    h.reset(masses, fixed, 2);
    energy.linearize(x, h, 0);
    h.finish();
    for (std::uint32_t seed = 1; seed < 6; ++seed) {
      const std::vector<Vec3> p = test::random_vectors(4, 1, seed);
      std::vector<Float4> from(4), to(4, Float4{0, 0, 0, 0});
      for (std::size_t v = 0; v < 4; ++v) {
        from[v] = Float4{static_cast<float>(p[v].x()), static_cast<float>(p[v].y()),
                         static_cast<float>(p[v].z()), 0};
      }
      const double curvature = h.add_remainder_product(from.data(), to.data());
      EXPECT_GE(curvature, 0);
      const double exact = 2 * test::inner(p, test::hessian_product(energy, x, p));
      if (scale > 1) {
        EXPECT_NEAR(curvature, exact, 1e-5 * exact);
      } else {
        EXPECT_GE(curvature, exact - 1e-5 * std::abs(exact));
      }
    }
  }
}

TEST(AffineBodyEnergy, RefusesBodiesWithoutSize) {
  EXPECT_THROW(AffineBodyEnergy(Vec3(1, 0, 1), 1), Error);
  EXPECT_THROW(AffineBodyEnergy(Vec3(1, 1, 1), 0), Error);
}

}  // namespace
}  // namespace muslin
