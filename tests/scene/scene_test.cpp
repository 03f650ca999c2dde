// Reading scene files: every key, every default, every way to get them wrong.
#include "muslin/scene/scene.hpp"

#include <filesystem>
#include <fstream>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "muslin/component/lattice/lattice_body_settings.hpp"
#include "muslin/scene/wind_force_settings.hpp"

namespace muslin {
namespace {

using testing::HasSubstr;

const std::string flag_body = R"(
[[body]]
name = "flag"
mesh = "flag.obj"
voxel_width = 1.0
material = "thesis_flag"
)";

Scene parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return parse_scene(text, "folder/scene.toml", overrides);
}

std::string message(const std::string& text, const std::vector<std::string>& overrides = {},
                    ErrorKind kind = ErrorKind::input) {
  try {
    parse(text, overrides);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind);
    return error.what();
  }
  return "no error";
}

TEST(Scene, MissingKeysHaveDefaults) {
  const Scene scene = parse(flag_body);
  EXPECT_EQ(scene.title, "scene");
  EXPECT_EQ(scene.time.duration, 2);
  EXPECT_EQ(scene.time.frame_rate, 24);
  EXPECT_FALSE(scene.time.steps_per_frame) << "automatic";
  EXPECT_EQ(scene.solver.integrator, Integrator::implicit_euler);
  EXPECT_EQ(scene.solver.effort, Effort::normal);
  EXPECT_EQ(scene.solver.error_tolerance(), 0.2);
  ASSERT_EQ(scene.bodies.size(), 1u);
  const BodySettings& body = scene.bodies.front();
  const auto& own = body.own.as<LatticeBodySettings>();
  EXPECT_EQ(own.lattice.rule, VoxelRule::cover);
  EXPECT_EQ(own.bracing, Bracing::kuhn);
  EXPECT_EQ(own.mass, LatticeBodySettings::Mass::solid);
  EXPECT_EQ(own.boundary_springs, LatticeBodySettings::BoundarySprings::full);
  EXPECT_EQ(body.scale, Vec3(1, 1, 1));
  EXPECT_FALSE(own.thickness);
  EXPECT_EQ(body.material.edge_modulus, 20000);
  EXPECT_TRUE(scene.pins.empty() && scene.forces.empty() && scene.probes.empty());
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(Scene, ReadsEveryKey) {
  const Scene scene = parse(R"(
title = "all"
[time]
duration = 1.5
frame_rate = 30
steps_per_frame = 4
[solver]
integrator = "bdf2"
effort = "exact"
tolerance = 1e-5
linear_tolerance = 1e-9
[[body]]
name = "flag"
mesh = "meshes/a.obj"
model = "lattice"
thickness = 0.5
voxel_width = 0.25
voxels = "threshold"
threshold = 0.7
bracing = "full"
mass = "cells"
boundary_springs = "shared"
translate = [1, 2, 3]
rotate = [90, 0, 45]
scale = 2
velocity = [0, 1, 0]
[body.material]
density = 3
edge_modulus = 100
face_diagonal_modulus = 10
body_diagonal_modulus = 5
volume_modulus = 7
mass_damping = 0.1
stiffness_damping = 0.02
[[body]]
name = "b"
mesh = "b.obj"
voxel_width = 1
scale = [1, 2, 3]
material = { base = "thesis_flag", density = 4 }
[[pin]]
name = "top"
body = "flag"
where = { group = "g", box = [[0, 0, 0], [1, 1, 1]], sphere = { center = [1, 0, 0], radius = 2 }, plane = { point = [0, 1, 0], normal = [0, 2, 0] }, line = { from = [0, 0, 0], to = [1, 0, 0], distance = 0.1 }, nearest = [[1, 2, 3], [4, 5, 6]] }
from = 0.5
until = 1
pivot = [0, 1, 0]
keyframes = [{ time = 0 }, { time = 1, translate = [1, 0, 0], rotate = [0, 90, 0] }]
[[force]]
type = "gravity"
acceleration = [0, -1.6, 0]
[[force]]
type = "point"
name = "push"
body = "b"
where = { nearest = [1, 2, 3] }
keyframes = [{ time = 0, value = [0, 0, 0] }, { time = 1, value = [2, 0, 0] }]
until = 0.5
[[force]]
type = "wind"
body = "b"
velocity = [5, 0, 0]
air_density = 1.1
drag = 2
lift = 0.3
[[probe]]
name = "tip"
body = "b"
at = [1, 2, 3]
)");
  EXPECT_EQ(scene.title, "all");
  EXPECT_EQ(scene.time.frames(), 45);
  EXPECT_EQ(scene.solver.integrator, Integrator::bdf2);
  EXPECT_EQ(scene.time.steps_per_frame, 4);
  EXPECT_EQ(scene.solver.effort, Effort::exact);
  EXPECT_EQ(scene.solver.tolerance, 1e-5);
  EXPECT_EQ(scene.solver.linear_tolerance, 1e-9);
  ASSERT_EQ(scene.bodies.size(), 2u);
  const BodySettings& body = scene.bodies[0];
  EXPECT_EQ(resolve_path(scene, body.mesh), std::filesystem::path("folder/meshes/a.obj"));
  const auto& own = body.own.as<LatticeBodySettings>();
  EXPECT_EQ(own.thickness, 0.5);
  EXPECT_EQ(own.lattice.width, 0.25);
  EXPECT_EQ(own.lattice.rule, VoxelRule::threshold);
  EXPECT_EQ(own.lattice.threshold, 0.7);
  EXPECT_EQ(own.bracing, Bracing::full);
  EXPECT_EQ(own.mass, LatticeBodySettings::Mass::cells);
  EXPECT_EQ(own.boundary_springs, LatticeBodySettings::BoundarySprings::shared);
  EXPECT_EQ(body.translate, Vec3(1, 2, 3));
  EXPECT_EQ(body.rotate, Vec3(90, 0, 45));
  EXPECT_EQ(body.scale, Vec3(2, 2, 2));
  EXPECT_EQ(body.velocity, Vec3(0, 1, 0));
  EXPECT_EQ(body.material.volume_modulus, 7);
  EXPECT_EQ(body.material.mass_damping, 0.1);
  EXPECT_EQ(body.material.stiffness_damping, 0.02);
  EXPECT_EQ(scene.bodies[1].material.density, 4);
  EXPECT_EQ(scene.bodies[1].material.edge_modulus, 20000);
  EXPECT_EQ(scene.bodies[1].scale, Vec3(1, 2, 3));
  const PinSettings& pin = scene.pins.front();
  EXPECT_EQ(pin.where.group, "g");
  EXPECT_EQ(pin.where.box->max, Vec3(1, 1, 1));
  EXPECT_EQ(pin.where.sphere->radius, 2);
  EXPECT_EQ(pin.where.plane->normal, Vec3(0, 1, 0));
  EXPECT_FALSE(pin.where.plane->distance);
  EXPECT_EQ(pin.where.line->distance, 0.1);
  EXPECT_EQ(pin.where.nearest.size(), 2u);
  EXPECT_EQ(pin.from, 0.5);
  EXPECT_EQ(pin.until, 1);
  EXPECT_EQ(pin.pivot, Vec3(0, 1, 0));
  ASSERT_EQ(pin.motion.keys.size(), 2u);
  EXPECT_LT((pin.motion.keys[1].rotate * Vec3(1, 0, 0) - Vec3(0, 0, -1)).norm(), 1e-15);
  ASSERT_EQ(scene.forces.size(), 3u);
  EXPECT_EQ(scene.forces[0].value.at(0), Vec3(0, -1.6, 0));
  EXPECT_EQ(scene.forces[0].body, "");
  EXPECT_EQ(scene.forces[0].name, "gravity0");
  EXPECT_EQ(scene.forces[1].value.at(0.5), Vec3(1, 0, 0));
  EXPECT_EQ(scene.forces[1].until, 0.5);
  EXPECT_EQ(scene.forces[2].own.as<WindForceSettings>().air_density, 1.1);
  EXPECT_EQ(scene.forces[2].own.as<WindForceSettings>().drag, 2);
  EXPECT_EQ(scene.forces[2].own.as<WindForceSettings>().lift, 0.3);
  EXPECT_EQ(scene.probes[0].at, Vec3(1, 2, 3));
}

TEST(Scene, ResolvedJsonHoldsEverySettingWithItsDefault) {
  const auto json = nlohmann::json::parse(parse(flag_body + "[[force]]\ntype = 'gravity'\n").resolved);
  EXPECT_EQ(json["time"]["steps_per_frame"], "auto");
  EXPECT_EQ(json["solver"]["effort"], "normal");
  EXPECT_EQ(json["solver"]["tolerance"], 0.2);
  EXPECT_EQ(json["body"][0]["thickness"], 1.0);
  EXPECT_EQ(json["body"][0]["material"]["edge_modulus"], 20000);
  EXPECT_EQ(json["force"][0]["acceleration"][1], -9.8);
  EXPECT_TRUE(json["force"][0]["until"].is_null());
}

TEST(Scene, StepsAreANumberOrAutomatic) {
  const auto steps = [](const std::string& value, const std::vector<std::string>& overrides = {}) {
    return parse_scene("[time]\nsteps_per_frame = " + value + "\n" + flag_body, "scene.toml", overrides);
  };
  EXPECT_FALSE(steps("\"auto\"").time.steps_per_frame);
  EXPECT_EQ(steps("10").time.steps_per_frame, 10);
  EXPECT_FALSE(steps("10", {"time.steps_per_frame=auto"}).time.steps_per_frame);
  const Scene ten = steps("\"auto\"", {"time.steps_per_frame=10"});
  EXPECT_EQ(ten.time.steps_per_frame, 10);
  EXPECT_EQ(nlohmann::json::parse(ten.resolved)["time"]["steps_per_frame"], 10);
}

TEST(Scene, EffortChangesAtItsKeyframes) {
  const Scene scene = parse(
      "[solver]\neffort = { keyframes = [{ time = 0, value = 'draft' }, { time = 1, value = 'exact' }] }\n" +
      flag_body);
  EXPECT_EQ(scene.solver.effort_at(0), Effort::draft);
  EXPECT_EQ(scene.solver.effort_at(0.99), Effort::draft);
  EXPECT_EQ(scene.solver.effort_at(1), Effort::exact);
  EXPECT_EQ(scene.solver.at(5).error_tolerance(), 1e-3);
  const auto json = nlohmann::json::parse(scene.resolved);
  EXPECT_EQ(json["solver"]["effort"]["keyframes"][1]["value"], "exact");
  EXPECT_FALSE(json["solver"].contains("tolerance")) << "it would be that of one effort";
}

TEST(Scene, EveryEffortHasItsTolerance) {
  for (const auto& [name, tolerance] : {std::pair{"draft", 1.0}, {"normal", 0.2}, {"exact", 1e-3}})
    EXPECT_EQ(parse(std::string("[solver]\neffort = '") + name + "'\n" + flag_body).solver.error_tolerance(),
              tolerance);
}

TEST(Scene, WarnsOfSettingsThatTheIntegratorDoesNotUse) {
  const auto warnings = [](const std::string& solver) {
    return parse("[solver]\n" + solver + flag_body).warnings;
  };
  using testing::ElementsAre, testing::HasSubstr, testing::IsEmpty;
  for (const std::string integrator : {"implicit_euler", "bdf2"}) {
    EXPECT_THAT(warnings("integrator = '" + integrator + "'\neffort = 'draft'\ntolerance = 1e-3\n"),
                IsEmpty());
    EXPECT_THAT(warnings("integrator = '" + integrator + "'\nlinear_tolerance = 1e-3\n"),
                ElementsAre(HasSubstr("`linear_tolerance` has no effect on " + integrator)));
  }
  const std::string linear = "integrator = 'linearly_implicit_euler'\n",
                    symplectic = "integrator = 'symplectic_euler'\n";
  EXPECT_THAT(warnings(linear + "linear_tolerance = 1e-9\neffort = 'draft'\n"), IsEmpty());
  EXPECT_THAT(warnings(linear + "effort = 'draft'\n[time]\nsteps_per_frame = 4\n"),
              ElementsAre(HasSubstr("`effort` has no effect on linearly_implicit_euler with a number")));
  EXPECT_THAT(warnings(linear + "effort = 'exact'\n"),
              ElementsAre(HasSubstr("`effort` has no effect on linearly_implicit_euler but for drafts")));
  EXPECT_THAT(warnings(linear + "tolerance = 0.1\n"), ElementsAre(HasSubstr("`tolerance` has no effect")));
  EXPECT_THAT(warnings(symplectic + "tolerance = 0.1\nlinear_tolerance = 0.1\neffort = 'exact'\n"),
              ElementsAre(HasSubstr("`linear_tolerance`"), HasSubstr("`tolerance`"), HasSubstr("`effort`")));
}

TEST(Scene, OnlyBodyIsTheDefault) {
  const Scene scene =
      parse(flag_body + "[[pin]]\nwhere = { nearest = [0, 0, 0] }\n[[probe]]\nat = [0, 0, 0]\n");
  EXPECT_EQ(scene.pins[0].body, "flag");
  EXPECT_EQ(scene.pins[0].name, "pin0");
  EXPECT_EQ(scene.probes[0].body, "flag");
}

struct Wrong {
  std::string text;
  std::string expected;
};
void PrintTo(const Wrong& wrong, std::ostream* out) { *out << wrong.text; }

class WrongScene : public testing::TestWithParam<Wrong> {};

TEST_P(WrongScene, IsAnErrorThatSaysWhatToDo) {
  EXPECT_THAT(message(GetParam().text), HasSubstr(GetParam().expected));
}

INSTANTIATE_TEST_SUITE_P(
    All, WrongScene,
    testing::Values(
        Wrong{"", "scene.toml: the scene has no body; add a [[body]]"}, Wrong{"[time\n", "scene.toml:1:"},
        Wrong{"tmie = 2\n" + flag_body,
              "scene.toml:1:1: unknown key `tmie` in the scene; did you mean `time`?"},
        Wrong{"[time]\nduration = -1\n" + flag_body,
              "scene.toml:2:12: `duration` of `time` of the scene is -1; give a number above 0"},
        Wrong{"[time]\nduration = nan\n" + flag_body, "is nan"},
        Wrong{"[time]\nduration = 1e6\nframe_rate = 100\n" + flag_body, "more than a million frames"},
        Wrong{"[time]\nsteps_per_frame = 1.5\n" + flag_body, "scene.toml:2:19: `steps_per_frame` is neither"},
        Wrong{"[time]\nsteps_per_frame = 0\n" + flag_body, "write \"auto\" or a whole number from 1"},
        Wrong{"[time]\nsteps_per_frame = 'many'\n" + flag_body, "write \"auto\" or a whole number from 1"},
        Wrong{"[solver]\neffort = 'exat'\n" + flag_body, "did you mean `exact`?"},
        Wrong{"[solver]\neffort = { keyframes = [{ time = 0, value = 'exat' }] }\n" + flag_body,
              "did you mean `exact`?"},
        Wrong{"[solver]\neffort = { keyframes = [{ time = 1, value = 'draft' }, { time = 0, value = "
              "'exact' }] }\n" +
                  flag_body,
              "does not come after"},
        Wrong{flag_body + "[[force]]\ntype = 'wind'\nvelocity = [1, 0, 0]\ngust = { keyframes = [{ time = 0, "
                          "value = -1 }] }\n",
              "`gust` is -1 at 0 s"},
        Wrong{flag_body + "[[force]]\ntype = 'wind'\nvelocity = [1, 0, 0]\nlift = { keyframes = [{ time = 0, "
                          "value = 1 }, { time = 2, value = 1.5 }] }\n",
              "`lift` = 1.5 is above `drag` = 1.17 at 2 s"},
        Wrong{flag_body + "[[force]]\ntype = 'gravity'\nkeyframes = [{ time = 0, value = [0, 0, 0], "
                          "interpolation = 'smoth' }]\n",
              "did you mean `smooth`?"},
        Wrong{flag_body + "[[force]]\ntype = 'gravity'\nkeyframes = [{ time = nan, value = [0, 0, 0] }]\n",
              "time"},
        Wrong{"[solver]\nmax_iterations = 9\n" + flag_body, "unknown key `max_iterations`"},
        Wrong{"[solver]\ntolerance = 2\n" + flag_body, "give a number above 0 to 1"},
        Wrong{"[solver]\nintegrator = 'implicit'\n" + flag_body, "did you mean `implicit_euler`?"},
        Wrong{"[solver]\ntolerance = 0\n" + flag_body, "give a number above 0 to 1"},
        Wrong{"body = 3\n", "write [[body]] in two brackets"}, Wrong{"body = [3]\n", "[[body]] 0 is 3"},
        Wrong{"[body]\nmesh = 'a.obj'\n", "write [[body]] in two brackets"},
        Wrong{"[[body]]\nmesh = 'a.obj'\nmaterial = 'thesis_flag'\n", "has no `voxel_width`"},
        Wrong{"[[body]]\nmehs = 'a.obj'\n", "did you mean `mesh`?"},
        Wrong{"[[body]]\nmesh = 'a.obj'\nvoxel_width = 1\n", "has no `material`"},
        Wrong{"[[body]]\nmesh = 'a.obj'\nvoxel_width = 0\nmaterial = 'thesis_flag'\n", "`voxel_width`"},
        Wrong{"[[body]]\nmesh = 'a.obj'\nvoxel_width = 1\nmaterial = 'thesis_falg'\n",
              "scene.toml:4:12: there is no material `thesis_falg`; did you mean `thesis_flag`?"},
        Wrong{"[[body]]\nmesh = 'a.obj'\nvoxel_width = 1\nmaterial = { density = 1 }\n",
              "has no `edge_modulus`"},
        Wrong{"[[body]]\nmesh = 'a.obj'\nvoxel_width = 1\nmaterial = { densty = 1 }\n",
              "did you mean `density`?"},
        Wrong{"[[body]]\nname = 'a/b'\nmesh = 'a.obj'\nvoxel_width = 1\n", "cannot be a name"},
        Wrong{flag_body + "contact = 1\n", "write true or false"},
        Wrong{"[[body]]\nmesh = 'a.obj'\nvoxel_width = 1\nmaterial = { areal_density = 1 }\n",
              "unknown key `areal_density`"},
        Wrong{flag_body + flag_body, "two of [[body]] called `flag`"},
        Wrong{flag_body + "[[pin]]\n", "has no `where`"},
        Wrong{flag_body + "[[pin]]\nwhere = {}\n", "`where` is empty"},
        Wrong{flag_body + "[[pin]]\nbody = 'falg'\nwhere = { nearest = [0, 0, 0] }\n",
              "scene.toml:8:8: there is no body `falg`; did you mean `flag`?"},
        Wrong{flag_body + "[[pin]]\nfrom = 2\nuntil = 1\nwhere = { nearest = [0, 0, 0] }\n", "is not after"},
        Wrong{flag_body + "[[pin]]\nuntil = inf\nwhere = { nearest = [0, 0, 0] }\n", "is inf"},
        Wrong{flag_body + "[[pin]]\nwhere = { box = [[1, 0, 0], [0, 1, 1]] }\n", "not below the second"},
        Wrong{flag_body + "[[pin]]\nwhere = { box = [[1, 0, 0]] }\n", "give its two corners"},
        Wrong{flag_body + "[[pin]]\nwhere = { sphere = { center = [0, 0, 0] } }\n", "has no `radius`"},
        Wrong{flag_body + "[[pin]]\nwhere = { plane = { point = [0, 0, 0], normal = [0, 0, 0] } }\n",
              "has no direction"},
        Wrong{flag_body + "[[pin]]\nwhere = { nearest = [] }\n", "has no point"},
        Wrong{flag_body +
                  "[[pin]]\nwhere = { nearest = [0, 0, 0] }\nkeyframes = [{ time = 1 }, { time = 1 }]\n",
              "does not come after"},
        Wrong{flag_body + "[[pin]]\nwhere = { nearest = [0, 0, 0] }\nkeyframes = []\n",
              "`keyframes` is empty"},
        Wrong{flag_body + "[[force]]\nforce = [0, 0, 0]\n", "has no `type`"},
        Wrong{flag_body + "[[force]]\ntype = 'gravty'\n", "did you mean `gravity`?"},
        Wrong{flag_body + "[[force]]\ntype = 'gravity'\ndrag = 1\n",
              "unknown key `drag` in [[force]] 0 of type gravity"},
        Wrong{flag_body + "[[force]]\ntype = 'point'\nwhere = { nearest = [0, 0, 0] }\n", "has no `force`"},
        Wrong{flag_body + "[[force]]\ntype = 'wind'\nvelocity = [1, 0, 0]\nkeyframes = [{ time = 0, value = "
                          "[0, 0, 0] }]\n",
              "is given twice"},
        Wrong{flag_body + "[[probe]]\nname = 'a'\nat = [0, 0]\n", "give a list of three numbers"},
        Wrong{flag_body + "[[probe]]\nname = 'a'\nat = [0, 0, 0]\n[[probe]]\nname = 'a'\nat = [0, 0, 0]\n",
              "two of [[probe]] called `a`"}));

TEST(Scene, YoungsModulusReplacesTheThreeModuli) {
  const std::string body = "[[body]]\nmesh = 'a.obj'\nvoxel_width = 1\nbracing = 'full'\n[body.material]\n";
  // Full bracing with the standard shear modulus is isotropic: k1 = k2 + 8 k3 / 3 and E = 2.5 (k2 + 4 k3 /
  // 3).
  const Material m = parse(body + "density = 1\nyoungs_modulus = 1000\n").bodies[0].material;
  EXPECT_NEAR(m.edge_modulus, m.face_diagonal_modulus + 8 * m.body_diagonal_modulus / 3, 1e-9);
  EXPECT_NEAR(2.5 * (m.face_diagonal_modulus + 4 * m.body_diagonal_modulus / 3), 1000, 1e-9);
  EXPECT_THAT(message(body + "density = 1\nyoungs_modulus = 1000\nshear_modulus = 1e6\n"),
              HasSubstr("`shear_modulus`"));
  EXPECT_THAT(message(body + "density = 1\nyoungs_modulus = 1000\nedge_modulus = 1\n"),
              HasSubstr("keep one"));
  EXPECT_THAT(message(body + "density = 1\nedge_modulus = 1\nshear_modulus = 1\n"), HasSubstr("give both"));
}

TEST(Scene, SeveralBodiesMustBeNamed) {
  const std::string two = flag_body + "[[body]]\nmesh = 'b.obj'\nvoxel_width = 1\nmaterial = 'thesis_flag'\n";
  EXPECT_EQ(parse(two).bodies[1].name, "b");
  EXPECT_THAT(message(two + "[[pin]]\nwhere = { nearest = [0, 0, 0] }\n"), HasSubstr("one of `flag`, `b`"));
  EXPECT_EQ(message(two + "[[force]]\ntype = 'gravity'\n"), "no error");
}

TEST(Scene, UnusualSettingsAreWarnings) {
  const Scene scene = parse(
      "[[body]]\nmesh = 'a.obj'\nvoxel_width = 1\nthreshold = 0.3\n"
      "material = { density = 1, edge_modulus = 1 }\n");
  ASSERT_EQ(scene.warnings.size(), 2u);
  EXPECT_THAT(scene.warnings[0], HasSubstr("`threshold` has no effect"));
  EXPECT_THAT(scene.warnings[1], HasSubstr("does not resist shear"));
}

TEST(Scene, FramesCoverTheDuration) {
  TimeSettings time;
  time.duration = 2.1, time.frame_rate = 10;
  EXPECT_EQ(time.frames(), 21);
  time.duration = 0.01, time.frame_rate = 24;
  EXPECT_EQ(time.frames(), 1);
  time.duration = 1, time.frame_rate = 29.97;
  EXPECT_EQ(time.frames(), 30);
  time.duration = 41666, time.frame_rate = 24;
  EXPECT_EQ(time.frames(), 999984);
}

TEST(Override, ReplacesByNameByIndexAndInTablesThatAreMissing) {
  const Scene scene = parse(
      flag_body + "[[force]]\ntype = 'gravity'\n[[pin]]\nname = 'a.b'\nwhere = { nearest = [0, 0, 0] }\n",
      {"time.duration=3", "body.flag.voxel_width=0.5", "body.0.thickness = 0.25", "title=bare word",
       "force.0.acceleration=[0, 0, -1]", "pin.a.b.until=1.5", "solver.integrator=bdf2",
       "body.flag.material=thesis_flag"});
  EXPECT_EQ(scene.time.duration, 3);
  const auto& own = scene.bodies[0].own.as<LatticeBodySettings>();
  EXPECT_EQ(own.lattice.width, 0.5);
  EXPECT_EQ(own.thickness, 0.25);
  EXPECT_EQ(scene.title, "bare word");
  EXPECT_EQ(scene.forces[0].value.at(0), Vec3(0, 0, -1));
  EXPECT_EQ(scene.pins[0].until, 1.5);
  EXPECT_EQ(scene.solver.integrator, Integrator::bdf2);
  EXPECT_TRUE(parse(flag_body + "[[force]]\ntype = 'gravity'\n", {"force=[]"}).forces.empty());
}

TEST(Override, ErrorsNameTheOverride) {
  EXPECT_EQ(message(flag_body, {"time.duraton=2"}),
            "--set time.duraton=2: unknown key `duraton` in `time` of the scene; did you mean `duration`?");
  EXPECT_THAT(
      message(flag_body, {"time.duration=two"}),
      HasSubstr("--set time.duration=two: `duration` of `time` of the scene is \"two\"; give a number"));
  EXPECT_THAT(message(flag_body, {"body.falg.voxel_width=1"}), HasSubstr("did you mean `flag`?"));
  EXPECT_THAT(message(flag_body, {"body.1.voxel_width=1"}), HasSubstr("no entry 1 among 1"));
  EXPECT_THAT(message(flag_body, {"body.flag.name.x=1"}), HasSubstr("below a single value"));
  EXPECT_THAT(message(flag_body, {"body.flag.translate=[1, 2"}),
              HasSubstr("--set body.flag.translate=[1, 2: "));
  EXPECT_THAT(message(flag_body, {"time.duration=1\ntitle=\"x\""}), HasSubstr("give a number"));
  EXPECT_THAT(message(flag_body, {"duration"}, ErrorKind::usage), HasSubstr("this is not KEY=VALUE"));
  EXPECT_THAT(message(flag_body, {"=2"}, ErrorKind::usage), HasSubstr("this is not KEY=VALUE"));
  EXPECT_THAT(message(flag_body, {"time..duration=2"}, ErrorKind::usage), HasSubstr("this is not KEY=VALUE"));
}

TEST(Scene, MaterialFileIsRelativeToTheScene) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("muslin_scene_material_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "mine.toml") << "[lattice]\ndensity = 5\nedge_modulus = 6\n";
  std::ofstream(folder / "s.toml") << "[[body]]\nmesh = 'a.obj'\nvoxel_width = 1\nmaterial = 'mine.toml'\n";
  const Scene scene = read_scene(folder / "s.toml");
  EXPECT_EQ(scene.bodies[0].material.density, 5);
  EXPECT_EQ(scene.bodies[0].material.name, "mine");
  std::ofstream(folder / "mine.toml") << "[lattice]\ndensty = 5\n";
  try {
    read_scene(folder / "s.toml");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("mine.toml:2:1: unknown key `densty`"));
  }
  std::filesystem::remove_all(folder);
}

TEST(Scene, AMissingMaterialFileIsAFileErrorAtItsPlaceInTheScene) {
  EXPECT_THAT(
      message("[[body]]\nmesh = 'a.obj'\nvoxel_width = 1\nmaterial = 'mine.toml'\n", {}, ErrorKind::file),
      HasSubstr("scene.toml:4:12: folder/mine.toml: cannot read: No such file"));
}

TEST(Scene, AMissingSceneIsAFileError) {
  try {
    read_scene("/nowhere/scene.toml");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::file);
  }
}

}  // namespace
}  // namespace muslin
