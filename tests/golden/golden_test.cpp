// Recorded positions of small scenes: unintended changes of results show here. They are compared to 1e-9 m,
// and to 1e-7 m where bodies touch, not bit by bit, so that compilers and libraries may round in their own
// ways.
//
// After an intended change: MUSLIN_UPDATE_GOLDEN=1 build/release/tests/test_golden, and say in the commit
// why.
#include <array>
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "support/scene_run.hpp"
#include "support/sheet.hpp"
#include <gtest/gtest.h>

namespace muslin::test {
namespace {

/// Wind, damping, a pin that lets go, volume conservation and both kinds of diagonals on a few voxels. The
/// tolerance is tight and the time short, so that rounding does not grow to what is compared.
constexpr const char* flag = R"(
[time]
duration = 0.5
frame_rate = 24
steps_per_frame = 4
[solver]
tolerance = 1e-9
linear_tolerance = 1e-12
[[body]]
name = "flag"
mesh = "flag.obj"
thickness = 1.0
voxel_width = 2.0
bracing = "full"
boundary_springs = "shared"
material = { density = 10, edge_modulus = 1000, face_diagonal_modulus = 100, body_diagonal_modulus = 100, volume_modulus = 100, mass_damping = 0.1, stiffness_damping = 1e-3 }
[[pin]]
where = { line = { from = [0, 6, -1], to = [0, 6, 1] } }
[[pin]]
where = { line = { from = [10, 6, -1], to = [10, 6, 1] } }
until = 0.2
[[force]]
type = "gravity"
[[force]]
type = "wind"
velocity = [1, 0, 3]
lift = 0.5
gust = 1
)";

/// A stretch limit, both kinds of damping, wind and pins on a shell with a rest shape of its own.
constexpr const char* shell = R"(
[time]
duration = 0.5
frame_rate = 24
steps_per_frame = 4
[solver]
tolerance = 1e-9
[[body]]
name = "sheet"
mesh = "sheet"
rest_mesh = "smaller"
model = "shell"
compression = "elastic"
material = { base = "cotton", mass_damping = 0.2, stiffness_damping = 1e-3 }
stretch_limit = 1.05
[[pin]]
where = { nearest = [0, 0, 0] }
[[pin]]
where = { nearest = [0.3, 0, 0] }
[[force]]
type = "gravity"
[[force]]
type = "wind"
velocity = [1, 0, 3]
)";

/// A solid with Kuhn's diagonals and volume conservation beside a shell, hanging by one side each.
constexpr const char* mixed = R"(
[time]
duration = 0.5
frame_rate = 24
steps_per_frame = 4
[solver]
tolerance = 1e-9
[[body]]
name = "block"
mesh = "flag.obj"
scale = 0.05
thickness = 0.05
voxel_width = 0.1
material = { density = 200, edge_modulus = 2e4, face_diagonal_modulus = 1e4, body_diagonal_modulus = 1e4, volume_modulus = 1e4 }
contact = false
[[body]]
name = "sheet"
mesh = "sheet"
model = "shell"
compression = "elastic"
material = "wool"
contact = false
translate = [1, 0, 0]
[[pin]]
body = "block"
where = { nearest = [0, 0.3, 0] }
[[pin]]
body = "sheet"
where = { plane = { point = [1, 0, 0], normal = [1, 0, 0], distance = 0.01 } }
[[force]]
type = "gravity"
)";

/// Two sheets fall on a ball and on each other, with friction.
constexpr const char* contact = R"(
[time]
duration = 0.2
frame_rate = 60
steps_per_frame = 4
[solver]
tolerance = 1e-9
effort = "exact"
[contact]
distance = 0.003
friction = 0.3
[[body]]
name = "lower"
mesh = "sheet"
model = "shell"
compression = "elastic"
material = "wool"
stretch_limit = 10
translate = [-0.14, 0.105, -0.13]
[[body]]
name = "upper"
mesh = "sheet"
model = "shell"
compression = "elastic"
material = "cotton"
stretch_limit = 10
translate = [-0.16, 0.11, -0.16]
rotate = [0, 10, 0]
[[collider]]
name = "ball"
shape = "sphere"
center = [0, 0, 0]
radius = 0.1
[[force]]
type = "gravity"
)";

/// A box and a capsule that move freely, on a plane that begins to turn; a point force on the box.
constexpr const char* rigid = R"(
[time]
duration = 0.3
frame_rate = 60
steps_per_frame = 4
[solver]
tolerance = 1e-9
effort = "exact"
[contact]
distance = 0.002
friction = 0.4
[[collider]]
name = "ground"
shape = "plane"
keyframes = [{ time = 0 }, { time = 0.3, rotate = [0, 0, 10] }]
[[collider]]
name = "box"
shape = "box"
center = [0, 0.053, 0]
size = [0.2, 0.1, 0.15]
density = 500
[[collider]]
name = "capsule"
shape = "capsule"
points = [[-0.05, 0.16, 0], [0.05, 0.17, 0.01]]
radius = 0.03
density = 300
[[force]]
type = "gravity"
[[force]]
type = "point"
body = "box"
force = [2, 0, 1]
)";

