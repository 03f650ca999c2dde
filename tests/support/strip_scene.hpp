// A strip of cloth or lattice in a scene file, held at x = 0: for tests of what varies over a body.
#pragma once

#include <cstring>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "cache/scratch.hpp"
#include "support/sheet.hpp"
#include <gtest/gtest.h>

#include "muslin/simulation/simulation.hpp"

namespace muslin::test {

/// The mesh `sheet` lies in y = 0 along x, `length` by `width` metres, of `columns` by `rows` squares.
class StripScene : public testing::Test {
 protected:
  static constexpr int columns = 20, rows = 4;
  static constexpr double length = 1, width = 0.2;

  StripScene() : sheet_(flat_sheet(columns, rows, length, width)) {}

  /// Writes a file beside the scene.
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(scratch_.path() / name) << text;
  }
  /// The body `strip` with these keys, and further tables.
  std::shared_ptr<const Model> model_of(const std::string& keys, const std::string& rest = "",
                                        const std::string& mesh = "sheet") const {
    Scene scene = parse_scene(
        "[time]\nduration = 4\nframe_rate = 25\nsteps_per_frame = 1\n[[body]]\nname = 'strip'\nmesh = '" +
            mesh + "'\ncontact = false\n" + keys +
            "\n[[pin]]\nwhere = { box = [[-0.001, -1, -1], [0.001, 1, 1]] }\n" + rest,
        scratch_.path() / "scene.toml");
    scene.meshes["sheet"] = std::make_shared<Mesh>(sheet_);
    return std::make_shared<const Model>(build_model(scene));
  }
  /// Returns the message of the error that a strip with these keys causes.
  std::string complaint_of(const std::string& keys, const std::string& mesh = "sheet") const {
    try {
      model_of(keys, "", mesh);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }
  static std::vector<Vec3> run(const std::shared_ptr<const Model>& model, int frames) {
    Simulation simulation(model);
    for (int f = 0; f < frames; ++f) simulation.advance();
    const ConstVectors x = simulation.state().positions;
    return {x.begin(), x.end()};
  }
  static void expect_same_bits(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3)), 0);
  }

  Scratch scratch_;
  Mesh sheet_;
};

}  // namespace muslin::test
