// `weld` of a body: one cloth is simulated, output keeps the vertices of the file. Loose vertices of a shell
// stay where they are.
#include <algorithm>
#include <memory>
#include <string>

#include "support/panels.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Scene scene(const Mesh& mesh, const std::string& keys, const std::string& more = "") {
  Scene scene = parse_scene(
      "[time]\nframe_rate = 24\nduration = 1\n[[body]]\nname = \"cloth\"\nmesh = "
      "\"cloth.obj\"\nmodel = \"shell\"\nwarp = [1, 0, 0]\nmaterial = \"cotton\"\n" +
          keys + "\n[[force]]\ntype = \"gravity\"\n" + more,
      "scene.toml");
  scene.meshes["cloth.obj"] = std::make_shared<Mesh>(mesh);
  return scene;
}

const std::string pin = "[[pin]]\nwhere = { line = { from = [0, 0, 0], to = [0, 0, 1] } }\n";

TEST(WeldBody, JoinedPanelsHangTogether) {
  const Mesh panels = test::two_panels(1.5e-5);
  const auto model = std::make_shared<const Model>(build_model(scene(panels, "weld = 2e-5", pin)));
  EXPECT_THAT(model->warnings, IsEmpty());
  const Component& body = model->bodies[0];
  EXPECT_EQ(body.vertex_count, 441);
  EXPECT_EQ(body.skin_mesh().vertex_count(), 462U);
  EXPECT_EQ(body.skin_mesh().face_vertices, panels.face_vertices);
  EXPECT_THAT(body.description(), HasSubstr("file        462 vertices"));
  Simulation simulation(model);
  for (int frame = 0; frame < 4; ++frame) simulation.advance();
  const std::vector<Vec3> points = simulation.body("cloth").points();
  ASSERT_EQ(points.size(), 462U);
  for (std::size_t k = 0; k <= 20; ++k) EXPECT_EQ(points[10 + 11 * k], points[231 + 11 * k]);
  EXPECT_LT(points[461].y(), -0.02);
  EXPECT_GT(points[461].x(), 0.9);
}

TEST(WeldBody, PanelsThatAreNotJoinedAreAWarning) {
  const Model model = build_model(scene(test::two_panels(1.5e-5), "contact = false", pin));
  EXPECT_THAT(model.warnings,
              ElementsAre(HasSubstr("body cloth: 42 vertices on borders lie within 1.5e-05 m of "
                                    "others but are not joined")));
  EXPECT_THAT(model.bodies[0].description(), HasSubstr("pieces      2 that are not joined"));
}

TEST(WeldBody, OfALatticeKeepsTheVerticesOfItsFile) {
  Mesh open = test::two_panels(1.5e-5);
  Scene lattice = parse_scene(
      "[[body]]\nname = \"cloth\"\nmesh = \"cloth.obj\"\nvoxel_width = 0.1\nweld = 2e-5\n"
      "material = \"rubber\"\nthickness = 0.1\n[contact]\n",
      "scene.toml");
  lattice.meshes["cloth.obj"] = std::make_shared<Mesh>(open);
  const Model model = build_model(lattice);
  EXPECT_EQ(model.bodies[0].mesh.vertex_count(), 441U);
  EXPECT_EQ(model.bodies[0].skin.size(), 462U);
  EXPECT_EQ(model.bodies[0].report.components, 1U);
}

TEST(WeldBody, ThatJoinsNothingIsAWarning) {
  EXPECT_THAT(build_model(scene(test::flat_sheet(4, 3, 0.4, 0.3), "weld = 1e-4")).warnings,
              ElementsAre("body cloth: `weld` = 0.0001 m joins no vertices"));
}

TEST(WeldBody, LooseVertexOfAShellStaysWhereItIs) {
  Mesh sheet = test::flat_sheet(4, 3, 0.4, 0.3);
  sheet.positions.emplace_back(0.2, 1, 0.1);
  const auto model = std::make_shared<const Model>(build_model(scene(sheet, "")));
  EXPECT_THAT(model->warnings,
              ElementsAre("body cloth: 1 vertex belongs to no polygon and stays where it is; "
                          "delete loose vertices"));
  Simulation simulation(model);
  for (int frame = 0; frame < 2; ++frame) simulation.advance();
  const std::vector<Vec3> points = simulation.body("cloth").points();
  ASSERT_EQ(points.size(), 21U);
  EXPECT_EQ(points[20], Vec3(0.2, 1, 0.1));
  EXPECT_LT(points[0].y(), -0.01);
}

TEST(WeldBody, EdgeOfThreePolygonsOfAShellIsNoWarning) {
  Mesh pleat = test::flat_sheet(4, 2, 0.4, 0.2);
  for (int i = 0; i <= 4; ++i) pleat.positions.emplace_back(0.1 * i, 0.1, 0.1);
  for (int i = 0; i < 4; ++i) pleat.add_face(std::array{5 + i, 15 + i, 16 + i, 6 + i});
  const Model model = build_model(scene(pleat, "", pin));
  EXPECT_EQ(model.bodies[0].report.non_manifold_edges, 4U);
  EXPECT_THAT(model.warnings, IsEmpty());
}

TEST(WeldBody, GarmentInCentimetresIsAWarning) {
  EXPECT_THAT(
      build_model(scene(test::flat_sheet(4, 3, 60, 80), "")).warnings,
      testing::Contains("body cloth: it is 80 m across; if its mesh is in centimetres, set `scale = 0.01`"));
}

}  // namespace
}  // namespace muslin