/// A sheet on a mesh that moves by keyframes, its pins moved by keyframes as well.
constexpr const char* kinematic = R"(
[time]
duration = 0.2
frame_rate = 60
steps_per_frame = 4
[solver]
tolerance = 1e-9
effort = "exact"
[contact]
distance = 0.003
[[body]]
name = "sheet"
mesh = "sheet"
model = "shell"
compression = "elastic"
material = "denim"
[[collider]]
name = "wedge"
shape = "mesh"
mesh = "wedge"
translate = [0.15, -0.06, 0.15]
keyframes = [{ time = 0 }, { time = 0.2, translate = [0, 0.08, 0], rotate = [0, 20, 0] }]
[[pin]]
where = { line = { from = [0, 0, 0], to = [0.3, 0, 0] } }
keyframes = [{ time = 0 }, { time = 0.2, translate = [0, 0, 0.02] }]
[[force]]
type = "gravity"
)";

struct Recording {
  std::string name;
  const char* scene;
  std::vector<std::string> settings;
  int frames;
  double tolerance;  ///< [m]
};

const Recording recordings[] = {
    {"implicit_euler", flag, {"solver.integrator=implicit_euler"}, 8, 1e-9},
    {"bdf2", flag, {"solver.integrator=bdf2"}, 8, 1e-9},
    {"linearly_implicit_euler", flag, {"solver.integrator=linearly_implicit_euler"}, 8, 1e-9},
    {"symplectic_euler", flag, {"solver.integrator=symplectic_euler"}, 8, 1e-9},
    {"shell", shell, {}, 6, 1e-9},
    {"buckling", shell, {"body.sheet.compression=buckling"}, 6, 1e-9},
    {"mixed", mixed, {}, 6, 1e-9},
    {"contact", contact, {}, 6, 1e-7},
    {"contact_bdf2", contact, {"solver.integrator=bdf2"}, 6, 1e-7},
    {"rigid", rigid, {}, 12, 1e-7},
    {"kinematic", kinematic, {}, 9, 1e-7},
};

Scene scene_of(const Recording& recording) {
  Scene scene = parse_scene(recording.scene, std::string(MUSLIN_SOURCE_DIR) + "/scenes/meshes/golden.toml",
                            recording.settings);
  const auto add = [&](const std::string& name, Mesh mesh) {
    scene.meshes[name] = std::make_shared<const Mesh>(std::move(mesh));
  };
  add("sheet", flat_sheet(8, 8, 0.3, 0.3, 0.1));
  add("smaller", flat_sheet(8, 8, 0.29, 0.3, 0.1));
  Mesh wedge;
  wedge.positions = {{-0.1, 0, -0.1}, {0.1, 0, -0.1}, {0, 0.05, -0.1},
                     {-0.1, 0, 0.1},  {0.1, 0, 0.1},  {0, 0.05, 0.1}};
  wedge.add_face(std::array{0, 2, 1});
  wedge.add_face(std::array{3, 4, 5});
  wedge.add_face(std::array{0, 1, 4, 3});
  wedge.add_face(std::array{1, 2, 5, 4});
  wedge.add_face(std::array{2, 0, 3, 5});
  add("wedge", std::move(wedge));
  return scene;
}

class Golden : public testing::TestWithParam<Recording> {};

TEST_P(Golden, PositionsAreAsRecorded) {
  const Recording& recording = GetParam();
  const std::string file = std::string(MUSLIN_SOURCE_DIR) + "/tests/golden/" + recording.name + ".txt";
  Simulation simulation(std::make_shared<const Model>(build_model(scene_of(recording))));
  for (int frame = 0; frame < recording.frames; ++frame) simulation.advance();
  const std::vector<Vec3>& x = simulation.state().positions;
  if (std::getenv("MUSLIN_UPDATE_GOLDEN") != nullptr) {
    std::ofstream out(file);
    out << std::setprecision(12) << std::fixed;
    for (const Vec3& p : x) out << p.x() << " " << p.y() << " " << p.z() << "\n";
    FAIL() << "recorded " << file << "; run again without MUSLIN_UPDATE_GOLDEN";
  }
  std::ifstream in(file);
  ASSERT_TRUE(in) << file;
  double farthest = 0;
  for (const Vec3& p : x) {
    Vec3 recorded;
    ASSERT_TRUE(p.allFinite());
    ASSERT_TRUE(in >> recorded.x() >> recorded.y() >> recorded.z()) << file << " is too short";
    farthest = std::max(farthest, (p - recorded).norm());
  }
  double more;
  EXPECT_FALSE(in >> more) << file << " is too long";
  EXPECT_LT(farthest, recording.tolerance) << "if this is meant, record anew: see the top of this file";
}

INSTANTIATE_TEST_SUITE_P(Scenes, Golden, testing::ValuesIn(recordings),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace muslin::test
