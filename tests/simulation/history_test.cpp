// Loads keep what they remember in the state: plastic hinges stay bent, their loss is in the energy balance,
// and checkpoints, failed steps and lost workspaces leave no trace.
#include "muslin/potential/history.hpp"

#include <cmath>

#include "support/contact_scene.hpp"
#include "support/plastic_hinges.hpp"
#include "support/small_model.hpp"
#include <gtest/gtest.h>

#include "muslin/component/shell/shell_body.hpp"
#include "muslin/core/error.hpp"
#include "muslin/potential/mass_damping.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

constexpr double fold = 1.0, yield = 0.3, rigidity = 1e-2, spacing = 0.1;
constexpr double let_go = 0.4;   // [s]
constexpr int held_frames = 19;  // of 1/50 s, the last whole one before

/// Two triangles held at one of them; the other one is folded by a pin until `let_go`.
struct Fold {
  std::shared_ptr<const test::PlasticHinges> hinges;
  std::shared_ptr<const Model> model;

  explicit Fold(double hardening = 0, bool wall = false) {
    test::ContactScene scene(10, 50);
    test::ClothMaterial cloth;
    cloth.bending = 0;
    scene.add_cloth(test::ClothGrid(2, 2, spacing), cloth);
    scene.model.scene.solver.tolerance = 1e-9;
    scene.hold({0, 1, 2});
    const Vec3 axis = Vec3(-1, 0, 1).normalized();
    Motion motion;
    motion.pivot = Vec3(spacing, 0, 0);
    motion.keys = {{0, Vec3::Zero()},
                   {0.3, Vec3::Zero(), Eigen::Quaterniond(Eigen::AngleAxisd(-fold, axis))}};
    scene.hold({3}, motion);
    scene.model.pins.back().until = let_go;
    const Shell& shell = as_shell(scene.model.bodies[0])->shell;
    hinges = std::make_shared<test::PlasticHinges>("fold", shell, BendingModuli{rigidity, rigidity, rigidity},
                                                   test::YieldLimit{yield, hardening}, block_pattern(shell));
    scene.model.loads.push_back(
        {"fold", EnergyRole::elastic, std::make_shared<RestrictedLoad>(hinges, 0, 4)});
    scene.model.loads.push_back(
        {"drag", EnergyRole::dissipation, std::make_shared<MassDamping>(60, scene.model.masses)});
    if (wall)
      scene.model.potentials.push_back({"wall", EnergyRole::elastic, std::make_shared<test::Wall>(4, -0.03)});
    model = std::make_shared<const Model>(scene.model);
  }

  double stiffness() const {
    const Hinge& hinge = as_shell(model->bodies[0])->shell.hinges[0];
    return rigidity * hinge.length * hinge.length / hinge.area;
  }
  static double angle(const Simulation& simulation, const Model& model) {
    const std::vector<Vec3>& x = simulation.state().positions;
    const auto& v = as_shell(model.bodies[0])->shell.hinges[0].vertices;
    return std::abs(hinge_angle(x[static_cast<std::size_t>(v[0])], x[static_cast<std::size_t>(v[1])],
                                x[static_cast<std::size_t>(v[2])], x[static_cast<std::size_t>(v[3])]));
  }
};

TEST(PlasticHinges, YieldedHingeKeepsItsAngleMinusTheYieldAngle) {
  for (const double hardening : {0.0, 0.5}) {
    const Fold f(hardening);
    Simulation simulation(f.model);
    while (simulation.frame() < held_frames) simulation.advance();
    EXPECT_NEAR(Fold::angle(simulation, *f.model), fold, 1e-9);
    const double slip = (fold - yield) / (1 + hardening);
    EXPECT_NEAR(std::abs(f.hinges->plastic_angles(simulation.state().history)[0]), slip, 1e-9);
    while (simulation.frame() < 60) simulation.advance();
    EXPECT_NEAR(Fold::angle(simulation, *f.model), slip, 1e-4);
    EXPECT_NEAR(std::abs(f.hinges->plastic_angles(simulation.state().history)[0]), slip, 1e-9);
  }
}

