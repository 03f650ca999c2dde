// The energy balance: kinetic + elastic + potential − work + dissipated does not change, for every
// integrator, with damping, loads that come and go, and pins that move. A wrong step breaks it.
#include <cmath>

#include "support/small_model.hpp"
#include <gtest/gtest.h>

#include "muslin/simulation/energy_account.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

using test::small_model;
using test::SmallModelOptions;

struct Drift {
  double largest = 0;  ///< |balance − balance at frame 0| [J]
  Diagnostics last;
};

Drift run(Model model, int frames) {
  Simulation simulation(std::make_shared<const Model>(std::move(model)));
  const double start = simulation.diagnostics().balance();
  Drift drift;
  for (int frame = 0; frame < frames; ++frame) {
    simulation.advance();
    drift.largest = std::max(drift.largest, std::abs(simulation.diagnostics().balance() - start));
  }
  drift.last = simulation.diagnostics();
  return drift;
}

class Balance : public testing::TestWithParam<Integrator> {
 protected:
  static SmallModelOptions options() {
    SmallModelOptions options;
    options.integrator = GetParam();
    options.steps_per_frame = 20;
    options.moving_pin = true;
    return options;
  }
};
INSTANTIATE_TEST_SUITE_P(Simulation, Balance,
                         testing::Values(Integrator::implicit_euler, Integrator::bdf2,
                                         Integrator::linearly_implicit_euler, Integrator::symplectic_euler));

TEST_P(Balance, ClosesWithDampingLoadsAndMovingPins) {
  const Drift drift = run(small_model(options()), 24);
  EXPECT_GT(std::abs(drift.last.work), 10.0);
  EXPECT_GT(drift.last.dissipated, 10.0);
  EXPECT_LT(drift.largest, 1e-6);  // of energies around 1000 J
}

TEST(EnergyBalance, StepThatViolatesItsEquationBreaksIt) {
  SmallModelOptions options;
  Model model = small_model(options);
  State before;
  before.positions = model.rest_positions;
  before.velocities.assign(model.vertex_count(), Vec3::Zero());
  State after = before;
  const double dt = 0.01;
  const StepContext context = step_context(Integrator::implicit_euler, before, dt);
  std::vector<std::uint8_t> fixed(model.vertex_count(), 0);
  std::vector<const Potential*> potentials;
  std::vector<ActingPotential> acts;
  for (const PotentialTerm& term : model.potentials) {
    potentials.push_back(term.potential.get());
    acts.push_back({term.role, term.potential.get(), term.potential->value(before.positions)});
  }
  ASSERT_TRUE(
      solve_step(model.scene.solver, context, {model.masses, potentials, fixed, model.rest_positions}, after)
          .converged);
  const auto imbalance = [&](const State& end) {
    const EnergyFlow flow =
        energy_flow({Integrator::implicit_euler, dt, &context, &before, &end, model.masses, fixed, acts});
    double stored = kinetic_energy(model.masses, end.velocities);
    for (const ActingPotential& act : acts)
      stored += act.potential->value(end.positions) - act.potential->value(before.positions);
    return std::abs(stored - flow.work + flow.dissipated);
  };
  EXPECT_LT(imbalance(after), 1e-9);
  State wrong = after;
  for (std::size_t v = 0; v < wrong.positions.size(); ++v) {
    wrong.positions[v] *= 1.0001;
    wrong.velocities[v] = (wrong.positions[v] - before.positions[v]) / dt;
  }
  EXPECT_GT(imbalance(wrong), 1e-4);
}

TEST(EnergyBalance, ImplicitEulerLosesAndSymplecticEulerKeepsTheEnergyOfFreeOscillation) {
  const auto lost = [](Integrator integrator, int steps) {
    SmallModelOptions options;
    options.integrator = integrator;
    options.steps_per_frame = steps;
    options.pinned = options.damped = false;
    Model model = small_model(options);
    model.loads.clear();
    model.potentials.pop_back();                        // no gravity
    for (Vec3& x : model.rest_positions) x.x() *= 1.1;  // stretched by a tenth and let go
    Simulation swinging(std::make_shared<const Model>(std::move(model)));
    const double start = swinging.diagnostics().elastic;
    for (int frame = 0; frame < 24; ++frame) swinging.advance();
    EXPECT_NEAR(swinging.diagnostics().balance(), start, 1e-7 * start);
    return swinging.diagnostics().dissipated / start;
  };
  const double coarse = lost(Integrator::implicit_euler, 40), fine = lost(Integrator::implicit_euler, 80);
  EXPECT_GT(fine, 0.05);
  EXPECT_GT(coarse, fine);
  EXPECT_LT(std::abs(lost(Integrator::bdf2, 80)), 0.5 * fine);
  EXPECT_LT(std::abs(lost(Integrator::symplectic_euler, 80)), 0.05);
}

}  // namespace
}  // namespace muslin
