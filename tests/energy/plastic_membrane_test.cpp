// A membrane whose threads stay longer: what a strip keeps and loses, at which pull it yields, and what is
// elastic.
#include "muslin/energy/plastic_membrane.hpp"

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "support/sheet.hpp"
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

constexpr double length = 0.4, width = 0.1, warp = 200, weft = 80, yield = 0.05;

/// A strip along warp with its history, stretched evenly to Green strains.
struct Strip {
  Strip(double poisson, double hardening)
      : mesh(test::flat_sheet(8, 2, length, width)),
        shell(build_shell(mesh, mesh.positions, {Vec3::UnitX()})),
        load("strip", shell, {warp, weft, 30, poisson}, {yield, hardening}, block_pattern(shell)) {}

  std::vector<Vec3> at(double along, double across) const {
    std::vector<Vec3> x = mesh.positions;
    for (Vec3& p : x) {
      p.x() *= std::sqrt(1 + 2 * along);
      p.z() *= std::sqrt(1 + 2 * across);
    }
    return x;
  }
  std::unique_ptr<Potential> begin() const {
    StepContext step;
    step.history = &history;
    return load.potential(step);
  }
  double step(double along, double across = 0) {
    const auto energy = begin();
    load.end_step(*energy, at(along, across), history);
    return energy->dissipated(at(along, across));
  }
  /// The stresses of warp and weft: derivatives of the energy per area by the strains.
  std::array<double, 2> stresses(double along, double across) const {
    const auto energy = begin();
    constexpr double d = 1e-6;
    const auto slope = [&](double da, double dc) {
      return (energy->value(at(along + da, across + dc)) - energy->value(at(along - da, across - dc))) /
             (2 * d * length * width);
    };
    return {slope(d, 0), slope(0, d)};
  }

  Mesh mesh;
  Shell shell;
  PlasticMembrane load;
  History history;
};

TEST(PlasticMembrane, StripThatIsPulledTooFarKeepsWhatIsBeyondYield) {
  for (const double hardening : {0.0, 0.3}) {
    for (const double poisson : {0.0, 0.25}) {
      Strip strip(poisson, hardening);
      // Free to narrow: with a = h E + (1 − h) e, a_vv = −ratio a_uu, and E_vv = e_vv as weft does not yield.
      const double most = 0.2, ratio = poisson * std::sqrt(warp / weft), square = poisson * poisson;
      const double elastic =
          (yield * (1 - square) + square * hardening * most) / (1 - square + square * hardening);
      strip.step(most, -ratio * (hardening * most + (1 - hardening) * elastic));
      const double kept = (1 - hardening) * (most - elastic);
      if (poisson == 0 || hardening == 0) {
        EXPECT_NEAR(kept, (1 - hardening) * (most - yield), 1e-12);
      }
      const auto [along, across] = strip.stresses(kept, 0);
      EXPECT_NEAR(along, 0, 1e-6 * warp);
      EXPECT_NEAR(across, 0, 1e-6 * warp);
    }
  }
}

TEST(PlasticMembrane, StripYieldsAtTheYieldStrainTimesItsModulus) {
  Strip strip(0.25, 0);
  const double most = 0.2, ratio = 0.25 * std::sqrt(warp / weft);
  const auto [along, across] = strip.stresses(most, -ratio * yield);
  EXPECT_NEAR(along, warp * yield, 1e-6 * warp);
  EXPECT_NEAR(across, 0, 1e-6 * warp);
}

TEST(PlasticMembrane, LosesTheYieldStressTimesTheSlipInAnyNumberOfSteps) {
  const double most = 0.2, hardening = 0.3;
  for (const int steps : {1, 5}) {
    Strip strip(0, hardening);
    double lost = 0;
    for (int i = 1; i <= steps; ++i) lost += strip.step(most * i / steps);
    lost += strip.step(0.1) + strip.step(most);
    EXPECT_NEAR(lost, (1 - hardening) * warp * yield * (most - yield) * length * width, 1e-9);
  }
}

TEST(PlasticMembrane, BothThreadsYieldAtOnce) {
  Strip strip(0.25, 0);
  const auto [along, across] = strip.stresses(0.3, 0.4);
  EXPECT_NEAR(along, warp * yield, 1e-6 * warp);
  EXPECT_NEAR(across, weft * yield, 1e-6 * warp);
}

TEST(PlasticMembrane, BelowYieldAndInCompressionIsElastic) {
  Strip strip(0.25, 0);
  const MembraneEnergy elastic(strip.shell, {warp, weft, 30, 0.25});
  for (const auto& x : {strip.at(0.03, 0.01), strip.at(-0.2, -0.1)}) {
    const auto energy = strip.begin();
    EXPECT_NEAR(energy->value(x), elastic.value(x), 1e-12 * elastic.value(x));
    EXPECT_EQ(energy->dissipated(x), 0);
  }
}

TEST(PlasticMembrane, RefusesNumbersOutOfRange) {
  const Strip strip(0, 0);
  const auto make = [&](const MembraneModuli& moduli, const StrainYield& limit) {
    PlasticMembrane("strip", strip.shell, moduli, limit);
  };
  EXPECT_THROW(make({warp, weft, 30, 0}, {0, 0}), Error);
  EXPECT_THROW(make({warp, weft, 30, 0}, {0.1, 2}), Error);
  EXPECT_THROW(make({warp, 0, 30, 0}, {0.1, 0}), Error);
}

}  // namespace
}  // namespace muslin
