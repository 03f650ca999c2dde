// Keys of internal friction: what is left out, what a base gives, what is wrong, and that they reach the
// model.
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "support/sheet.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "muslin/component/shell/shell_body.hpp"
#include "muslin/material/material.hpp"
#include "muslin/scene/describe.hpp"
#include "muslin/scene/model.hpp"

namespace muslin {
namespace {

using testing::HasSubstr;

Scene scene(const std::string& material) {
  Scene scene = parse_scene(
      "[[body]]\nname = 'cloth'\nmesh = 'sheet.obj'\nmodel = 'shell'\nwarp = [1, 0, 0]\n"
      "material = { " +
          material + " }\n",
      "scene.toml");
  scene.meshes["sheet.obj"] = std::make_shared<Mesh>(test::flat_sheet(4, 3, 0.8, 0.6));
  return scene;
}
ShellMaterial read(const std::string& material) { return *scene(material).bodies[0].material.shell; }
std::string message(const std::string& material) {
  try {
    scene(material);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.what();
  }
  return "no error";
}

const std::string cloth = "areal_density = 0.2, membrane_warp = 100, bending_warp = 1e-5";

TEST(BendingFrictionKeys, OfWeftIsThatOfWarpUnlessGiven) {
  EXPECT_EQ(read(cloth).bending_friction_warp, 0);
  const ShellMaterial both = read(cloth + ", bending_friction_warp = 2e-4");
  EXPECT_EQ(both.bending_friction_weft, 2e-4);
  EXPECT_EQ(both.bending_friction_curvature, 10);
  EXPECT_EQ(read(cloth + ", bending_friction_warp = 2e-4, bending_friction_weft = 0").bending_friction_weft,
            0);
  EXPECT_EQ(read("base = 'cotton', bending_friction_warp = 2e-4").bending_friction_weft, 2e-4);
}

TEST(BendingFrictionKeys, BelongToMaterialFilesAndTheirGuesses) {
  const Material material = parse_material(
      "guesses = ['shell.bending_friction_warp']\n[shell]\nareal_density = 0.2\nmembrane_warp = 100\n"
      "bending_warp = 1e-5\nbending_friction_warp = 2e-4\nbending_friction_weft = 1e-4\n",
      "rubbing.toml");
  std::map<std::string, MaterialNumber> numbers;
  for (const MaterialNumber& number : shell_numbers(material)) numbers[number.key] = number;
  EXPECT_EQ(numbers.at("bending_friction_warp").value, 2e-4);
  EXPECT_TRUE(numbers.at("bending_friction_warp").guess);
  EXPECT_EQ(numbers.at("bending_friction_weft").value, 1e-4);
  EXPECT_FALSE(numbers.at("bending_friction_weft").guess);
  EXPECT_EQ(numbers.at("bending_friction_curvature").unit, "1/m");
  EXPECT_EQ(shell_numbers(find_material("silk")).size(), numbers.size() - 3);
}

TEST(BendingFrictionKeys, WrongNumbersAreErrors) {
  EXPECT_THAT(message(cloth + ", bending_friction_warp = -1"), HasSubstr("is -1; give a number from 0"));
  EXPECT_THAT(message(cloth + ", bending_friction_warp = 1, bending_friction_curvature = 0"),
              HasSubstr("is 0; give a number from 0.001"));
}

TEST(BendingFrictionKeys, ReachTheModelOnlyIfGiven) {
  const Model without = build_model(scene(cloth)),
              with = build_model(scene(cloth + ", bending_friction_weft = 2e-4"));
  EXPECT_TRUE(without.loads.empty());
  ASSERT_EQ(with.loads.size(), 1u);
  EXPECT_EQ(with.loads[0].name, "cloth: bending friction");
  EXPECT_NE(without.bodies[0].material_hash(0), with.bodies[0].material_hash(0));
  EXPECT_LT(build_model(scene(cloth + ", bending_friction_weft = 1e3")).bodies[0].statistics.stable_step,
            0.5 * without.bodies[0].statistics.stable_step);
  EXPECT_THAT(describe_text(with),
              HasSubstr("friction    of bending, up to warp 0, weft 0.0002 N within 10/m"));
  const auto resolved = [](const Model& model) {
    return nlohmann::json::parse(model.scene.resolved)["body"][0]["material"];
  };
  EXPECT_EQ(resolved(with)["bending_friction_weft"], 2e-4);
  EXPECT_FALSE(resolved(without).contains("bending_friction_curvature"));
}

}  // namespace
}  // namespace muslin
