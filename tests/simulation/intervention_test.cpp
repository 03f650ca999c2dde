// Interventions of a program between steps: move vertices, give them other velocities, add forces of its own;
// and what an exception leaves.
#include <cmath>
#include <limits>
#include <stdexcept>

#include "support/small_model.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/force/force_function.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

using test::small_model;
using test::SmallModelOptions;

std::shared_ptr<const Model> shared(Model model) { return std::make_shared<const Model>(std::move(model)); }

/// Free vertices without springs, loads or pins: each obeys m a = F alone.
Model dust() {
  Model model = small_model({.pinned = false, .damped = false, .stiffness = 0});
  model.potentials.clear();
  model.loads.clear();
  return model;
}

LoadTerm force(std::string name, ForceFunction::Function function) {
  return {name, EnergyRole::work, std::make_shared<ForceFunction>(name, std::move(function))};
}

TEST(ForceFunction, IsReadOncePerStepWithTheStateAtItsBeginning) {
  const auto model = shared(dust());
  Simulation simulation(model);
  std::vector<double> times;
  std::vector<Vec3> seen;
  simulation.add_load(force("look", [&](double t, ConstVectors x, ConstVectors, Vectors) {
    times.push_back(t);
    seen.assign(x.begin(), x.end());
  }));
  simulation.step();
  EXPECT_EQ(seen, model->rest_positions);
  simulation.advance();
  EXPECT_THAT(times, testing::ElementsAre(testing::DoubleEq(0), testing::DoubleEq(1.0 / 96),
                                          testing::DoubleEq(2.0 / 96), testing::DoubleEq(3.0 / 96)));
  EXPECT_EQ(simulation.frame(), 1);
  EXPECT_EQ(simulation.steps_done(), 0);
}

TEST(ForceFunction, DragFollowsItsRecurrenceAndTheEnergyBalanceCloses) {
  // Explicit drag in implicit Euler: v ← v (1 − c dt/m) exactly, without other forces.
  const auto model = shared(dust());
  Simulation simulation(model);
  simulation.set_velocities(std::vector<Vec3>(model->vertex_count(), Vec3(3, 0, 0)));
  simulation.add_load(force("drag", [&](double, ConstVectors, ConstVectors v, Vectors f) {
    for (std::size_t i = 0; i < f.size(); ++i) f[i] = -2 * model->masses[i] * v[i];
  }));
  const Diagnostics before = simulation.diagnostics();
  for (int frame = 0; frame < 24; ++frame) simulation.advance();
  const double expected = 3 * std::pow(1 - 2.0 / 96, 96);
  EXPECT_NEAR(simulation.state().velocities[5].x(), expected, 1e-9);
  EXPECT_LT(simulation.diagnostics().work, before.work);
  EXPECT_NEAR(simulation.diagnostics().balance(), before.balance(), 1e-9 * before.kinetic);
}

TEST(ForceFunction, NonFiniteForcesAreAnErrorWithTheVertex) {
  Simulation simulation(shared(dust()));
  simulation.add_load(force("burst", [](double, ConstVectors, ConstVectors, Vectors f) {
    f[7].y() = std::numeric_limits<double>::quiet_NaN();
  }));
  const auto before = simulation.checkpoint();
  try {
    simulation.advance();
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    EXPECT_THAT(error.what(), testing::HasSubstr("\"burst\" on vertex 7"));
  }
  EXPECT_EQ(simulation.checkpoint(), before);
}

TEST(Intervention, ExceptionOfALoadLeavesTheLastCompleteStep) {
  const auto model = shared(small_model());
  Simulation simulation(model), undisturbed(model);
  int calls = 0;
  simulation.add_load(force("fuse", [&](double, ConstVectors, ConstVectors, Vectors) {
    if (++calls == 3) throw std::runtime_error("blown");
  }));
  undisturbed.add_load(force("fuse", [](double, ConstVectors, ConstVectors, Vectors) {}));
  EXPECT_THROW(simulation.advance(), std::runtime_error);
  EXPECT_EQ(simulation.steps_done(), 2);
  undisturbed.step();
  undisturbed.step();
  EXPECT_EQ(simulation.checkpoint(), undisturbed.checkpoint());
  simulation.advance();
  undisturbed.advance();
  EXPECT_EQ(simulation.checkpoint(), undisturbed.checkpoint());
}

