// A spring that takes a set: what stays, what is lost, and what a lattice of elastic springs has.
#include "muslin/energy/plastic_springs.hpp"

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "support/lattice_box.hpp"
#include "support/potential_battery.hpp"
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/energy/spring_energy.hpp"

namespace muslin {
namespace {

constexpr double width = 0.1, modulus = 3e4, yield = 0.05;
constexpr double stiffness = modulus * width * width * width;  // [J], of an edge

/// One spring along x, with its history.
struct OneSpring {
  explicit OneSpring(double hardening)
      : load("bar", springs(), 2, width, {modulus, 0, 0}, {}, {yield, hardening}) {}

  static Springs springs() {
    Springs one;
    one.directions = {{Vec3i(1, 0, 0), SpringKind::edge}};
    one.runs = {{0, 0, 1, 1, 0}};
    one.count = 1;
    return one;
  }
  static std::vector<Vec3> at(double strain) { return {Vec3::Zero(), Vec3(width * (1 + strain), 0, 0)}; }
  std::unique_ptr<Potential> begin() const {
    StepContext step;
    step.history = &history;
    return load.potential(step);
  }
  /// Makes a step to a strain; returns what it loses.
  double step(double strain) {
    const auto energy = begin();
    load.end_step(*energy, at(strain), history);
    return energy->dissipated(at(strain));
  }
  double tension(double strain) const {
    std::vector<Vec3> g(2, Vec3::Zero());
    begin()->add_gradient(at(strain), g);
    return g[1].x() * width;
  }

  PlasticSprings load;
  History history;
};

TEST(PlasticSprings, KeepWhatIsBeyondYieldInStretchAndCompression) {
  for (const double hardening : {0.0, 0.2, 1.0}) {
    for (const double most : {0.3, -0.3}) {
      OneSpring spring(hardening);
      spring.step(most);
      const double kept = (1 - hardening) * (most - std::copysign(yield, most));
      EXPECT_NEAR(spring.tension(kept), 0, 1e-12 * stiffness);
      const double further = std::copysign(0.01, most);
      EXPECT_NEAR(spring.tension(kept + further), further * stiffness, 1e-9 * stiffness) << "elastic again";
    }
  }
}

TEST(PlasticSprings, BelowYieldAreElastic) {
  OneSpring spring(0.2);
  EXPECT_EQ(spring.step(0.99 * yield), 0);
  EXPECT_NEAR(spring.tension(0), 0, 1e-12 * stiffness);
}

TEST(PlasticSprings, LoseTheAreaOfTheLoopInAnyNumberOfSteps) {
  const double most = 0.2, hardening = 0.2;
  for (const int steps : {1, 7}) {
    OneSpring spring(hardening);
    spring.step(-most);
    double lost = 0;
    for (const double to : {most, -most})
      for (int i = 1; i <= steps; ++i) lost += spring.step(-to + 2 * to * i / steps);
    EXPECT_NEAR(lost, 4 * (1 - hardening) * stiffness * yield * (most - yield), 1e-9 * stiffness);
  }
}

TEST(PlasticSprings, OfALatticeBelowYieldAreItsElasticSprings) {
  Lattice lattice = test::box_lattice({3, 2, 2});
  lattice.width = width;
  const Springs springs = build_springs(lattice, Bracing::full);
  std::vector<Vec3> x;
  const std::vector<Vec3> noise = test::random_vectors(lattice.vertex_count(), 0.001, 3);
  for (std::size_t v = 0; v < lattice.vertex_count(); ++v) x.push_back(lattice.rest_position(v) + noise[v]);
  const std::array moduli = {3e4, 1e4, 5e3};
  const SpringEnergy elastic(springs, width, moduli, springs.share);
  const PlasticSprings load("block", springs, x.size(), width, moduli, springs.share, {0.5, 0});
  const auto energy = load.potential(StepContext());
  EXPECT_NEAR(energy->value(x), elastic.value(x), 1e-12 * elastic.value(x));
  std::vector<Vec3> g(x.size(), Vec3::Zero()), expected = g;
  energy->add_gradient(x, g);
  elastic.add_gradient(x, expected);
  EXPECT_LE(test::norm(test::sum(g, -1, expected)), 1e-12 * test::norm(expected));
}

TEST(PlasticSprings, RefuseNumbersOutOfRange) {
  EXPECT_THROW(PlasticSprings("bar", OneSpring::springs(), 2, width, {modulus, 0, 0}, {}, {0, 0}), Error);
  EXPECT_THROW(PlasticSprings("bar", OneSpring::springs(), 2, width, {modulus, 0, 0}, {}, {0.1, 1.5}), Error);
}

}  // namespace
}  // namespace muslin
