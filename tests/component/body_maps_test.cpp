// Numbers of materials vary by maps over shells and lattices.
#include "muslin/component/body_maps.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "support/strip_scene.hpp"
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/component/shell/shell_body.hpp"
#include "muslin/core/index.hpp"
#include "muslin/render/image.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

using testing::HasSubstr;

/// A sheet along x, with `ramp.csv` beside the scene: x of each vertex over the length. A group `end` has the
/// last column.
class Maps : public test::StripScene {
 protected:
  Maps() {
    std::string ramp = "weight\n";
    for (const Vec3& p : sheet_.positions) ramp += fmt::format("{}\n", p.x() / length);
    write("ramp.csv", ramp);
    MeshGroup end{"end", {}, {}};
    for (std::size_t v = 0; v < sheet_.vertex_count(); ++v)
      if (sheet_.positions[v].x() > 0.99 * length) end.vertices.push_back(static_cast<int>(v));
    sheet_.groups = {end};
  }
  std::string complaint(const std::string& numbers) const { return complaint_of(shell + numbers + " }"); }
  /// Compares runs with numbers and with maps of those values, bit by bit.
  void expect_equal_bits(const std::string& body,
                         const std::vector<std::pair<std::string, std::string>>& numbers) {
    std::string plain, mapped;
    const char* comma = "";
    for (const auto& [key, value] : numbers) {
      plain += fmt::format("{}{} = {}", comma, key, value);
      mapped += fmt::format("{}{} = {{ map = 'ramp.csv', from = {}, to = {} }}", comma, key, value, value);
      comma = ", ";
    }
    const std::string gravity = "[[force]]\ntype = 'gravity'\n";
    expect_same_bits(run(model_of(body + plain + " }", gravity), 4),
                     run(model_of(body + mapped + " }", gravity), 4));
  }

  static constexpr const char* shell =
      "model = 'shell'\nwarp = [1, 0, 0]\nmaterial = { areal_density = 0.1, membrane_warp = 100, "
      "bending_warp = "
      "1e-5, ";
};

TEST_F(Maps, OfOneValueEqualTheNumberBitForBit) {
  expect_equal_bits("model = 'shell'\nwarp = [1, 0, 0]\nmaterial = { ", {{"areal_density", "0.1"},
                                                                         {"membrane_warp", "90"},
                                                                         {"membrane_weft", "70"},
                                                                         {"bending_warp", "1e-5"},
                                                                         {"bending_weft", "2e-5"},
                                                                         {"stretch_limit", "1.1"},
                                                                         {"mass_damping", "0.3"},
                                                                         {"stiffness_damping", "0.01"},
                                                                         {"bending_damping", "0.02"}});
  const std::string lattice = "thickness = 0.05\nvoxel_width = 0.05\nmaterial = { ";
  expect_equal_bits(lattice, {{"density", "90"},
                              {"edge_modulus", "3000"},
                              {"face_diagonal_modulus", "700"},
                              {"body_diagonal_modulus", "300"},
                              {"volume_modulus", "100"},
                              {"mass_damping", "0.3"}});
  expect_equal_bits(lattice + "law = 'neo_hookean', density = 90, ",
                    {{"youngs_modulus", "3000"}, {"stiffness_damping", "0.01"}});
}

TEST_F(Maps, OfDensityGiveTheIntegralAsMass) {
  const std::string linear = "{ map = 'ramp.csv', from = 0.1, to = 0.4 }";
  const auto cloth = model_of("model = 'shell'\nmaterial = { areal_density = " + linear +
                              ", membrane_warp = 100, bending_warp = 1e-5 }");
  EXPECT_NEAR(cloth->bodies[0].statistics.mass, 0.25 * length * width, 1e-12);
  const auto block = model_of("thickness = 0.05\nvoxel_width = 0.05\nmaterial = { density = " + linear +
                              ", edge_modulus = 3000, face_diagonal_modulus = 700 }");
  EXPECT_NEAR(block->bodies[0].statistics.mass, 0.25 * length * width * 0.05, 1e-9);
}

