// Damaged scene files give a scene or an Error, never anything else: a small, repeatable fuzzer.
#include <cmath>
#include <fstream>
#include <random>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "muslin/scene/model.hpp"
#include "muslin/scene/scene.hpp"
#include "muslin/scene/validate.hpp"

namespace muslin {
namespace {

std::string seed_scene() {
  return R"(
title = "all"
[time]
duration = 1.5
frame_rate = 30
[solver]
integrator = "bdf2"
tolerance = 1e-4
[[body]]
name = "flag"
mesh = "meshes/a.obj"
voxel_width = 0.25
voxels = "threshold"
threshold = 0.7
rotate = [90, 0, 45]
scale = 2
[body.material]
density = 3
youngs_modulus = 100
shear_modulus = 20
[[pin]]
where = { group = "g", box = [[0, 0, 0], [1, 1, 1]], plane = { point = [0, 1, 0], normal = [0, 2, 0] }, nearest = [[1, 2, 3]] }
keyframes = [{ time = 0 }, { time = 1, translate = [1, 0, 0], rotate = [0, 90, 0] }]
[[force]]
type = "wind"
velocity = [5, 0, 0]
[[force]]
type = "point"
where = { sphere = { center = [0, 0, 0], radius = 1 } }
force = [1, 2, 3]
until = 3
[[probe]]
at = [1, 2, 3]
[[collider]]
shape = "capsule"
points = [[0, 0, 0], [1, 0, 0]]
radius = 0.1
pivot = [0, 0, 0]
keyframes = [{ time = 0 }, { time = 1, rotate = [0, 90, 0] }]
[contact]
friction = 0.4
)";
}

/// Nothing but colliders, which need no files.
std::string seed_colliders() {
  return R"(
[[collider]]
name = "ball"
shape = "sphere"
center = [0, 1, 0]
radius = 0.25
density = 700
velocity = [1, 0, 0]
angular_velocity = [0, 90, 0]
[[collider]]
shape = "plane"
normal = [0, 1, 0.5]
[[collider]]
shape = "box"
center = [3, 0, 0]
size = [1, 2, 1]
rotate = [0, 30, 0]
pivot = [0, 0, 0]
keyframes = [{ time = 0, translate = [0, 1, 0] }, { time = 1, rotate = [0, 90, 0] }]
[[collider]]
shape = "capsule"
points = [[0, 0, 3], [1, 0, 3]]
radius = 0.1
density = 100
[[pin]]
body = "ball"
until = 0.5
[[force]]
type = "point"
body = "ball"
force = [1, 0, 0]
where = { nearest = [0, 2, 0] }
[contact]
distance = 0.01
)";
}

/// One random change: a byte, a piece cut out, a piece copied elsewhere, a token put in.
void mutate(std::string& text, std::mt19937& random) {
  static const char* const tokens[] = {
      "nan",      "inf", "-1", "1e308", "[",          "]",   "{",       "}", "\"",   "=",
      "[[body]]", "\n",  ".",  "true",  "1979-05-27", "'''", "\\u0000", "#", "\xff", "0x7fffffffffffffff"};
  const auto at = [&] { return static_cast<std::size_t>(random() % (text.size() + 1)); };
  const std::size_t i = at(), length = random() % 20;
  switch (random() % 4) {
    case 0:
      if (i < text.size()) text[i] = static_cast<char>(random() % 256);
      break;
    case 1:
      text.erase(i, length);
      break;
    case 2:
      text.insert(at(), text.substr(i, length));
      break;
    default:
      text.insert(i, tokens[random() % std::size(tokens)]);
      break;
  }
}

TEST(Mutation, ADamagedSceneIsASceneOrAnError) {
  std::mt19937 random(7);
  int scenes = 0, errors = 0;
  for (int round = 0; round < 4000; ++round) {
    std::string text = seed_scene();
    for (unsigned changes = 1 + random() % 4; changes > 0; --changes) mutate(text, random);
    try {
      const Scene scene = parse_scene(text, "scene.toml");
      EXPECT_FALSE(scene.bodies.empty() && scene.colliders.empty());
      EXPECT_FALSE(scene.resolved.empty());
      EXPECT_NO_THROW(validate(scene)) << "the reader accepts " << text;
      ++scenes;
    } catch (const Error& error) {
      EXPECT_FALSE(error.problem().empty());
      EXPECT_FALSE(error.remedy().empty()) << error.what();
      ++errors;
    }
  }
  EXPECT_GT(scenes, 40);
  EXPECT_GT(errors, 1000);
}

TEST(Mutation, DamagedCollidersAreAModelOrAnError) {
  std::mt19937 random(13);
  int models = 0;
  for (int round = 0; round < 3000; ++round) {
    std::string text = seed_colliders();
    for (unsigned changes = 1 + random() % 4; changes > 0; --changes) mutate(text, random);
    try {
      const Model model = build_model(parse_scene(text, "scene.toml"));
      for (std::size_t v = 0; v < model.vertex_count(); ++v) {
        EXPECT_TRUE(model.rest_positions[v].allFinite()) << text;
        EXPECT_TRUE(std::isfinite(model.masses[v]) && model.masses[v] >= 0) << text;
      }
      ++models;
    } catch (const Error& error) {
      EXPECT_FALSE(error.remedy().empty()) << error.what();
    }
  }
  EXPECT_GT(models, 30);
}

TEST(Mutation, ADamagedSettingOfTheCommandLineIsASceneOrAnError) {
  std::mt19937 random(11);
  const std::string scene = seed_scene();
  for (int round = 0; round < 2000; ++round) {
    std::string setting = round % 2 ? "body.flag.voxel_width=0.5" : "force.0.velocity=[0, -9.8, 0]";
    for (unsigned changes = 1 + random() % 3; changes > 0; --changes) mutate(setting, random);
    try {
      parse_scene(scene, "scene.toml", {setting});
    } catch (const Error& error) {
      EXPECT_FALSE(error.problem().empty());
    }
  }
}

}  // namespace
}  // namespace muslin
