// Runs with contact: nothing crosses with any effort, the balance of energy closes, a run that stops and goes
// on gives the same bits, and a start that crosses is refused.
#include <cmath>
#include <memory>
#include <random>

#include "support/contact_scene.hpp"
#include <gtest/gtest.h>

#include "muslin/contact/contact_model.hpp"
#include "muslin/contact/crossings.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/scene/names.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

/// A square of 1 m over a ball of 0.25 m, its corners bent by noise.
std::shared_ptr<const Model> drop(int n, Effort effort, int steps_per_frame = 4,
                                  Integrator integrator = Integrator::implicit_euler) {
  test::ContactScene scene(steps_per_frame);
  scene.model.scene.solver.tolerance.reset();
  scene.model.scene.solver.effort = effort;
  scene.model.scene.solver.integrator = integrator;
  test::ClothGrid cloth(n, n, 1.0 / (n - 1));
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> noise(-1e-3, 1e-3);
  for (Vec3& p : cloth.positions) p += Vec3(-0.5, 0.26 + noise(random), -0.5);
  scene.add_cloth(cloth);
  scene.add_ball(Vec3::Zero(), 0.25);
  return scene.finish();
}

class EveryEffort : public ::testing::TestWithParam<Effort> {};

TEST_P(EveryEffort, ClothOnABallNeverCrossesAnything) {
  const auto model = drop(16, GetParam());
  Simulation simulation(model);
  for (int frame = 0; frame < 40; ++frame) {
    simulation.advance();
    ASSERT_TRUE(find_crossings(*model->contact, simulation.state().positions).empty()) << frame;
    ASSERT_GT(simulation.diagnostics().min_distance, 0) << frame;
  }
  EXPECT_LT(simulation.diagnostics().min_distance, model->contact->distance);
  const double middle = simulation.state().positions[16 * 8 + 8].norm();  // lies on the ball
  EXPECT_GT(middle, 0.25);
  EXPECT_LT(middle, 0.256);
  EXPECT_LT(simulation.state().positions[0].y(), 0.1);  // corners hang
  EXPECT_LT(simulation.diagnostics().max_stretch, 1.15);
}
INSTANTIATE_TEST_SUITE_P(Efforts, EveryEffort,
                         ::testing::Values(Effort::draft, Effort::normal, Effort::exact),
                         [](const auto& info) { return name_of(effort_names(), info.param); });

TEST(ContactRun, TheBalanceOfEnergyCloses) {
  const auto model = drop(12, Effort::exact);
  Simulation simulation(model);
  const double before = simulation.diagnostics().balance();
  double largest = 0;
  for (int frame = 0; frame < 30; ++frame) {
    simulation.advance();
    largest = std::max(largest, std::fabs(simulation.diagnostics().balance() - before));
  }
  // 0.2 kg fall some 0.2 m.
  EXPECT_LT(largest, 1e-3 * 0.2 * 9.81 * 0.2);
  EXPECT_GT(simulation.diagnostics().dissipated, 0);
}

TEST(ContactRun, ResumesFromACheckpointBitForBit) {
  for (const Effort effort : {Effort::exact, Effort::normal}) {
    const auto model = drop(12, effort);
    Simulation whole(model);
    for (int frame = 0; frame < 12; ++frame) whole.advance();
    const std::vector<std::uint8_t> saved = whole.checkpoint();
    for (int frame = 0; frame < 5; ++frame) whole.advance();
    Simulation resumed(model);
    resumed.restore(saved);
    for (int frame = 0; frame < 5; ++frame) resumed.advance();
    EXPECT_EQ(whole.state().positions, resumed.state().positions);
    EXPECT_EQ(whole.diagnostics().balance(), resumed.diagnostics().balance());
    EXPECT_EQ(whole.diagnostics().min_distance, resumed.diagnostics().min_distance);
  }
}

TEST(ContactRun, ResumesFromAnyFrameOfAFall) {
  // Points leave the boxes that candidates were found for within steps, and are searched for alone: nothing
  // of that may outlive the step.
  const auto model = drop(16, Effort::normal);
  Simulation whole(model);
  for (int frame = 0; frame < 70; ++frame) {
    Simulation resumed(model);
    resumed.restore(whole.checkpoint());
    whole.advance();
    resumed.advance();
    ASSERT_EQ(whole.checkpoint(), resumed.checkpoint()) << frame;
  }
}

TEST(ContactRun, SetPositionsAreCheckedAndResetContact) {
  const auto model = drop(12, Effort::exact);
  Simulation simulation(model);
  for (int frame = 0; frame < 12; ++frame) simulation.advance();
  ASSERT_LT(simulation.diagnostics().min_distance, model->contact->distance);
  const double balance = simulation.diagnostics().balance();
  const auto shifted = [&](double y) {
    std::vector<Vec3> x = simulation.state().positions;
    for (std::size_t v = 0; v < 12 * 12; ++v) x[v].y() += y;
    return x;
  };
  const std::vector<std::uint8_t> before = simulation.checkpoint();
  try {
    simulation.set_positions(shifted(-0.1));  // into the ball
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
  }
  EXPECT_EQ(simulation.checkpoint(), before);
  simulation.set_positions(shifted(1));
  EXPECT_TRUE(std::isinf(simulation.diagnostics().min_distance));
  EXPECT_NEAR(simulation.diagnostics().balance(), balance, 1e-9);
  for (int frame = 0; frame < 3; ++frame) simulation.advance();
  EXPECT_NEAR(simulation.diagnostics().balance(), balance, 1e-4);
  Simulation resumed(model);
  resumed.restore(simulation.checkpoint());
  resumed.advance();
  simulation.advance();
  EXPECT_EQ(resumed.checkpoint(), simulation.checkpoint());
}

TEST(ContactRun, HasTheSameBitsOnAnyNumberOfThreads) {
  const auto model = drop(20, Effort::normal);
  std::vector<std::vector<Vec3>> ends;
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    Simulation simulation(model);
    for (int frame = 0; frame < 20; ++frame) simulation.advance();
    ends.push_back(simulation.state().positions);
  }
  set_thread_count(0);
  EXPECT_EQ(ends[0], ends[1]);
}

TEST(ContactRun, RefusesAStartThatCrosses) {
  test::ContactScene scene;
  test::ClothGrid flat(6, 6, 0.1), upright(6, 6, 0.1);
  for (Vec3& p : upright.positions) p = Vec3(p.x() + 0.03, p.z() - 0.23, 0.24);
  scene.add_cloth(flat);
  scene.add_cloth(upright);
  Model strict = *scene.finish();
  strict.scene.contact.tangled = TangledStart::refuse;
  const auto model = std::make_shared<const Model>(std::move(strict));
  EXPECT_FALSE(find_crossings(*model->contact, model->rest_positions).empty());
  try {
    const Simulation simulation(model);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_NE(std::string(error.what()).find("crosses"), std::string::npos) << error.what();
  }
}

TEST(ContactRun, RefusesSymplecticEuler) {
  EXPECT_THROW(Simulation(drop(6, Effort::normal, 4, Integrator::symplectic_euler)), Error);
}

TEST(ContactRun, OtherIntegratorsWorkToo) {
  for (const Integrator integrator : {Integrator::bdf2, Integrator::linearly_implicit_euler}) {
    const auto model = drop(12, Effort::exact, 4, integrator);
    Simulation simulation(model);
    for (int frame = 0; frame < 20; ++frame) {
      simulation.advance();
      ASSERT_TRUE(find_crossings(*model->contact, simulation.state().positions).empty()) << frame;
    }
  }
}

}  // namespace
}  // namespace muslin