TEST_F(Maps, OfStiffnessStretchAStripAsSpringsInSeries) {
  // Under a force per width F the strain is F/K(x): the end moves by ∫ F/K dx = F L ln(K₁/K₀)/(K₁ − K₀).
  const double force = 0.05, soft = 50, stiff = 200;
  const auto strip = model_of(
      "model = 'shell'\nwarp = [1, 0, 0]\nmaterial = { areal_density = 0.1, membrane_warp = { map = "
      "'ramp.csv', "
      "from = 50, to = 200 }, bending_warp = 1e-5, poisson = 0, mass_damping = 40 }",
      fmt::format("[[force]]\ntype = 'point'\nforce = [{}, 0, 0]\nwhere = {{ group = 'end' }}\n",
                  force * width / (rows + 1)));
  const std::vector<Vec3> x = run(strip, 100);
  const double expected = force * length * std::log(stiff / soft) / (stiff - soft);
  double mean = 0;
  for (int k = 0; k <= rows; ++k) mean += (x[at(columns + k * (columns + 1))].x() - length) / (rows + 1);
  EXPECT_NEAR(mean, expected, 0.02 * expected);
}

TEST_F(Maps, WeightTheVerticesOfAGroup) {
  const auto cloth = model_of(std::string(shell) + "stretch_limit = { map = 'end', from = 1.2, to = 1.1 } }");
  const MappedNumber& map = cloth->bodies[0].maps.front();
  EXPECT_EQ(map.at(0), 1.2);
  EXPECT_EQ(map.at(columns), 1.1);
  EXPECT_EQ(as_shell(cloth->bodies[0])->stretch_limit(0), 1.2) << "the largest";
}

TEST_F(Maps, TakeImagesByTextureCoordinates) {
  Image image(2, 1, {0, 0, 0});
  for (int c = 0; c < 3; ++c) image.pixel(1, 0)[c] = 255;
  write_png(scratch_.path() / "paint.png", image);
  const std::string painted = "mass_damping = { map = 'paint.png', from = 1, to = 3 }";
  EXPECT_THAT(complaint(painted),
              HasSubstr("is an image, but vertex 0 of body `strip`, counted from 0, has no "
                        "texture coordinates"));
  test::add_flat_uvs(sheet_);  // u is x
  const auto cloth = model_of(shell + painted + " }");
  const MappedNumber& map = cloth->bodies[0].maps.front();
  EXPECT_NEAR(map.at(0), 1, 1e-12);
  EXPECT_NEAR(map.at(columns / 2), 2, 1e-12) << "between the centres of both pixels";
  EXPECT_NEAR(map.at(columns), 3, 1e-12);
  sheet_.uvs[3].x() = 1.5;
  EXPECT_THAT(complaint(painted),
              HasSubstr("does not reach vertex 3, counted from 0, at the texture coordinates (1.5, 0)"));
  write("broken.png", "P5 2 1");
  EXPECT_THAT(complaint("mass_damping = { map = 'broken.png', from = 1, to = 3 }"),
              HasSubstr("the map `broken.png`: it is no PNG picture"));
  EXPECT_THAT(complaint("mass_damping = { map = 'none.png', from = 1, to = 3 }"), HasSubstr("cannot read"));
}

TEST_F(Maps, LetNumbersThatFollowFromOthersFollowEverywhere) {
  const auto cloth = model_of(
      "model = 'shell'\nmaterial = { areal_density = 0.1, membrane_warp = { map = 'ramp.csv', from = 10, to "
      "= 30 "
      "}, bending_warp = { map = 'ramp.csv', from = 1e-6, to = 1e-4 } }");
  const ShellBody& body = *as_shell(cloth->bodies[0]);
  for (std::size_t t = 0; t < body.shell.triangles.size(); ++t) {
    const ShellMaterial& m = body.material_at(t);
    EXPECT_EQ(m.membrane_weft, m.membrane_warp);
    EXPECT_DOUBLE_EQ(m.membrane_shear, m.membrane_warp / 2.5);
    EXPECT_DOUBLE_EQ(m.bending_bias, m.bending_warp);
  }
}

TEST_F(Maps, OfDensityChangeTheHashThatASavedStateMustFit) {
  const std::string numbers =
      "model = 'shell'\nmaterial = { membrane_warp = 100, bending_warp = 1e-5, areal_density = "
      "{ map = 'ramp.csv', from = 1, to = ";
  const auto hash = [&](const std::string& to) {
    return model_of(numbers + to + " } }")->bodies[0].material_hash(0);
  };
  EXPECT_EQ(hash("2"), hash("2"));
  EXPECT_NE(hash("2"), hash("3"));
}

