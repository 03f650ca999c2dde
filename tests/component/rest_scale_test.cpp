// rest_scale_warp and rest_scale_weft: a free sheet takes its new size, keeps its mass and closes its energy
// account.
#include <memory>
#include <string>

#include "support/sheet.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/component/shell/shell_body.hpp"
#include "muslin/core/error.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

Scene scene(const std::string& keys) {
  Scene scene = parse_scene(
      "[time]\nframe_rate = 50\nduration = 1\n[solver]\neffort = \"exact\"\n"
      "[[body]]\nname = \"cloth\"\nmesh = \"sheet.obj\"\nmodel = \"shell\"\nwarp = [1, 0, 0]\n"
      "contact = false\ncompression = \"elastic\"\n" +
          keys +
          "\nmaterial = { areal_density = 0.1, membrane_warp = 100, bending_warp = 1e-4, mass_damping = 60 "
          "}\n",
      "scene.toml");
  scene.meshes["sheet.obj"] = std::make_shared<Mesh>(test::flat_sheet(5, 4, 0.25, 0.2, 0.2));
  return scene;
}

/// The lengths of the sheet along x and z after a second without forces.
Vec2 settled(const std::string& keys) {
  const auto model = std::make_shared<const Model>(build_model(scene(keys)));
  EXPECT_NEAR(model->bodies[0].statistics.mass, 0.1 * 0.25 * 0.2, 1e-12);
  Simulation simulation(model);
  const double balance = simulation.diagnostics().balance();
  while (simulation.frame() < 50) {
    simulation.advance();
    const Diagnostics& row = simulation.diagnostics();
    EXPECT_NEAR(row.balance() - row.unbalanced, balance, 1e-9 * balance);
  }
  const std::vector<Vec3>& x = simulation.state().positions;
  return {(x[5] - x[0]).norm(), (x[24] - x[0]).norm()};
}

TEST(RestScale, FreeSheetTakesItsNewSize) {
  const Vec2 both = settled("rest_scale_warp = 0.9"),
             each = settled("rest_scale_warp = 0.9\nrest_scale_weft = 1.2");
  EXPECT_NEAR(both[0] / 0.25, 0.9, 1e-6);
  EXPECT_NEAR(both[1] / 0.2, 0.9, 1e-6);
  EXPECT_NEAR(each[0] / 0.25, 0.9, 1e-6);
  EXPECT_NEAR(each[1] / 0.2, 1.2, 1e-6);
}

TEST(RestScale, OfOneIsTheMeshBitForBit) {
  const Model given = build_model(scene("rest_scale_warp = 1")), without = build_model(scene(""));
  EXPECT_EQ(given.bodies[0].shape_hash(0), without.bodies[0].shape_hash(0));
  EXPECT_EQ(given.masses, without.masses);
}

TEST(RestScale, MustBePositive) {
  try {
    scene("rest_scale_warp = 0");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("give a number from 0.01"));
  }
}

}  // namespace
}  // namespace muslin
