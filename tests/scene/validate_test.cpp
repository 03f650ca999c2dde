#include "muslin/scene/validate.hpp"

#include <functional>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/component/lattice/lattice_body_settings.hpp"
#include "muslin/component/shell/shell_body_settings.hpp"
#include "muslin/core/error.hpp"
#include "muslin/scene/wind_force_settings.hpp"

namespace muslin {
namespace {

/// A scene with one of everything.
Scene sound_scene() {
  return parse_scene(R"(
[[body]]
name = "block"
mesh = "a.obj"
voxel_width = 0.1
material = "rubber"
[[body]]
name = "sheet"
mesh = "b.obj"
model = "shell"
material = "cotton"
stretch_limit = 1.05
[[collider]]
name = "ball"
shape = "sphere"
radius = 0.1
density = 100
[[collider]]
name = "ground"
shape = "plane"
[[pin]]
name = "hook"
body = "sheet"
where = { nearest = [0, 0, 0] }
keyframes = [{ time = 0 }, { time = 1, translate = [1, 0, 0] }]
[[force]]
type = "gravity"
[[force]]
name = "pull"
type = "point"
body = "sheet"
where = { nearest = [0, 0, 0] }
force = [0, 1, 0]
[[force]]
name = "breeze"
type = "wind"
velocity = [1, 0, 0]
[[probe]]
name = "tip"
body = "sheet"
at = [0, 0, 0]
)",
                     "scene.toml");
}

TEST(Validate, AcceptsASceneThatTheReaderAccepts) { EXPECT_NO_THROW(validate(sound_scene())); }

TEST(Validate, AcceptsAProbeOnAStaticCollider) {
  Scene scene = sound_scene();
  scene.probes[0].body = "ground";
  EXPECT_NO_THROW(validate(scene));
}

struct Mistake {
  std::string message;
  std::function<void(Scene&)> make;
};
class EveryMistake : public testing::TestWithParam<Mistake> {};

TEST_P(EveryMistake, IsAnErrorThatNamesIt) {
  Scene scene = sound_scene();
  GetParam().make(scene);
  try {
    validate(scene);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_THAT(error.what(), testing::HasSubstr(GetParam().message));
    EXPECT_FALSE(error.remedy().empty());
  }
}

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

INSTANTIATE_TEST_SUITE_P(
    Scenes, EveryMistake,
    testing::Values(
        Mistake{"[time]: `frame_rate` is 0", [](Scene& s) { s.time.frame_rate = 0; }},
        Mistake{"[time]: `frame_rate` is inf", [](Scene& s) { s.time.frame_rate = inf; }},
        Mistake{"[time]: `duration` is nan", [](Scene& s) { s.time.duration = nan; }},
        Mistake{"[time]: `steps_per_frame` is -1", [](Scene& s) { s.time.steps_per_frame = -1; }},
        Mistake{"[solver]: `tolerance` is 0", [](Scene& s) { s.solver.tolerance = 0; }},
        Mistake{"[contact]: `distance` is -1", [](Scene& s) { s.contact.distance = -1; }},
        Mistake{"[contact]: `friction` is -1", [](Scene& s) { s.contact.friction = -1; }},
        Mistake{"[[body]] `block`: `voxel_width` is 0",
                [](Scene& s) { s.bodies[0].own.as<LatticeBodySettings>().lattice.width = 0; }},
        Mistake{"[[body]] `block`: `density` is 0", [](Scene& s) { s.bodies[0].material.density = 0; }},
        Mistake{"[[body]] `block`: `edge_modulus` is -1",
                [](Scene& s) { s.bodies[0].material.edge_modulus = -1; }},
        Mistake{"[[body]] `block`: `volume_modulus` is -1",
                [](Scene& s) { s.bodies[0].material.volume_modulus = -1; }},
        Mistake{"[[body]] `block`: `velocity` is not finite",
                [](Scene& s) { s.bodies[0].velocity.x() = nan; }},
        Mistake{"[[body]] `block`: `model` is not one of its choices",
                [](Scene& s) { s.bodies[0].model = "rigid"; }},
        Mistake{"[[body]] `block`: `law` is not one of its choices",
                [](Scene& s) { s.bodies[0].material.law = "rubber"; }},
        Mistake{"[[body]] `sheet`: another one has its name", [](Scene& s) { s.bodies[0].name = "sheet"; }},
        Mistake{"[[body]]: it has no name", [](Scene& s) { s.bodies[0].name.clear(); }},
        Mistake{"[[body]] `sheet`: its material has no numbers for shells",
                [](Scene& s) { s.bodies[1].material.shell.reset(); }},
        Mistake{"[[body]] `sheet`: `membrane_warp` is -1",
                [](Scene& s) { s.bodies[1].material.shell->membrane_warp = -1; }},
        Mistake{"[[body]] `sheet`: `poisson` is 1",
                [](Scene& s) { s.bodies[1].material.shell->poisson = 1; }},
        Mistake{"[[body]] `sheet`: `bending_warp` is nan",
                [](Scene& s) { s.bodies[1].material.shell->bending_warp = nan; }},
        Mistake{"[[body]] `sheet`: `stretch_limit` is 1",
                [](Scene& s) { s.bodies[1].own.as<ShellBodySettings>().stretch_limit = 1; }},
        Mistake{"[[body]] `sheet`: with 0 N·m at 45° between 1 and 0.01 N·m and a Poisson ratio of",
                [](Scene& s) {
                  ShellMaterial& shell = *s.bodies[1].material.shell;
                  shell.bending_warp = 1, shell.bending_weft = 0.01, shell.bending_bias = 0;
                }},
        Mistake{"[[body]] `block`: `voxels` is not one of its choices",
                [](Scene& s) {
                  s.bodies[0].own.as<LatticeBodySettings>().lattice.rule = static_cast<VoxelRule>(7);
                }},
        Mistake{"[[body]] `block`: a colour is red, green and blue from 0 to 1",
                [](Scene& s) { s.bodies[0].colour = Vec3(0, nan, 0); }},
        Mistake{"[[body]] `block`: `scale` has a component of 0",
                [](Scene& s) { s.bodies[0].scale.y() = 0; }},
        Mistake{"[[body]] `sheet`: `friction` is -1", [](Scene& s) { s.bodies[1].friction = -1; }},
        Mistake{"[[collider]] `ball`: `radius` is 0", [](Scene& s) { s.colliders[0].radius = 0; }},
        Mistake{"[[collider]] `ball`: `density` is 0", [](Scene& s) { s.colliders[0].density = 0; }},
        Mistake{"[[collider]] `ball`: `density` makes a body that moves by itself",
                [](Scene& s) { s.colliders[0].motion.keys.emplace_back(); }},
        Mistake{"[[collider]] `ground`: `normal` is not of length 1",
                [](Scene& s) { s.colliders[1].normal = Vec3(0, 2, 0); }},
        Mistake{"[[collider]] `ground`: a plane has a `density`",
                [](Scene& s) { s.colliders[1].density = 1; }},
        Mistake{"[[pin]] `hook`: there is no body `shet`", [](Scene& s) { s.pins[0].body = "shet"; }},
        Mistake{"did you mean `sheet`?", [](Scene& s) { s.pins[0].body = "shet"; }},
        Mistake{"[[pin]] `hook`: there is no body `ground`", [](Scene& s) { s.pins[0].body = "ground"; }},
        Mistake{"[[pin]] `hook`: `until` = 1 s is not after `from` = 2 s",
                [](Scene& s) { s.pins[0].from = 2, s.pins[0].until = 1; }},
        Mistake{"[[pin]] `hook`: keyframe 1 is at -1 s",
                [](Scene& s) { s.pins[0].motion.keys[1].time = -1; }},
        Mistake{"[[pin]] `hook`: `keyframes` and `sequence` both say how the pin moves",
                [](Scene& s) { s.pins[0].sequence = "walk.pc2"; }},
        Mistake{"there is no body `flag`", [](Scene& s) { s.forces[0].body = "flag"; }},
        Mistake{"[[force]] `pull`: `type` is not one of its choices",
                [](Scene& s) { s.forces[1].type = "push"; }},
        Mistake{"it has no value", [](Scene& s) { s.forces[0].value.keys.clear(); }},
        Mistake{"`value` is not finite", [](Scene& s) { s.forces[0].value.keys[0].value.y() = inf; }},
        Mistake{"[[force]] `pull`: a point force has no `where`",
                [](Scene& s) { s.forces[1].where.reset(); }},
        Mistake{"[[force]] `breeze`: wind does not blow on rigid bodies",
                [](Scene& s) { s.forces[2].body = "ball"; }},
        Mistake{"[[force]] `breeze`: `gust_length` is 0; give a number from 1e-06 to 1000000 [m]",
                [](Scene& s) { s.forces[2].own.as<WindForceSettings>().gust_length = 0; }},
        Mistake{"[[force]] `breeze`: `lift` = 2 is above `drag` = 1",
                [](Scene& s) {
                  auto& wind = s.forces[2].own.as<WindForceSettings>();
                  wind.lift = 2, wind.drag = 1;
                }},
        Mistake{"[[probe]] `tip`: there is no body `tip`", [](Scene& s) { s.probes[0].body = "tip"; }},
        Mistake{"[[probe]] `tip`: `at` is not finite", [](Scene& s) { s.probes[0].at.z() = nan; }},
        Mistake{"the mesh `a.obj` is null", [](Scene& s) { s.meshes["a.obj"] = nullptr; }}));

}  // namespace
}  // namespace muslin
