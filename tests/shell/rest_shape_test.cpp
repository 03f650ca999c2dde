// Rest shapes of their own vertices: patterns that are cut along seams, and textures as patterns.
#include "muslin/shell/rest_shape.hpp"

#include <algorithm>
#include <cstring>

#include "support/tube.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/shell/shell.hpp"
#include "muslin/shell/triangle_corners.hpp"

namespace muslin {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const Weave along_x{Vec3::UnitX()};

bool same_bits(const Shell& a, const Shell& b) {
  return a.inverses == b.inverses && a.areas == b.areas && a.vertex_areas == b.vertex_areas &&
         a.mean_edge == b.mean_edge && a.hinges.size() == b.hinges.size() &&
         std::memcmp(a.hinges.data(), b.hinges.data(), a.hinges.size() * sizeof(Hinge)) == 0;
}

TEST(RestShape, TubeOfACutPatternHasItsTrianglesAndIsFlatAtTheSeam) {
  const test::Tube tube = test::sewn_tube(12, 5, 0.6, 0.2);
  const Shell pattern = build_shell(tube.flat, tube.flat.positions, along_x);
  const Shell shell = build_shell(tube.sewn, tube.pattern(), along_x);
  EXPECT_EQ(shell.inverses, pattern.inverses);
  EXPECT_EQ(shell.areas, pattern.areas);
  EXPECT_EQ(shell.vertex_count(), 72U);
  EXPECT_EQ(shell.hinges.size(), pattern.hinges.size() + 5);
  EXPECT_EQ(shell.seam_hinges, 5U);
  for (const Hinge& hinge : shell.hinges) EXPECT_EQ(hinge.angle, 0);
  EXPECT_NEAR(max_stretch(shell, tube.sewn.positions), 1, 1e-12);
}

TEST(RestShape, CornersOfTheirOwnAtTheSamePlaceAreTheMeshBitForBit) {
  const Mesh mesh = test::flat_sheet(5, 4, 1, 0.9, 0.2);
  const std::vector<Vec3> rolled = test::rolled(mesh.positions, 2, 0.4);
  RestShape apart;
  for (const int v : mesh.face_vertices) {
    apart.corners.push_back(static_cast<int>(apart.positions.size()));
    apart.positions.push_back(rolled[static_cast<std::size_t>(v)]);
  }
  EXPECT_TRUE(same_bits(build_shell(mesh, apart, along_x), build_shell(mesh, rolled, along_x)));
  EXPECT_EQ(build_shell(mesh, apart, along_x).seam_hinges, 0U);
}

TEST(RestShape, LengthsOnBothSidesOfASeamMayDiffer) {
  // A gathered seam: the second square is 1.5 times as wide as the first.
  const Mesh sewn = test::flat_sheet(1, 2, 1, 2);
  const RestShape rest{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(1, 0, 1), Vec3(3, 0, 0),
                        Vec3(4.5, 0, 0), Vec3(3, 0, 1), Vec3(4.5, 0, 1)},
                       {0, 2, 3, 1, 4, 6, 7, 5}};
  const Shell shell = build_shell(sewn, rest, along_x);
  EXPECT_DOUBLE_EQ(shell.area, 2.5);
  EXPECT_EQ(shell.seam_hinges, 1U);
  const auto seam = std::find_if(shell.hinges.begin(), shell.hinges.end(),
                                 [](const Hinge& h) { return h.vertices[0] + h.vertices[1] == 5; });
  ASSERT_NE(seam, shell.hinges.end());
  EXPECT_DOUBLE_EQ(seam->length, 1.25);
  EXPECT_EQ(seam->angle, 0);
}

TEST(RestShape, TextureIsAPatternOfItsScale) {
  test::Tube tube = test::sewn_tube(12, 5, 0.6, 0.2);
  for (const Vec3& p : tube.flat.positions) tube.sewn.uvs.emplace_back(p.x() / 3, p.z() / 3);
  tube.sewn.corner_uvs = tube.flat.face_vertices;
  const RestShape rest = rest_of_texture(tube.sewn, 3);
  const Shell shell = build_shell(tube.sewn, rest, {});
  const Shell pattern = build_shell(tube.flat, tube.flat.positions, along_x);
  EXPECT_THAT(faces_without_texture(tube.sewn), IsEmpty());
  EXPECT_EQ(shell.seam_hinges, 5U);
  for (std::size_t t = 0; t < shell.inverses.size(); ++t)
    EXPECT_LT((shell.inverses[t] - pattern.inverses[t]).norm(), 1e-12 * pattern.inverses[t].norm());
  // Without a scale the areas agree, which here gives the same.
  EXPECT_NEAR(rest_of_texture(tube.sewn, std::nullopt).uv_scale, 3, 1e-12);
}

TEST(RestShape, MirroredHalvesOfATextureAreNotFolded) {
  Mesh mesh = test::flat_sheet(2, 1, 2, 1);
  for (const Vec3& p : mesh.positions) mesh.uvs.emplace_back(std::abs(p.x() - 1), p.z());
  mesh.corner_uvs = mesh.face_vertices;
  for (const Hinge& hinge : build_shell(mesh, rest_of_texture(mesh, 1), {}).hinges) EXPECT_EQ(hinge.angle, 0);
}

TEST(RestShape, PolygonWithoutAreaInTheTextureKeepsTheShapeOfTheMesh) {
  Mesh mesh = test::flat_sheet(3, 1, 0.3, 0.1);
  for (const Vec3& p : mesh.positions) mesh.uvs.emplace_back(2 * p.x(), 2 * p.z());
  mesh.corner_uvs = mesh.face_vertices;
  std::fill_n(mesh.corner_uvs.begin() + 4, 4, 0);
  const RestShape rest = rest_of_texture(mesh, 1);
  EXPECT_THAT(faces_without_texture(mesh), ElementsAre(1));
  const Shell shell = build_shell(mesh, rest, {});
  EXPECT_NEAR(shell.area, 0.04 + 0.01 + 0.04, 1e-15);
  // A texture index that is missing is the same defect.
  std::fill_n(mesh.corner_uvs.begin() + 4, 4, -1);
  EXPECT_THAT(faces_without_texture(mesh), ElementsAre(1));
  EXPECT_NEAR(rest_of_texture(mesh, std::nullopt).uv_scale, 0.5, 1e-12);
  std::fill(mesh.corner_uvs.begin(), mesh.corner_uvs.end(), 0);
  EXPECT_THROW(rest_of_texture(mesh, 1), Error);
}

}  // namespace
}  // namespace muslin