TEST(Intervention, SetPositionsCountAsWork) {
  for (const Integrator integrator : {Integrator::implicit_euler, Integrator::bdf2}) {
    const auto model = shared(small_model({.integrator = integrator}));
    Simulation simulation(model);
    for (int frame = 0; frame < 5; ++frame) simulation.advance();
    const double balance = simulation.diagnostics().balance();
    std::vector<Vec3> x = simulation.state().positions;
    for (Vec3& each : x) each.y() += 2;
    const double potential = simulation.diagnostics().potential, work = simulation.diagnostics().work;
    simulation.set_positions(x);
    EXPECT_EQ(simulation.state().positions, x);
    // 60 kg lifted 2 m, of which `lift` (in force at this time) took 2 N on each vertex.
    EXPECT_GT(simulation.diagnostics().potential - potential, 900);
    EXPECT_NEAR(simulation.diagnostics().work - work, simulation.diagnostics().potential - potential, 1e-6);
    simulation.set_velocities(std::vector<Vec3>(x.size(), Vec3(0, 0, 1)));
    EXPECT_NEAR(simulation.diagnostics().kinetic, 30, 1e-9);
    EXPECT_NEAR(simulation.diagnostics().balance(), balance, 1e-6);
    for (int frame = 0; frame < 5; ++frame) simulation.advance();
    EXPECT_NEAR(simulation.diagnostics().balance(), balance, 1e-5 * std::abs(balance));
  }
}

TEST(Intervention, PinsHoldSetPositionsAndContinueTheMotion) {
  const auto model = shared(small_model({.moving_pin = true}));
  Simulation simulation(model), other(model);
  for (int frame = 0; frame < 3; ++frame) {
    simulation.advance();
    other.advance();
  }
  const Vec3 offset(0, 3, 0);
  std::vector<Vec3> x = simulation.state().positions;
  for (Vec3& each : x) each += offset;
  simulation.set_positions(x);
  const auto held = static_cast<std::size_t>(model->pins[0].vertices[0]);
  for (int frame = 3; frame < 8; ++frame) {
    simulation.advance();
    other.advance();
    const Vec3 gap = simulation.state().positions[held] - other.state().positions[held];
    EXPECT_LT((gap - offset).norm(), 1e-12) << frame;
  }
}

TEST(Intervention, PositionsSetBeforeTheFirstStepAreHeld) {
  const auto model = shared(small_model());
  Simulation simulation(model);
  std::vector<Vec3> x = model->rest_positions;
  for (Vec3& each : x) each.x() *= -1;
  simulation.set_positions(x);
  simulation.advance();
  for (const int v : model->pins[0].vertices)
    EXPECT_EQ(simulation.state().positions[static_cast<std::size_t>(v)], x[static_cast<std::size_t>(v)]);
}

TEST(Intervention, WrongCountsAndNumbersAreRefusedAndChangeNothing) {
  const auto model = shared(small_model());
  Simulation simulation(model);
  const auto before = simulation.checkpoint();
  const auto kind = [](const auto& call) {
    try {
      call();
    } catch (const Error& error) {
      return error.kind();
    }
    return ErrorKind::interrupted;
  };
  std::vector<Vec3> x = model->rest_positions;
  x.pop_back();
  EXPECT_EQ(kind([&] { simulation.set_positions(x); }), ErrorKind::usage);
  EXPECT_EQ(kind([&] { simulation.set_velocities(x); }), ErrorKind::usage);
  x.emplace_back(0, 2e11, 0);
  EXPECT_EQ(kind([&] { simulation.set_positions(x); }), ErrorKind::usage);
  x.back().y() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(kind([&] { simulation.set_positions(x); }), ErrorKind::usage);
  EXPECT_EQ(kind([&] { simulation.set_velocities(x); }), ErrorKind::usage);
  EXPECT_EQ(simulation.checkpoint(), before);
}

}  // namespace
}  // namespace muslin
