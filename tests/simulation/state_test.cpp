// Nothing but the state matters: runs whose workspaces are thrown away before every step give the
// same bits, and a step that fails leaves the state as it was.
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

#include "support/contact_scene.hpp"
#include "support/small_model.hpp"
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/force/force_function.hpp"
#include "muslin/scene/names.hpp"
#include "muslin/simulation/run_state.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::shared_ptr<const Model> shared(Model model) { return std::make_shared<const Model>(std::move(model)); }

struct ShellOptions {
  Effort effort = Effort::normal;
  Integrator integrator = Integrator::implicit_euler;
  bool wall = false;
};

/// A square of 1 m that falls on a ball of 0.25 m and rubs on it.
std::shared_ptr<const Model> draped(const ShellOptions& options) {
  test::ContactScene scene;
  scene.model.scene.solver.tolerance.reset();
  scene.model.scene.solver.effort = options.effort;
  scene.friction = 0.4;
  scene.model.scene.solver.integrator = options.integrator;
  test::ClothGrid cloth(12, 12, 1.0 / 11);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> noise(-1e-3, 1e-3);
  for (Vec3& p : cloth.positions) p += Vec3(-0.4, 0.26 + noise(random), -0.5);
  scene.add_cloth(cloth);
  scene.add_ball(Vec3::Zero(), 0.25);
  if (options.wall) {
    const std::size_t count = cloth.positions.size();
    scene.model.potentials.push_back(
        {"wall", EnergyRole::elastic,
         std::make_shared<RestrictedPotential>(std::make_shared<test::Wall>(count, 0.1), 0, count)});
  }
  return scene.finish();
}

/// A strip that stands in a sheet and is drawn out of it.
std::shared_ptr<const Model> tangled() {
  test::ContactScene scene;
  test::ClothGrid sheet(11, 11, 0.03), strip(5, 5, 0.03);
  scene.add_cloth(sheet);
  std::vector<int> border;
  for (int j = 0; j < 11; ++j)
    for (int i = 0; i < 11; ++i)
      if (i == 0 || j == 0 || i == 10 || j == 10) border.push_back(11 * j + i);
  scene.hold(border);
  for (Vec3& p : strip.positions) p = Vec3(p.x() + 0.08, p.z() - 0.05, 0.14);
  const int first = scene.add_cloth(strip);
  std::vector<int> all;
  for (int v = 0; v < 25; ++v) all.push_back(first + v);
  Motion motion;
  motion.keys = {{0, Vec3::Zero()}, {0.4, Vec3(0, 0.15, 0)}};
  scene.hold(all, motion);
  return scene.finish(Vec3::Zero());
}

/// A rigid ball that a pin carries into another one and then lets go; both come to lie on a floor.
std::shared_ptr<const Model> rigid(const std::string& effort) {
  return shared(build_model(parse_scene(
      "[[collider]]\nname = 'ball'\nshape = 'sphere'\ncenter = [0, 0.25, 0]\nradius = 0.1\ndensity = 500\n"
      "[[collider]]\nname = 'other'\nshape = 'sphere'\ncenter = [0.25, 0.15, 0]\nradius = 0.1\n"
      "density = 300\n[[collider]]\nname = 'floor'\nshape = 'plane'\n"
      "[[force]]\ntype = 'gravity'\nacceleration = [0, -10, 0]\n"
      "[[pin]]\nbody = 'ball'\nuntil = 0.25\nkeyframes = [{ time = 0 }, { time = 0.25, "
      "translate = [0.1, -0.05, 0] }]\n[solver]\neffort = '" +
          effort + "'\n",
      "scene.toml")));
}

void expect_no_use_of_scratch(const std::shared_ptr<const Model>& model, int frames,
                              const SimulationOptions& options = {}) {
  Simulation kept(model, options), forgetful(model, options);
  while (kept.frame() < frames) {
    forgetful.forget_scratch();
    kept.step();
    forgetful.step();
    ASSERT_EQ(kept.state().positions, forgetful.state().positions) << kept.state().step;
    ASSERT_EQ(kept.state().velocities, forgetful.state().velocities) << kept.state().step;
    ASSERT_EQ(kept.checkpoint(), forgetful.checkpoint()) << kept.state().step;
  }
}

TEST(Scratch, DoesNotAffectALattice) {
  for (const Integrator integrator : {Integrator::implicit_euler, Integrator::bdf2,
                                      Integrator::linearly_implicit_euler, Integrator::symplectic_euler}) {
    SCOPED_TRACE(static_cast<int>(integrator));
    test::SmallModelOptions options;
    options.integrator = integrator;
    options.tolerance = 1e-3;
    options.moving_pin = true;
    options.steps_per_frame = 20;
    expect_no_use_of_scratch(shared(test::small_model(options)), 16);
  }
}

