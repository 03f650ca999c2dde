// rest_scale_warp and rest_scale_weft: a free sheet takes its new size, keeps its mass and closes its energy
// account.
#include <fstream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cache/scratch.hpp"
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
    EXPECT_NEAR(row.balance() - row.unbalanced, balance, 1e-9 * (balance + row.work));
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

TEST(RestScale, ComesAboutByItsShare) {
  const Vec2 half = settled("rest_scale_warp = 0.9\nrest_scale_share = 0.5");
  EXPECT_NEAR(half[0] / 0.25, 0.95, 1e-6);
  const std::string keys =
      "rest_scale_warp = 0.9\nrest_scale_share = { keyframes = [{ time = 0, value = 0 }, { time = 0.4, value "
      "= "
      "1 }] }";
  const Vec2 over_time = settled(keys);
  EXPECT_NEAR(over_time[0] / 0.25, 0.9, 1e-4);
  EXPECT_NEAR(over_time[1] / 0.2, 0.9, 1e-4);
  const auto model = std::make_shared<const Model>(build_model(scene(keys)));
  Simulation simulation(model);
  for (int f = 0; f < 10; ++f) simulation.advance();
  EXPECT_GT(simulation.diagnostics().material_work, 0) << "it pulls itself together";
}

/// A sheet of 20 by 4 squares, with x over its length in `ramp.csv` and as texture coordinates.
class MappedRestScale : public testing::Test {
 protected:
  std::shared_ptr<const Model> model(const std::string& keys) {
    Scene mapped = scene(keys);
    mapped.file = scratch_.path() / "scene.toml";
    auto sheet = std::make_shared<Mesh>(test::flat_sheet(20, 4, 0.25, 0.2));
    std::ofstream ramp(scratch_.path() / "ramp.csv");
    for (const Vec3& p : sheet->positions) ramp << p.x() / 0.25 << '\n';
    ramp.close();
    mapped.meshes["sheet.obj"] = std::move(sheet);
    return std::make_shared<const Model>(build_model(mapped));
  }
  test::Scratch scratch_;
};

TEST_F(MappedRestScale, GivesTheIntegralAsLength) {
  // Along warp by 1 − 0.2 x/L: the shape without stress is flat, and 0.9 L long.
  const auto shrunk =
      model("rest_scale_warp = { map = 'ramp.csv', from = 1, to = 0.8 }\nrest_scale_weft = 1");
  EXPECT_NEAR(shrunk->bodies[0].statistics.mass, 0.1 * 0.25 * 0.2, 1e-12) << "the mass stays";
  Simulation simulation(shrunk);
  while (simulation.frame() < 50) simulation.advance();
  const std::vector<Vec3>& x = simulation.state().positions;
  // Triangles at both margins have their means at 1/3 and 2/3 of a square, which cancels.
  const auto along = [&](std::size_t to) {
    return ((x[to] - x[0]).norm() + (x[84 + to] - x[84]).norm()) / 2;
  };
  EXPECT_NEAR(along(20), 0.9 * 0.25, 2e-4 * 0.25);
  EXPECT_NEAR(along(10), 0.95 * 0.125, 2e-4 * 0.25);
  EXPECT_NEAR((x[84] - x[0]).norm(), 0.2, 1e-3 * 0.2);
}

TEST_F(MappedRestScale, OfOneValueEqualsTheNumberBitForBit) {
  const auto run = [&](const std::string& keys) {
    Simulation simulation(model(keys));
    while (simulation.frame() < 4) simulation.advance();
    return simulation.state().positions;
  };
  EXPECT_EQ(run("rest_scale_warp = { map = 'ramp.csv', from = 0.9, to = 0.9 }"),
            run("rest_scale_warp = 0.9"));
  EXPECT_EQ(
      run("rest_scale_warp = 0.9\nrest_scale_share = { keyframes = [{ time = 0, value = 0.5 }, { time = "
          "1, value = 0.5 }] }"),
      run("rest_scale_warp = 0.9\nrest_scale_share = 0.5"));
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
