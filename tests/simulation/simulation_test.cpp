// Runs of a small flag: clock, halved steps, failure, and the same bits after a checkpoint and on any number
// of threads.
#include "muslin/simulation/simulation.hpp"

#include <cmath>

#include "support/small_model.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

using test::small_model;
using test::SmallModelOptions;

std::shared_ptr<const Model> shared(Model model) { return std::make_shared<const Model>(std::move(model)); }

constexpr Integrator all_integrators[] = {Integrator::implicit_euler, Integrator::bdf2,
                                          Integrator::linearly_implicit_euler, Integrator::symplectic_euler};

void expect_same_bits(const Simulation& a, const Simulation& b) {
  EXPECT_EQ(a.checkpoint(), b.checkpoint());
  EXPECT_EQ(a.state().positions, b.state().positions);
  EXPECT_EQ(a.diagnostics().balance(), b.diagnostics().balance());
}

class EveryIntegrator : public testing::TestWithParam<Integrator> {};
INSTANTIATE_TEST_SUITE_P(Simulation, EveryIntegrator, testing::ValuesIn(all_integrators));

TEST_P(EveryIntegrator, ResumesFromACheckpointBitForBit) {
  SmallModelOptions options;
  options.integrator = GetParam();
  options.tolerance = 1e-3;
  options.moving_pin = true;
  options.steps_per_frame = 20;
  const auto model = shared(small_model(options));
  Simulation straight(model), first(model), second(model);
  for (int frame = 0; frame < 20; ++frame) straight.advance();
  for (int frame = 0; frame < 9; ++frame) first.advance();
  second.restore(first.checkpoint());
  expect_same_bits(first, second);
  for (int frame = 9; frame < 20; ++frame) second.advance();
  EXPECT_EQ(second.frame(), 20);
  expect_same_bits(straight, second);
}

TEST_P(EveryIntegrator, HasTheSameBitsForAnyNumberOfThreads) {
  SmallModelOptions options;
  options.integrator = GetParam();
  options.tolerance = 1e-3;
  options.steps_per_frame = 20;
  const auto run = [&](int threads) {
    set_thread_count(threads);
    Simulation simulation(shared(small_model(options)));
    for (int frame = 0; frame < 10; ++frame) simulation.advance();
    set_thread_count(0);
    return simulation.checkpoint();
  };
  EXPECT_EQ(run(1), run(2));
}

TEST(Simulation, BeginsAtRestWithValidDiagnostics) {
  const Simulation simulation(shared(small_model()));
  const Diagnostics& row = simulation.diagnostics();
  EXPECT_EQ(row.frame, 0);
  EXPECT_EQ(row.time, 0);
  EXPECT_EQ(row.kinetic, 0);
  EXPECT_EQ(row.elastic, 0);
  EXPECT_NEAR(row.potential, 60 * 9.8 * 1.0, 1e-9);
  EXPECT_EQ(row.max_stretch, 1);
  EXPECT_TRUE(std::isinf(row.min_distance));
}

TEST(Simulation, ClockIsExactAtWholeFrames) {
  SmallModelOptions options;
  options.tolerance = 1;
  Simulation simulation(shared(small_model(options)));
  for (int frame = 1; frame <= 24; ++frame) {
    simulation.advance();
    EXPECT_EQ(simulation.state().time, frame / 24.0);
  }
  EXPECT_EQ(simulation.state().time, 1.0);
}

TEST(Simulation, PinsHoldMoveAndRelease) {
  SmallModelOptions options;
  options.moving_pin = true;
  const auto model = shared(small_model(options));
  Simulation simulation(model);
  const auto v = static_cast<std::size_t>(model->pins[0].vertices[0]);
  for (int frame = 0; frame < 12; ++frame) simulation.advance();
  const Vec3 expected = model->rest_positions[v] + Vec3(0.3, 0.4, 0.1);
  EXPECT_LT((simulation.state().positions[v] - expected).norm(), 1e-12);
  EXPECT_GT(simulation.diagnostics().max_stretch, 1.0);
  for (int frame = 12; frame < 18; ++frame) simulation.advance();
  EXPECT_GT((simulation.state().positions[v] - expected).norm(), 0.01);
}