TEST(PlasticHinges, HingeBelowItsYieldAngleSpringsBack) {
  const Fold f(2000);  // yields by less than 1e-3
  Simulation simulation(f.model);
  while (simulation.frame() < 60) simulation.advance();
  EXPECT_NEAR(Fold::angle(simulation, *f.model), 0, 1e-3);
}

TEST(PlasticHinges, PlasticWorkIsInTheEnergyBalance) {
  const Fold f;
  Simulation simulation(f.model);
  while (simulation.frame() < held_frames) simulation.advance();
  const Diagnostics& row = simulation.diagnostics();
  const double plastic = f.stiffness() * yield * (fold - yield);
  EXPECT_NEAR(row.elastic, 0.5 * f.stiffness() * yield * yield, 1e-6 * row.elastic);
  EXPECT_GE(row.dissipated, plastic * (1 - 1e-9));
  EXPECT_LE(row.dissipated, 1.1 * plastic);  // drag, and the steps of the implicit integrator
  EXPECT_NEAR(row.balance(), 0, 1e-6 * plastic);
  while (simulation.frame() < 60) simulation.advance();
  EXPECT_NEAR(simulation.diagnostics().balance(), 0, 1e-6 * plastic);
}

TEST(History, ResumedRunHasTheSameBits) {
  const Fold f(0.2);
  Simulation whole(f.model);
  for (int frame = 0; frame < 10; ++frame) whole.advance();
  const std::vector<std::uint8_t> bytes = whole.checkpoint();
  EXPECT_GT(std::abs(f.hinges->plastic_angles(whole.state().history)[0]), 0);
  Simulation resumed(f.model);
  resumed.restore(bytes);
  for (int frame = 0; frame < 20; ++frame) {
    whole.advance();
    resumed.advance();
    resumed.forget_scratch();
  }
  EXPECT_EQ(whole.state().positions, resumed.state().positions);
  EXPECT_EQ(whole.checkpoint(), resumed.checkpoint());
}

TEST(History, FailedStepDoesNotChangeIt) {
  const Fold f(0, true);
  Simulation simulation(f.model);
  for (int step = 0; step < 1000; ++step) {
    const std::vector<std::uint8_t> before = simulation.checkpoint();
    try {
      simulation.step();
    } catch (const Error&) {
      EXPECT_GT(std::abs(f.hinges->plastic_angles(simulation.state().history)[0]), 0) << "it had yielded";
      EXPECT_EQ(simulation.checkpoint(), before);
      return;
    }
  }
  FAIL() << "no step failed";
}

TEST(History, KeepsArraysByNameAndRefusesAnotherNumberOfElements) {
  History history;
  EXPECT_TRUE(history.find("a", 2).empty());
  history.get("a", 2)[1] = 3;
  history.get("b", 3)[0] = 5;
  history.get("", 1)[0] = 7;
  EXPECT_EQ(history.find("a", 2)[1], 3);
  EXPECT_EQ(history.find("b", 3)[0], 5);
  EXPECT_EQ(history.find("", 1)[0], 7);
  EXPECT_EQ(history.get("a", 2)[1], 3);
  EXPECT_THROW((void)history.find("b", 2), Error);
  history.values.pop_back();
  EXPECT_THROW((void)history.find("", 1), Error);
}

struct Names {
  std::vector<std::string> all;
  template <class Array>
  void operator()(std::string_view name, const Array&) {
    all.emplace_back(name);
  }
};

TEST(History, RunsWithoutHistoryDoNotWriteIt) {
  Names names;
  const State state;
  State::name_arrays(state, names);
  for (const std::string& name : names.all) EXPECT_FALSE(name.starts_with("history"));
}

}  // namespace
}  // namespace muslin
