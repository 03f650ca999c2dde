// Vertices that nearly coincide: found on borders, joined within a tolerance, and loose ones left out.
#include "muslin/geometry/weld.hpp"

#include "support/panels.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/geometry/inspect.hpp"
#include "muslin/geometry/shapes.hpp"

namespace muslin {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Weld, JoinsTheBordersOfPanels) {
  const Mesh panels = test::two_panels(1.5e-5);
  const ReducedMesh welded = weld(panels, 2e-5);
  EXPECT_EQ(welded.mesh.vertex_count(), 441U);
  EXPECT_EQ(welded.mesh.face_offsets, panels.face_offsets);
  EXPECT_EQ(inspect(welded.mesh).components, 1U);
  EXPECT_EQ(welded.vertices[231], 10);
  EXPECT_EQ(welded.vertices[232], 231);
  EXPECT_EQ(welded.origins[231], 232);
  EXPECT_EQ(welded.mesh.positions[10], panels.positions[10]);
  for (std::size_t c = 0; c < panels.face_vertices.size(); ++c)
    EXPECT_EQ(welded.mesh.face_vertices[c],
              welded.vertices[static_cast<std::size_t>(panels.face_vertices[c])]);
  EXPECT_EQ(weld(panels, 1e-5).mesh.vertex_count(), panels.vertex_count());
}

TEST(Weld, GroupsContainTheJoinedVerticesOnce) {
  Mesh panels = test::two_panels(1.5e-5);
  panels.groups = {{"seam", {}, {10, 231, 232}}};
  EXPECT_THAT(weld(panels, 2e-5).mesh.groups[0].vertices, ElementsAre(10, 231));
}

TEST(Weld, OfZeroJoinsWhatCoincides) {
  const Mesh cube = box_mesh(Vec3::Zero(), Vec3::Ones());
  Mesh apart;
  for (const int v : cube.face_vertices)
    apart.positions.push_back(cube.positions[static_cast<std::size_t>(v)]);
  apart.face_offsets = cube.face_offsets;
  for (int c = 0; c < static_cast<int>(apart.positions.size()); ++c) apart.face_vertices.push_back(c);
  const ReducedMesh welded = weld(apart, 0);
  EXPECT_EQ(welded.mesh.vertex_count(), 8U);
  EXPECT_TRUE(inspect(welded.mesh).closed);
}

TEST(Weld, ThatWouldCloseAPolygonIsAnError) {
  try {
    weld(test::two_panels(1.5e-5), 0.06);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_THAT(error.what(), HasSubstr("a weld of 0.06 m joins vertices 1 and 12 of polygon 1"));
    EXPECT_THAT(error.remedy(), HasSubstr("give a smaller `weld`"));
  }
}

TEST(Weld, LooseVerticesCanBeLeftOut) {
  Mesh mesh = test::flat_sheet(2, 1, 2, 1);
  mesh.positions.insert(mesh.positions.begin(), Vec3(5, 5, 5));
  for (int& v : mesh.face_vertices) ++v;
  mesh.groups = {{"some", {}, {0, 1, 2}}};
  const ReducedMesh left = without_loose_vertices(mesh);
  EXPECT_THAT(left.vertices, ElementsAre(-1, 0, 1, 2, 3, 4, 5));
  EXPECT_THAT(left.origins, ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_THAT(left.mesh.groups[0].vertices, ElementsAre(0, 1));
}

TEST(NearBorders, AreCountedWithTheirDistanceAndARemedy) {
  const NearBorders near = near_borders(test::two_panels(1.5e-5));
  EXPECT_EQ(near.vertices, 42U);
  EXPECT_NEAR(near.distance, 1.5e-5, 1e-12);
  EXPECT_THAT(
      inspect(test::two_panels(1.5e-5)).warnings,
      ElementsAre("42 vertices on borders lie within 1.5e-05 m of others but are not joined, so that the "
                  "borders come apart (2 pieces); `weld = 3e-05` joins them."));
  EXPECT_EQ(near_borders(test::two_panels(0)).vertices, 42U);
  EXPECT_EQ(near_borders(test::two_panels(0.001)).vertices, 0U);
  EXPECT_EQ(near_borders(test::flat_sheet(4, 3, 1, 1)).vertices, 0U);
  EXPECT_EQ(near_borders(test::flat_sheet(100, 1, 1, 1e-4)).vertices, 0U);
}

}  // namespace
}  // namespace muslin
