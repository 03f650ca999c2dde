#include "muslin/view/page_surface.hpp"

#include <cmath>
#include <set>

#include "support/lattice_box.hpp"
#include "support/small_model.hpp"
#include <gtest/gtest.h>

namespace muslin {
namespace {

RunReader::Cells shape_of(const Lattice& lattice) {
  RunReader::Cells shape;
  shape.rest_positions = test::rest_positions(lattice);
  shape.voxels = lattice.voxel_vertices;
  return shape;
}

double volume(const Mesh& mesh) {
  double six = 0;
  for (const Vec3i& t : triangulate(mesh).triangles) {
    const auto at = [&](int i) -> const Vec3& { return mesh.positions[static_cast<std::size_t>(t[i])]; };
    six += at(0).cross(at(1)).dot(at(2));
  }
  return six / 6;
}

TEST(CellsOutside, IsTheClosedSkinOfTheVoxelsTurnedOutwards) {
  const CellsOutside outside = outside_of(shape_of(test::box_lattice({3, 2, 4})));
  EXPECT_EQ(outside.mesh.face_count(), 2u * (3 * 2 + 2 * 4 + 3 * 4));
  EXPECT_EQ(outside.vertices.size(), 4u * 3 * 5 - 2 * 1 * 3);  // all but those inside
  EXPECT_NEAR(volume(outside.mesh), 24, 1e-12);
}

TEST(CellsOutside, KeepsEveryVertexOfASheet) {
  const Lattice lattice = test::box_lattice({5, 4, 1});
  const CellsOutside outside = outside_of(shape_of(lattice));
  ASSERT_EQ(outside.vertices.size(), lattice.vertices.size());
  for (std::size_t v = 0; v < outside.vertices.size(); ++v)
    EXPECT_EQ(outside.vertices[v], static_cast<int>(v));
}

TEST(PageSurface, SplitsVerticesAtCreasesAndSeams) {
  const Model model = test::small_model();  // a box of six quads with a texture seam at one corner
  const Mesh& mesh = model.bodies[0].mesh;
  const PageSurface surface = page_surface(mesh);
  EXPECT_EQ(surface.triangles.size(), 3u * 12);
  EXPECT_EQ(surface.normal_count, 24u);   // each corner of the box has three normals
  EXPECT_EQ(surface.points.size(), 24u);  // which the texture does not split further
  EXPECT_EQ(surface.rest_lengths.size(), 12u);
  double sum = 0;
  for (const float length : surface.rest_lengths) sum += static_cast<double>(length);
  EXPECT_NEAR(sum, 4 * (3 + 2 + 1), 1e-5);
  for (const std::uint32_t corner : surface.triangles) ASSERT_LT(corner, surface.points.size());
  for (const std::uint32_t point : surface.points) ASSERT_LT(point, mesh.vertex_count());
  EXPECT_EQ(std::set<std::uint32_t>(surface.points.begin(), surface.points.end()).size(), 8u);
}

TEST(PageSurface, DoesNotCreaseAtASeamOfTheTexture) {
  // Two coplanar quads whose texture coordinates differ along the edge between them.
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}};
  mesh.face_offsets = {0, 4, 8};
  mesh.face_vertices = {0, 1, 4, 3, 1, 2, 5, 4};
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.corner_uvs = {0, 1, 2, 3, 0, 1, 2, 3};
  const PageSurface surface = page_surface(mesh);
  EXPECT_EQ(surface.normal_count, 6u);
  EXPECT_EQ(surface.points.size(), 8u);
}

}  // namespace
}  // namespace muslin
