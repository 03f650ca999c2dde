// Recorded readings of scene and material files: each key in turn left out, misspelt or of a wrong value, and
// the error, the warnings or the resolved scene that follow.
//
// After an intended change: MUSLIN_UPDATE_GOLDEN=1 build/release/tests/test_golden, and say in the commit
// why.
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "muslin/scene/scene.hpp"

namespace muslin::test {
namespace {

struct Text {
  const char* name;
  const char* text;
};

/// One key a line.
constexpr Text scenes[] = {{"lattice", R"(title = "all"
[time]
duration = 1.5
frame_rate = 30
steps_per_frame = 4
[solver]
integrator = "bdf2"
effort = "exact"
tolerance = 1e-5
linear_tolerance = 1e-9
[contact]
distance = 0.002
friction = 0.4
[[body]]
name = "flag"
mesh = "a.obj"
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
contact = true
self_contact = false
friction = 0.5
colour = [0.1, 0.2, 0.3]
[body.material]
density = 3
edge_modulus = 100
face_diagonal_modulus = 10
body_diagonal_modulus = 5
volume_modulus = 7
mass_damping = 0.1
stiffness_damping = 0.02
)"},
                           {"shell", R"([[body]]
name = "sheet"
mesh = "b.obj"
model = "shell"
thickness = 0.001
rest_mesh = "c.obj"
warp = [0, 2, 0]
stretch_limit = 1.05
scale = [1, 2, 3]
[body.material]
areal_density = 0.2
membrane_warp = 1000
membrane_weft = 800
membrane_shear = 100
poisson = 0.2
bending_warp = 2e-5
bending_weft = 1e-5
bending_bias = 1.2e-5
mass_damping = 0.1
stiffness_damping = 0.001
bending_damping = 0.002
)"},
                           {"moduli", R"([[body]]
mesh = "a.obj"
voxel_width = 0.1
bracing = "full"
[body.material]
base = "rubber"
youngs_modulus = 1e5
shear_modulus = 3e4
)"},
                           {"base", R"([[body]]
mesh = "a.obj"
model = "shell"
[body.material]
base = "cotton"
bending_warp = 1e-4
bending_weft = 1e-4
bending_bias = 1e-4
)"},
                           {"named", R"([[body]]
mesh = "a.obj"
model = "shell"
material = "cotton"
[solver]
integrator = "symplectic_euler"
effort = "draft"
)"},
                           {"pins", R"([[body]]
name = "flag"
mesh = "a.obj"
voxel_width = 1
material = "thesis_flag"
[[body]]
name = "other"
mesh = "b.obj"
voxel_width = 1
material = "cotton"
[[collider]]
name = "ball"
shape = "sphere"
radius = 0.1
density = 100
[[pin]]
name = "top"
body = "flag"
from = 0.5
until = 1
pivot = [0, 1, 0]
[pin.where]
group = "g"
box = [[0, 0, 0], [1, 1, 1]]
nearest = [[1, 2, 3], [4, 5, 6]]
[pin.where.sphere]
center = [1, 0, 0]
radius = 2
[pin.where.plane]
point = [0, 1, 0]
normal = [0, 2, 0]
distance = 0.1
[pin.where.line]
from = [0, 0, 0]
to = [1, 0, 0]
distance = 0.1
[[pin.keyframes]]
time = 0
[[pin.keyframes]]
time = 1
translate = [1, 0, 0]
rotate = [0, 90, 0]
[[pin]]
body = "ball"
until = 2
[[pin]]
body = "other"
where = { nearest = [1, 2, 3] }
sequence = "walk.pc2"
[[probe]]
name = "tip"
body = "flag"
at = [1, 2, 3]
[[probe]]
body = "ball"
at = [0, 0, 0]
)"},
                           {"forces", R"([[body]]
name = "flag"
mesh = "a.obj"
voxel_width = 1
material = "thesis_flag"
[[collider]]
name = "ball"
shape = "sphere"
radius = 0.1
density = 100
[[force]]
type = "gravity"
acceleration = [0, -1.6, 0]
[[force]]
type = "gravity"
body = "flag"
[[force]]
type = "point"
name = "push"
body = "flag"
where = { nearest = [1, 2, 3] }
force = [0, 1, 0]
[[force]]
type = "point"
body = "flag"
from = 0.1
until = 0.5
[force.where]
group = "g"
[[force.keyframes]]
time = 0
value = [0, 0, 0]
[[force.keyframes]]
time = 1
value = [2, 0, 0]
[[force]]
type = "point"
body = "ball"
force = [1, 0, 0]
[[force]]
type = "wind"
name = "breeze"
body = "flag"
velocity = [5, 0, 0]
from = 0.1
until = 0.5
air_density = 1.1
drag = 2
lift = 0.3
gust = 2.5
gust_length = 0.8
seed = 3
)"},
                           {"colliders", R"([[collider]]
name = "floor"
shape = "plane"
center = [0, -1, 0]
normal = [0, 2, 0]
contact = true
friction = 0.1
colour = [0.9, 0.9, 0.2]
[[collider]]
shape = "sphere"
center = [0, 1, 0]
radius = 0.1
density = 900
velocity = [0.5, 0, 0]
angular_velocity = [0, 0, -90]
[[collider]]
shape = "capsule"
points = [[-1, 0, 0], [1, 0, 0]]
radius = 0.02
[[collider]]
shape = "box"
center = [0, -0.5, 0]
size = [1, 0.1, 1]
rotate = [0, 45, 0]
pivot = [0, 0, 0]
[[collider.keyframes]]
time = 0
[[collider.keyframes]]
time = 1
translate = [0, 0.5, 0]
rotate = [0, 90, 0]
[[collider]]
shape = "mesh"
mesh = "stairs.obj"
translate = [0, -1, 0]
rotate = [0, 90, 0]
scale = 0.01
[[collider]]
shape = "mesh"
mesh = "walker.obj"
sequence = "walker.####.obj"
frame_rate = 25
start = 0.5
)"},
                           {"times", R"([[collider]]
shape = "mesh"
mesh = "walker.obj"
sequence = "walker.mdd"
start = 0.5
[[collider]]
shape = "box"
size = [1, 1, 1]
density = 10
)"}};

constexpr Text materials[] = {{"material", R"(name = "mine"
description = "a plain weave"
source = "measured"
[lattice]
density = 470
edge_modulus = 8e5
face_diagonal_modulus = 1e4
body_diagonal_modulus = 1e4
volume_modulus = 0
mass_damping = 0.1
stiffness_damping = 0.002
[shell]
areal_density = 0.15
membrane_warp = 260
bending_warp = 1.2e-5
[reference]
thread_count = 40
)"}};

constexpr const char* values[] = {"true", "-1", "1e300", "'x'", "[nan, 0, 0]"};

/// Keys beside which the others of a table are out of place, to stand anywhere.
constexpr const char* intruders[] = {
    "zzzzzzzzzzzz = 1",
    "keyframes = []",
    "keyframes = 3",
    "keyframes = [{ time = 1, value = [0, 0, 0] }, { time = 1, value = [0, 0, 0] }]",
    "keyframes = [{ time = 0 }]",
    "keyframes = [{ tiem = 0 }]",
    "keyframes = [3]",
    "sequence = 'a.pc2'",
    "density = 1",
    "frame_rate = 25",
    "start = 1",
    "pivot = [0, 0, 0]",
    "velocity = [1, 0, 0]",
    "shear_modulus = 1",
    "youngs_modulus = 1",
    "base = 'coton'",
    "warp = [1, 0, 0]",
    "bracing = 'full'",
    "drag = 1",
    "mode = 'fast'",
    "radius = 1",
    "where = 3",
    "where = {}",
    "where = { box = [[0, 0, 0]] }",
    "where = { box = [[1, 0, 0], [0, 1, 1]] }",
    "where = { nearest = [] }",
    "where = { nearest = [[0, 0]] }",
    "where = { line = { from = [0, 0, 0], to = [0, 0, 0] } }",
    "where = { plane = { point = [0, 0, 0], normal = [0, 0, 0] } }"};

std::string digest(const std::string& text) {
  std::uint64_t hash = 14695981039346656037u;  // FNV-1a
  for (const unsigned char c : text) hash = (hash ^ c) * 1099511628211u;
  return fmt::format("{:016x}", hash);
}

std::string shown(const Scene& scene) {
  std::string text = "reads as " + digest(scene.resolved);
  for (const std::string& warning : scene.warnings) text += "; warning: " + warning;
  return text;
}

std::string scene_reading(const std::string& text) { return shown(parse_scene(text, "scene.toml")); }

std::string material_reading(const std::string& text) {
  const Material m = parse_material(text, "material.toml");
  std::string numbers = m.name + m.description + m.source;
  numbers += fmt::format("{} {} {} {} {} {} {} {}", m.has_lattice, m.density, m.edge_modulus,
                         m.face_diagonal_modulus, m.body_diagonal_modulus, m.volume_modulus, m.mass_damping,
                         m.stiffness_damping);
  if (m.shell) numbers += fmt::format("{} {}", m.shell->areal_density, m.shell->bending_bias);
  return "reads as " + digest(numbers);
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// Returns a line of text for each change of each line of the file.
template <class Reading>
std::string readings(const Text& file, const Reading& reading) {
  std::string record;
  const std::vector<std::string> original = lines_of(file.text);
  const auto note = [&](const std::string& change, const std::vector<std::string>& lines) {
    std::string result;
    try {
      result = reading(joined(lines));
    } catch (const Error& error) {
      result = error.what();
    }
    // Most intruders are unknown in most tables, or there already.
    const bool is_news = change.find('+') == std::string::npos || change.ends_with("zzzz = 1") ||
                         (result.find("unknown key") == std::string::npos &&
                          result.find("cannot redefine") == std::string::npos);
    if (is_news) record += fmt::format("{} {}: {}\n", file.name, change, result);
  };
  note("as it is", original);
  for (std::size_t i = 0; i < original.size(); ++i) {
    const std::string& line = original[i];
    const auto changed = [&](const std::string& to) {
      std::vector<std::string> lines = original;
      lines[i] = to;
      return lines;
    };
    if (line.starts_with('[')) {
      for (const char* intruder : intruders)
        note(fmt::format("{} {} + {}", i + 1, line, intruder), changed(line + "\n" + intruder));
      continue;
    }
    const std::string key = line.substr(0, line.find(" ="));
    note(fmt::format("{} without {}", i + 1, key), changed(""));
    note(fmt::format("{} misspelt {}", i + 1, key), changed("q" + line));
    for (const char* value : values)
      note(fmt::format("{} {} = {}", i + 1, key, value), changed(key + " = " + value));
  }
  return record;
}

void expect_golden(const std::string& name, const std::string& text) {
  const std::string path = std::string(MUSLIN_SOURCE_DIR) + "/tests/golden/" + name;
  if (std::getenv("MUSLIN_UPDATE_GOLDEN") != nullptr) {
    std::ofstream(path) << text;
    return;
  }
  std::ifstream in(path);
  ASSERT_TRUE(in) << path;
  const std::vector<std::string> now = lines_of(text);
  std::size_t i = 0;
  for (std::string line; std::getline(in, line); ++i) {
    ASSERT_LT(i, now.size());
    ASSERT_EQ(now[i], line) << name << " line " << i + 1 << ", after: " << (i > 0 ? now[i - 1] : "");
  }
  EXPECT_EQ(i, now.size());
}

TEST(SceneReading, MessagesAreAsRecorded) {
  std::string record;
  for (const Text& scene : scenes) record += readings(scene, scene_reading);
  for (const Text& material : materials) record += readings(material, material_reading);
  expect_golden("scene_readings.txt", record);
}

TEST(SceneReading, EverySceneIsResolvedAsRecorded) {
  std::string record;
  for (const Text& scene : scenes)
    record += fmt::format("{}\n{}\n", scene.name, parse_scene(scene.text, "scene.toml").resolved);
  expect_golden("scenes_resolved.txt", record);
}

}  // namespace
}  // namespace muslin::test