TEST(Simulation, InterruptedFrameContinuesFromTheLastStep) {
  const auto model = shared(small_model());
  Simulation straight(model), stopped(model), restored(model);
  for (int frame = 0; frame < 3; ++frame) straight.advance();
  stopped.advance();
  int polls = 0;
  Progress progress;
  progress.cancelled = [&] { return ++polls > 2; };
  EXPECT_THROW(stopped.advance(progress), Error);
  EXPECT_EQ(stopped.frame(), 1);
  EXPECT_EQ(stopped.steps_done(), 2);
  restored.restore(stopped.checkpoint());
  for (Simulation* simulation : {&stopped, &restored}) {
    simulation->advance();
    simulation->advance();
    expect_same_bits(straight, *simulation);
  }
}

TEST(Simulation, FailedStepNamesThePlaceAndKeepsTheLastGoodState) {
  SmallModelOptions options;
  options.pinned = false;
  Model model = small_model(options);
  model.potentials.push_back(
      {"wall", EnergyRole::elastic, std::make_shared<test::Wall>(model.vertex_count(), -0.05)});
  Simulation simulation(shared(std::move(model)));
  try {
    for (int frame = 0; frame < 24; ++frame) simulation.advance();
    FAIL() << "went through a wall of NaN";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::solver);
    EXPECT_THAT(error.what(), testing::HasSubstr("frame"));
    EXPECT_THAT(error.what(), testing::HasSubstr("halved 8 times"));
    EXPECT_THAT(error.what(), testing::HasSubstr("steps_per_frame (now 4)"));
  }
  for (const Vec3& x : simulation.state().positions) EXPECT_TRUE(x.allFinite());
  EXPECT_EQ(simulation.state().time, (simulation.frame() * 4 + simulation.steps_done()) / 96.0);
  const auto bytes = simulation.checkpoint();
  EXPECT_NO_THROW(simulation.restore(bytes));
}

TEST(Simulation, TooLargeExplicitStepsAreHalved) {
  SmallModelOptions options;
  options.integrator = Integrator::symplectic_euler;
  options.steps_per_frame = 1;
  options.stiffness = 20000;
  Simulation simulation(shared(small_model(options)));
  for (int frame = 0; frame < 12; ++frame) simulation.advance();
  EXPECT_GT(simulation.state().step, 12);
  EXPECT_EQ(simulation.state().time, 0.5);
  for (const Vec3& x : simulation.state().positions) EXPECT_TRUE(x.allFinite());
}

TEST(Simulation, CheckpointsOfOtherBodiesAreRefused) {
  Simulation simulation(shared(small_model()));
  Model other = small_model();
  other.masses[0] *= 2;
  Simulation heavier(shared(std::move(other)));
  EXPECT_THROW(heavier.restore(simulation.checkpoint()), Error);
  auto bytes = simulation.checkpoint();
  bytes[bytes.size() / 2] ^= 1;
  EXPECT_THROW(simulation.restore(bytes), Error);
}

TEST(Simulation, PinsAndLoadsMayChangeAtACheckpoint) {
  Simulation before(shared(small_model()));
  for (int frame = 0; frame < 6; ++frame) before.advance();
  Model changed = small_model();
  changed.pins.insert(changed.pins.begin(), Pin{"new", {0}, 0, 10, {}});
  changed.loads.clear();
  const auto corner = static_cast<std::size_t>(changed.pins[1].vertices[0]);
  Simulation after(shared(std::move(changed)));
  after.restore(before.checkpoint());
  const Vec3 start = after.state().positions[0], held = after.state().positions[corner];
  const double balance = after.diagnostics().balance();
  for (int frame = 0; frame < 4; ++frame) after.advance();
  EXPECT_EQ(after.state().positions[0], start);
  EXPECT_EQ(after.state().positions[corner], held);
  EXPECT_NEAR(after.diagnostics().balance(), balance, 1e-4 * std::abs(balance));
}

}  // namespace
}  // namespace muslin
