// A run of a sheet that falls on a ball above a floor, and ways to spoil it.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "cache/scratch.hpp"
#include <fmt/format.h>

#include "muslin/cache/point_cache.hpp"
#include "muslin/cache/run.hpp"

namespace muslin::test {

/// An OBJ file of n by n squares of 0.1 m, at height y, centred over the origin.
inline void write_sheet(const std::filesystem::path& file, int n, double y) {
  std::string text;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      text += fmt::format("v {} {} {}\n", 0.1 * i - 0.05 * n, y, 0.1 * j - 0.05 * n);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i + 1;
      text += fmt::format("f {} {} {} {}\n", a, a + n + 1, a + n + 2, a + 1);
    }
  write_bytes(file, text);
}

inline const std::string sheet_body =
    "[[body]]\nname = \"sheet\"\nmesh = \"sheet.obj\"\nmodel = \"shell\"\nmaterial = \"cotton\"\n";
inline const std::string ball_and_floor =
    "[[collider]]\nname = \"ball\"\nshape = \"sphere\"\ncenter = [0, 0.1, 0]\nradius = 0.1\n"
    "[[collider]]\nname = \"floor\"\nshape = \"plane\"\n";
inline const std::string gravity = "[[force]]\ntype = \"gravity\"\nacceleration = [0, -9.8, 0]\n";

/// Runs a scene of frames 0 to 3; the sheet of 6 by 6 squares starts 1 cm above the ball.
inline std::filesystem::path run_sheet(const Scratch& scratch,
                                       const std::string& rest = ball_and_floor + gravity,
                                       const std::string& body = sheet_body,
                                       const std::vector<std::string>& overrides = {}) {
  write_sheet(scratch / "sheet.obj", 6, 0.21);
  write_bytes(scratch / "scene.toml",
              "title = \"A sheet on a <ball>\"\n[time]\nduration = 0.125\n" + body + rest);
  RunOptions options;
  options.directory = scratch / "run";
  options.overrides = overrides;
  run_scene(scratch / "scene.toml", options);
  return options.directory;
}

/// Moves vertices of a cached body at one frame.
inline void move_points(const std::filesystem::path& cache, int frame,
                        const std::function<void(std::vector<Vec3f>&)>& change) {
  const Pc2Reader reader(cache);
  std::vector<std::vector<Vec3f>> samples;
  for (int sample = 0; sample < reader.samples(); ++sample) samples.push_back(reader.read(sample));
  change(samples.at(static_cast<std::size_t>(frame)));
  Pc2Writer writer(cache, reader.points(), OutputFile::Mode::replace);
  for (const std::vector<Vec3f>& points : samples) writer.append(points);
  writer.close();
}

/// Replaces the first occurrence of a text in a file.
inline void replace_in(const std::filesystem::path& file, const std::string& from, const std::string& to) {
  std::string text = bytes_of(file);
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from;
  write_bytes(file, text.replace(at, from.size(), to));
}

}  // namespace muslin::test