TEST_F(Maps, OfStiffnessMayChangeOnAResumeWhichTheAccountShows) {
  const auto cloth = [&](const std::string& to) {
    return model_of(
        "model = 'shell'\nwarp = [1, 0, 0]\nmaterial = { areal_density = 0.1, bending_warp = 1e-5, "
        "membrane_warp = { map = 'ramp.csv', from = 10, to = " +
            to + " } }\n",
        "[[force]]\ntype = 'gravity'\n");
  };
  Simulation before(cloth("20"));
  for (int f = 0; f < 3; ++f) before.advance();
  Simulation same(cloth("20")), after(cloth("40"));
  for (Simulation* resumed : {&same, &after}) {
    resumed->restore(before.checkpoint());
    resumed->advance();
  }
  EXPECT_EQ(same.diagnostics().material_work, 0);
  const Diagnostics start = before.diagnostics(), end = after.diagnostics();
  EXPECT_GT(end.material_work, 0.01 * start.elastic);
  EXPECT_NEAR(end.balance() - end.unbalanced, start.balance() - start.unbalanced, 1e-12);
}

/// Returns a square as glTF with the numbers of its vertices as attribute `_PAINT`, and its buffer
/// `square.bin`.
std::string painted_gltf(const std::array<float, 4>& paint, std::string& buffer) {
  const auto put = [&](const auto& numbers) {
    buffer.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof numbers[0]);
  };
  put(std::array<float, 12>{0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 1});
  put(paint);
  put(std::array<std::uint32_t, 6>{0, 2, 1, 0, 3, 2});
  return R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"_PAINT":1},"indices":2}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},
{"bufferView":1,"componentType":5126,"count":4,"type":"SCALAR"},
{"bufferView":2,"componentType":5125,"count":6,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":16},
{"buffer":0,"byteOffset":64,"byteLength":24}],
"buffers":[{"uri":"square.bin","byteLength":88}]})";
}

TEST_F(Maps, AreAttributesOfGltfFiles) {
  const std::string damping = std::string(shell) + "mass_damping = { map = '_PAINT', from = 1, to = 2 } }";
  const auto use = [&](const std::array<float, 4>& paint) {
    std::string buffer;
    write("square.gltf", painted_gltf(paint, buffer));
    write("square.bin", buffer);
  };
  use({0, 0.25F, 1, 0.5F});
  const std::shared_ptr<const Model> model = model_of(damping, "", "square.gltf");
  EXPECT_THAT(as_shell(model->bodies[0])->fabrics[0].maps[0].weights, testing::ElementsAre(0, 0.25, 1, 0.5));
  use({0, 0.25F, NAN, 0.5F});
  EXPECT_THAT(complaint_of(damping, "square.gltf"),
              HasSubstr("the map `_PAINT` of `mass_damping` has no number at vertex 2, counted from 0"));
}

TEST_F(Maps, ThatAreWrongAreErrorsAtTheirPlace) {
  write("short.csv", "1\n0\n");
  write("text.csv", "weight\n0.5\nnan\n");
  const auto with = [&](const std::string& map) {
    return complaint("mass_damping = { map = '" + map + "', from = 1, to = 2 }");
  };
  EXPECT_THAT(with("short.csv"),
              HasSubstr("the map `short.csv` of `mass_damping` has 2 numbers, but the mesh of "
                        "body `strip` has 105 vertices"));
  EXPECT_THAT(with("short.csv"), HasSubstr("scene.toml:11:"));
  EXPECT_THAT(with("text.csv"), HasSubstr("line 3: a number 'nan' is not a finite number"));
  EXPECT_THAT(with("none.npy"), HasSubstr("cannot read"));
  EXPECT_THAT(with("ende"),
              HasSubstr("is no attribute or group of the mesh of body `strip`; did you mean `end`?"));
  EXPECT_THAT(complaint("mass_damping = { map = 'ramp.csv', from = 1, to = 2, highest = 0.5 }"),
              HasSubstr("is 0.55 at vertex 11, counted from 0, which is not between 0 and 0.5"));
  EXPECT_THAT(complaint("bending_bias = { map = 'ramp.csv', from = 1e-7, to = 2e-5 }"),
              HasSubstr("at polygon 1: with"));
  EXPECT_THAT(
      complaint("bending_weft = { map = 'ramp.csv', from = 1e-5, to = 1e-4 }, bending_bias = { keyframes "
                "= [{ time = 0, value = 5e-5 }, { time = 1, value = 2e-5 }] }"),
      HasSubstr(" and 0.6875 s: with"));
  EXPECT_THAT(complaint("weft_curve = [[0.1, 2]], mass_damping = { map = 'ramp.csv', from = 1, to = 2 }"),
              HasSubstr("maps and measured curves are in one material"));
}

}  // namespace
}  // namespace muslin
