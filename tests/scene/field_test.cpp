// Fields as kinds of `[[force]]`: what is read and refused, that uniform is gravity, drag in closed form, the
// balance of energy, resumed runs, and the wind to which fields add.
#include <cmath>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/scene/field_force.hpp"
#include "muslin/scene/field_force_settings.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

using testing::HasSubstr;

/// A scene of one free square of 0.1 kg that feels the forces.
Scene square(const std::string& forces) {
  Scene scene = parse_scene(
      "[time]\nduration = 0.5\nsteps_per_frame = 4\n"
      "[[body]]\nname = 'sheet'\nmodel = 'shell'\nmesh = 'square'\ncontact = false\n"
      "material = { areal_density = 0.1, membrane_warp = 1000, bending_warp = 1e-5 }\n" +
          forces,
      "scene.toml");
  Mesh mesh;
  for (int j = 0; j < 5; ++j)
    for (int i = 0; i < 5; ++i) mesh.positions.emplace_back(0.25 * i, 0, 0.25 * j);
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i)
      mesh.add_face(std::array{5 * j + i, 5 * j + i + 5, 5 * j + i + 6, 5 * j + i + 1});
  scene.meshes["square"] = std::make_shared<const Mesh>(mesh);
  return scene;
}

Simulation simulated(const std::string& forces, int frames) {
  Simulation simulation(std::make_shared<const Model>(build_model(square(forces))));
  for (int frame = 0; frame < frames; ++frame) simulation.advance();
  return simulation;
}