TEST(Scratch, DoesNotAffectAShellInContact) {
  for (const Effort effort : {Effort::draft, Effort::normal, Effort::exact})
    for (const Integrator integrator : {Integrator::implicit_euler, Integrator::bdf2}) {
      SCOPED_TRACE(name_of(effort_names(), effort) + " " + std::to_string(static_cast<int>(integrator)));
      expect_no_use_of_scratch(draped({effort, integrator}), 20);
    }
}

TEST(Scratch, DoesNotAffectPinnedRigidBodies) {
  for (const char* effort : {"draft", "normal", "exact"}) {
    SCOPED_TRACE(effort);
    expect_no_use_of_scratch(rigid(effort), 12);
  }
}

TEST(Scratch, DoesNotAffectATangledStart) {
  const auto model = tangled();
  Simulation whole(model, {.allow_tangled = true});
  ASSERT_GT(whole.tangled(), 0U);
  while (whole.frame() < 30) whole.advance();
  ASSERT_EQ(whole.tangled(), 0U);  // so that the run below goes through all that there is
  expect_no_use_of_scratch(model, 30, {.allow_tangled = true});
}

TEST(Scratch, CostsIncludeForgottenWorkspaces) {
  Simulation simulation(draped({}));
  for (int step = 0; step < 4; ++step) simulation.step();
  const RunCosts before = simulation.costs();
  EXPECT_GT(before.limits, 0);
  simulation.forget_scratch();
  EXPECT_EQ(simulation.costs().limits, before.limits);
  EXPECT_EQ(simulation.costs().solve, before.solve);
  simulation.step();
  EXPECT_GT(simulation.costs().limits, before.limits);
}

/// Goes on until a step throws; before and after it the bytes are the same. They are compared only there:
/// what is in the middle of a step shows to nobody.
template <class Thrown>
void expect_untouched_by_failure(Simulation& simulation) {
  for (int step = 0; step < 1000; ++step) {
    const Bytes before = simulation.checkpoint();
    const std::vector<Vec3> positions = simulation.state().positions;
    try {
      simulation.step();
    } catch (const Thrown&) {
      EXPECT_EQ(simulation.checkpoint(), before);
      EXPECT_EQ(simulation.state().positions, positions);
      return;
    }
  }
  FAIL() << "no step failed";
}

TEST(FailedStep, DoesNotChangeTheState) {
  for (const Effort effort : {Effort::normal, Effort::exact}) {
    Simulation cloth(draped({effort, Integrator::implicit_euler, true}));
    expect_untouched_by_failure<Error>(cloth);
    EXPECT_GT(cloth.state().step, 10);
  }
  test::SmallModelOptions options;
  options.pinned = false;
  Model model = test::small_model(options);
  model.potentials.push_back(
      {"wall", EnergyRole::elastic, std::make_shared<test::Wall>(model.vertex_count(), -0.05)});
  Simulation lattice(shared(std::move(model)));
  expect_untouched_by_failure<Error>(lattice);
}

TEST(FailedStep, OfAThrowingLoadIsRepeatedWithTheSameBits) {
  for (const Effort effort : {Effort::normal, Effort::exact}) {
    const auto model = draped({effort});
    Simulation simulation(model), undisturbed(model);
    int calls = 0;
    const auto load = [](ForceFunction::Function function) {
      return LoadTerm{"fuse", EnergyRole::work, std::make_shared<ForceFunction>("fuse", std::move(function))};
    };
    simulation.add_load(load([&](double, ConstVectors, ConstVectors, Vectors) {
      if (++calls == 60) throw std::runtime_error("blown");
    }));
    undisturbed.add_load(load([](double, ConstVectors, ConstVectors, Vectors) {}));
    expect_untouched_by_failure<std::runtime_error>(simulation);
    while (undisturbed.frame() < 20) undisturbed.advance();
    while (simulation.frame() < 20) simulation.advance();
    EXPECT_EQ(simulation.checkpoint(), undisturbed.checkpoint());
  }
}

TEST(RunState, IsRestoredFromACheckpointWithEveryArray) {
  Simulation simulation(draped({}));
  for (int step = 0; step < 70; ++step) simulation.step();
  const Bytes bytes = simulation.checkpoint();
  const RunState state = from_checkpoint(bytes, simulation.model().vertex_count());
  EXPECT_EQ(state.frame, simulation.frame());
  EXPECT_EQ(state.steps_done, 2);
  EXPECT_FALSE(state.contact.slips.empty());
  EXPECT_EQ(state.energy.terms.size(), state.energy.stored.size());
  EXPECT_EQ(to_checkpoint(read_checkpoint_header(bytes), state), bytes);
  EXPECT_THROW(from_checkpoint(bytes, simulation.model().vertex_count() + 1), Error);
}

}  // namespace
}  // namespace muslin
