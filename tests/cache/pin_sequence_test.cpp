// `[[pin]] sequence`: held vertices of shells and lattices follow a point cache, and the run resumes.
#include <cmath>

#include "cache/scratch.hpp"
#include <gmock/gmock.h>

#include "muslin/cache/point_cache.hpp"
#include "muslin/cache/run.hpp"
#include "muslin/cache/run_reader.hpp"
#include "muslin/core/error.hpp"
#include "muslin/scene/model.hpp"

namespace muslin {
namespace {

using test::bytes_of;
using test::Scratch;
using test::write_bytes;

constexpr int side = 4;  // quads along an edge of 1 m

Vec3f rest(int i, int j) { return {static_cast<float>(i) / side, 0, static_cast<float>(j) / side}; }

/// A square whose row j = 0 is a group, and a cache in which it is lifted and turned; the rest does not
/// matter.
void write_square(const Scratch& scratch) {
  std::string obj;
  for (int j = 0; j <= side; ++j)
    for (int i = 0; i <= side; ++i)
      obj += "v " + std::to_string(rest(i, j).x()) + " 0 " + std::to_string(rest(i, j).z()) + "\n";
  const auto index = [](int i, int j) { return std::to_string(j * (side + 1) + i + 1); };
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i)
      obj += "f " + index(i, j) + " " + index(i, j + 1) + " " + index(i + 1, j + 1) + " " + index(i + 1, j) +
             "\n";
  obj += "g held\np";
  for (int i = 0; i <= side; ++i) obj += " " + index(i, 0);
  write_bytes(scratch / "square.obj", obj + "\n");
}

Vec3f place(int frame, int i, int j) {
  const double angle = 0.1 * frame;
  const Vec3f x = rest(i, j);
  return {static_cast<float>(std::cos(angle)) * x.x(), static_cast<float>(std::sin(angle)) * x.x(),
          x.z() + 0.02f * static_cast<float>(frame)};
}

void write_sequence(const std::filesystem::path& path, int points = (side + 1) * (side + 1)) {
  write_pc2(path, 7, static_cast<std::size_t>(points), [points](int frame) {
    std::vector<Vec3f> x;
    for (int v = 0; v < points; ++v) x.push_back(place(frame, v % (side + 1), v / (side + 1)));
    return x;
  });
}

std::string scene_text(const std::string& body) {
  return "[time]\nduration = 0.25\nframe_rate = 24\nsteps_per_frame = 4\n[[body]]\nname = \"square\"\n"
         "mesh = \"square.obj\"\n" +
         body +
         "\n[[pin]]\nwhere = { group = \"held\" }\nsequence = \"held.pc2\"\n[[force]]\ntype = \"gravity\"\n";
}

RunOptions options(const std::filesystem::path& directory) {
  RunOptions options;
  options.directory = directory;
  return options;
}

TEST(PinSequence, HeldVerticesOfAShellFollowTheSequence) {
  Scratch scratch;
  write_square(scratch);
  write_sequence(scratch / "held.pc2");
  write_bytes(scratch / "scene.toml", scene_text("model = \"shell\"\nmaterial = \"cotton\""));
  run_scene(scratch / "scene.toml", options(scratch / "run"));
  const Pc2Reader skin(scratch / "run/square.skin.pc2");
  ASSERT_EQ(skin.samples(), 7);
  for (int frame = 0; frame < 7; ++frame) {
    const std::vector<Vec3f> x = skin.read(frame);
    for (int i = 0; i <= side; ++i)
      EXPECT_LT((x[static_cast<std::size_t>(i)] - place(frame, i, 0)).norm(), 1e-6f) << frame << " " << i;
  }
  EXPECT_LT(skin.read(6).back().y(), place(6, side, side).y() - 0.01f) << "the rest is free to fall";

  RunOptions stopped = options(scratch / "stopped");
  stopped.frames = 3;
  run_scene(scratch / "scene.toml", stopped);
  stopped.frames = -1;
  stopped.resume = true;
  run_scene(scratch / "scene.toml", stopped);
  EXPECT_EQ(bytes_of(scratch / "stopped/square.skin.pc2"), bytes_of(scratch / "run/square.skin.pc2"));
}

TEST(PinSequence, LatticeVerticesFollowTheNearestVertexOfTheGroup) {
  Scratch scratch;
  write_square(scratch);
  write_sequence(scratch / "held.pc2");
  write_bytes(scratch / "scene.toml",
              scene_text("thickness = 0.125\nvoxel_width = 0.125\nmaterial = \"thesis_flag\""));
  const Model model = build_model(read_scene(scratch / "scene.toml"));
  const Pin& pin = model.pins.front();
  ASSERT_EQ(pin.points.size(), pin.vertices.size());
  for (std::size_t i = 0; i < pin.vertices.size(); ++i) {
    const Vec3 x = model.rest_positions[static_cast<std::size_t>(pin.vertices[i])];
    EXPECT_LE(pin.points[i], side) << "of the group";
    for (int other = 0; other <= side; ++other)
      EXPECT_LE((rest(pin.points[i], 0).cast<double>() - x).norm(),
                (rest(other, 0).cast<double>() - x).norm() + 1e-12);
  }
  run_scene(scratch / "scene.toml", options(scratch / "run"));
  const std::vector<Vec3f> x = Pc2Reader(scratch / "run/square.lattice.pc2").read(6);
  for (std::size_t i = 0; i < pin.vertices.size(); ++i) {
    const auto v = static_cast<std::size_t>(pin.vertices[i]);
    const Vec3f moved = place(6, pin.points[i], 0) - rest(pin.points[i], 0);
    EXPECT_LT((x[v] - model.rest_positions[v].cast<float>() - moved).norm(), 1e-6f);
  }
}

TEST(PinSequence, RefusesSequencesOfAnotherSize) {
  Scratch scratch;
  write_square(scratch);
  const std::string shell = scene_text("model = \"shell\"\nmaterial = \"cotton\"");
  const auto refusal = [&](const std::string& text) -> std::string {
    write_bytes(scratch / "scene.toml", text);
    try {
      build_model(read_scene(scratch / "scene.toml"));
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(refusal(shell),
              testing::AllOf(testing::HasSubstr("held.pc2"), testing::HasSubstr("scene.toml:12:")));
  write_sequence(scratch / "held.pc2", 24);
  EXPECT_THAT(refusal(shell), testing::HasSubstr("24 points, the mesh of body `square` has 25"));
  write_sequence(scratch / "held.pc2");
  EXPECT_EQ(refusal(shell), "");
  const std::size_t at = shell.find("sequence");
  EXPECT_THAT(refusal(std::string(shell).insert(at, "keyframes = [{ time = 0 }]\n")),
              testing::HasSubstr("`keyframes` and `sequence`"));
  EXPECT_THAT(refusal(std::string(shell).insert(at, "pivot = [0, 0, 0]\n")), testing::HasSubstr("`pivot`"));
}

}  // namespace
}  // namespace muslin