std::string message(const std::string& forces) {
  try {
    build_model(square(forces));
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

std::string force(const std::string& type, const std::string& keys) {
  return "[[force]]\ntype = '" + type + "'\n" + keys + "\n";
}

const std::string gusty =
    force("wind", "velocity = [3, 0, 1]\nporosity = 0.2") +
    force("turbulence", "acts_as = 'wind'\nstrength = 2\nlargest = 0.5\ntravel = [3, 0, 1]") +
    force("vortex",
          "acts_as = 'wind'\nstrength = 4\ncenter = [0.5, 0, 0.5]\nradius = 0.3\naxis = [1, 0, 0]") +
    force("curve",
          "acts_as = 'acceleration'\nstrength = 3\nattraction = 1\npoints = [[0, 0, 0], [1, 1, 1]]") +
    force("drag", "linear = 0.5\nregion = { box = [[0, -1, 0], [1, 1, 0.5]], fade = 0.1 }");

TEST(FieldScene, UniformMovesAsGravityDoes) {
  const Simulation falls = simulated(force("gravity", "acceleration = [0, -5, 0]"), 6);
  const Simulation blown =
      simulated(force("uniform", "acts_as = 'acceleration'\nstrength = 5\ndirection = [0, -1, 0]"), 6);
  EXPECT_LT(falls.state().positions.front().y(), -0.1);
  for (std::size_t v = 0; v < 25; ++v)
    EXPECT_LT((falls.state().positions[v] - blown.state().positions[v]).norm(), 1e-12);
  EXPECT_NEAR(blown.diagnostics().work, blown.diagnostics().kinetic + blown.diagnostics().dissipated, 1e-9);
}

TEST(FieldScene, DragSlowsAFallToItsTerminalSpeed) {
  const double rate = 20, speed = 9.8 / rate;
  const Simulation simulation = simulated(force("gravity", "") + force("drag", "linear = 20"), 12);
  for (const Vec3& v : simulation.state().velocities) EXPECT_NEAR(-v.y(), speed, 1e-3 * speed);
  EXPECT_GT(simulation.diagnostics().dissipated, 0);
}

TEST(FieldScene, EnergyBalances) {
  Simulation simulation(
      std::make_shared<const Model>(build_model(square(gusty + "[solver]\neffort = 'exact'\n"))));
  const double before = simulation.diagnostics().balance();
  for (int frame = 0; frame < 12; ++frame) simulation.advance();
  EXPECT_GT(simulation.diagnostics().work, 0.01);
  EXPECT_NEAR(simulation.diagnostics().balance(), before, 1e-4 * simulation.diagnostics().work);
}

TEST(FieldScene, HasTheSameBitsForAnyThreadCountAndAfterAResume) {
  const Simulation whole = simulated(gusty, 6);
  const int threads = thread_count();
  set_thread_count(1);
  const auto model = std::make_shared<const Model>(build_model(square(gusty)));
  Simulation first(model);
  for (int frame = 0; frame < 3; ++frame) first.advance();
  Simulation second(model);
  second.restore(first.checkpoint());
  for (int frame = 0; frame < 3; ++frame) second.advance();
  set_thread_count(threads);
  EXPECT_EQ(whole.state().positions, second.state().positions);
  EXPECT_EQ(whole.state().velocities, second.state().velocities);
}

TEST(FieldScene, ResolvedSceneHasItsDefaults) {
  const auto json = nlohmann::json::parse(
      square(force("wind", "velocity = [0, 0, 0]") + force("vortex", "acts_as = 'wind'\nstrength = 2"))
          .resolved);
  const auto& vortex = json["force"][1];
  EXPECT_EQ(vortex["name"], "vortex1");
  EXPECT_EQ(vortex["acts_as"], "wind");
  EXPECT_EQ(vortex["strength"], 2);
  EXPECT_EQ(vortex["radius"], 1);
  EXPECT_EQ(vortex["axis"], nlohmann::json({0, 1, 0}));
  EXPECT_FALSE(vortex.contains("falloff"));
  EXPECT_EQ(json["force"][0]["porosity"], 0);
}

TEST(FieldScene, VortexIsRankinesUnlessItHasAnotherFalloff) {
  const std::string calm = force("wind", "name = 'air'\nvelocity = [0, 0, 0]");
  const std::string vortex = "acts_as = 'wind'\nstrength = 2\nradius = 0.5\naxis = [0, 0, 1]\n";
  const auto speed = [&](const std::string& more) {
    const Scene scene = square(calm + force("vortex", vortex + more));
    const std::vector<Field> fields = fields_in_air(scene, scene.forces.front(), "sheet");
    return fields.front().at(Vec3(2, 0, 0), 0).y();
  };
  EXPECT_NEAR(speed(""), 0.25, 1e-15);                      // 0.5 / 2 for a strength of 1
  EXPECT_NEAR(speed("falloff = { power = 0 }"), 4, 1e-15);  // solid rotation
  EXPECT_NEAR(speed("falloff = { max = 1 }"), 0, 1e-15);
}

TEST(FieldScene, FieldsAddToTheWindTheyName) {
  const std::string winds = force("wind", "name = 'north'\nvelocity = [0, 0, 1]") +
                            force("wind", "name = 'east'\nvelocity = [1, 0, 0]");
  const std::string breeze = "acts_as = 'wind'\nstrength = 2\ndirection = [1, 0, 0]\n";
  const Scene scene = square(winds + force("uniform", breeze + "wind = 'east'"));
  EXPECT_EQ(fields_in_air(scene, scene.forces[0], "sheet").size(), 0u);
  EXPECT_EQ(fields_in_air(scene, scene.forces[1], "sheet").size(), 1u);
  EXPECT_THAT(message(winds + force("uniform", breeze)), HasSubstr("to which of the 2 winds it adds"));
  EXPECT_THAT(message(winds + force("uniform", breeze + "wind = 'eest'")), HasSubstr("did you mean `east`"));
  EXPECT_THAT(message(force("uniform", breeze)), HasSubstr("the scene has no wind"));
}

TEST(FieldScene, GridNamesItsFileAndPlace) {
  const std::string text =
      message(force("grid", "acts_as = 'acceleration'\nstrength = 1\nfile = 'none.npy'"));
  EXPECT_THAT(text, HasSubstr("scene.toml:"));
  EXPECT_THAT(text, HasSubstr("none.npy"));
  EXPECT_THAT(message(force("grid",
                            "acts_as = 'acceleration'\nstrength = 1\nfile = 'none.npy'\n"
                            "spacing = [1, 0, 1]")),
              HasSubstr("not above 0"));
}

TEST(FieldScene, RefusesWhatHasNoMeaning) {
  const std::string pushes = "acts_as = 'acceleration'\nstrength = 1\n";
  EXPECT_THAT(message(force("vortex", "strength = 1")), HasSubstr("acts_as"));
  EXPECT_THAT(message(force("vortex", "acts_as = 'acceleration'")), HasSubstr("strength"));
  EXPECT_THAT(message(force("vortex", pushes + "axis = [0, 0, 0]")), HasSubstr("axis"));
  EXPECT_THAT(message(force("vortex", pushes + "radius = 0")), HasSubstr("radius"));
  EXPECT_THAT(message(force("uniform", pushes)), HasSubstr("direction"));
  EXPECT_THAT(message(force("radial", pushes + "wind = 'air'")), HasSubstr("adds to no wind"));
  EXPECT_THAT(message(force("radial", pushes + "region = { fade = 1 }")), HasSubstr("has no shape"));
  EXPECT_THAT(message(force("radial", pushes + "region = { box = [[1, 0, 0], [0, 1, 1]] }")),
              HasSubstr("not below the second"));
  EXPECT_THAT(message(force("radial", pushes + "region = { cylinder = { from = [1, 0, 0], to = [1, 0, 0], "
                                               "radius = 1 } }")),
              HasSubstr("ends where it begins"));
  EXPECT_THAT(message(force("radial", pushes + "falloff = { min = 2, max = 1 }")),
              HasSubstr("is below `min`"));
  EXPECT_THAT(message(force("radial", pushes + "falloff = { power = -1 }")), HasSubstr("power"));
  EXPECT_THAT(message(force("turbulence", pushes + "largest = 1\nsmallest = 2")),
              HasSubstr("above `largest`"));
  EXPECT_THAT(message(force("turbulence", pushes + "turnover = 0")), HasSubstr("turnover"));
  EXPECT_THAT(message(force("curve", pushes + "points = [[0, 0, 0]]")), HasSubstr("has 1 points"));
  EXPECT_THAT(message(force("curve", pushes + "points = [[0, 0, 0], [0, 0, 0]]")), HasSubstr("are equal"));
  EXPECT_THAT(message(force("drag", "")), HasSubstr("the drag is 0"));
  EXPECT_THAT(message(force("drag", "linear = -1")), HasSubstr("linear"));
  EXPECT_THAT(message(force("drag", "linear = 1\nacts_as = 'wind'")), HasSubstr("acts_as"));
  EXPECT_THAT(message(force("wind", "velocity = [0, 0, 0]\nporosity = 2")), HasSubstr("porosity"));
}

}  // namespace
}  // namespace muslin
