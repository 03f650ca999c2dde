#include "muslin/post/subdivision.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/shapes.hpp"
#include <gmock/gmock.h>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

using testing::HasSubstr;

/// A square of n by n quads with texture coordinates equal to the positions.
Mesh quads(int n) {
  Mesh mesh;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) mesh.positions.emplace_back(1.0 * i / n, 1.0 * j / n, 0);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int v = j * (n + 1) + i;
      mesh.add_face(std::array{v, v + 1, v + n + 2, v + n + 1});
    }
  for (const Vec3& x : mesh.positions) mesh.uvs.emplace_back(x.x(), x.y());
  mesh.corner_uvs = mesh.face_vertices;
  return mesh;
}

TEST(Subdivision, TriangleOfLoopIsTheMaskOfThePaper) {
  // An inner edge: 3/8 of its ends and 1/8 of the opposite corners (Loop 1987).
  Mesh mesh = quads(4);
  mesh.face_offsets.clear();
  std::vector<int> corners;
  corners.swap(mesh.face_vertices);
  mesh.corner_uvs.clear();
  for (std::size_t c = 0; c < corners.size(); c += 4) {
    mesh.add_face(std::array{corners[c], corners[c + 1], corners[c + 2]});
    mesh.add_face(std::array{corners[c], corners[c + 2], corners[c + 3]});
  }
  const Subdivision subdivision(mesh, 1);
  EXPECT_EQ(subdivision.mesh().face_count(), 4 * mesh.face_count());
  std::vector<Vec3> raised(mesh.vertex_count(), Vec3::Zero());
  std::size_t centre = 0;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    if ((mesh.positions[v] - Vec3(0.5, 0.5, mesh.positions[v].z())).norm() < 1e-12) centre = v;
  raised[centre].z() = 1;
  std::vector<double> heights;
  for (const Vec3& x : subdivision.points(raised))
    if (x.z() != 0) heights.push_back(x.z());
  std::sort(heights.begin(), heights.end());
  // A regular vertex keeps 5/8 and gives 1/16 to each of 6 neighbours, 3/8 to 6 edges, 1/8 to 6 more.
  ASSERT_EQ(heights.size(), 19U);
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(heights[i], 1.0 / 16, 1e-7);
    EXPECT_NEAR(heights[6 + i], 1.0 / 8, 1e-7);
    EXPECT_NEAR(heights[12 + i], 3.0 / 8, 1e-7);
  }
  EXPECT_NEAR(heights[18], 5.0 / 8, 1e-7);
}

TEST(Subdivision, AFlatSheetStaysFlatWithItsCornersAndTexture) {
  const Mesh mesh = quads(3);
  const Subdivision subdivision(mesh, 2);
  const Mesh& fine = subdivision.mesh();
  EXPECT_EQ(fine.face_count(), 16 * mesh.face_count());
  Box box;
  for (const Vec3& x : fine.positions) box.extend(x);
  EXPECT_NEAR((box.min() - Vec3::Zero()).norm(), 0, 1e-12);
  EXPECT_NEAR((box.max() - Vec3(1, 1, 0)).norm(), 0, 1e-12);
  ASSERT_EQ(fine.corner_uvs.size(), fine.face_vertices.size());
  for (std::size_t c = 0; c < fine.corner_uvs.size(); ++c) {
    ASSERT_GE(fine.corner_uvs[c], 0);
    const Vec2& uv = fine.uvs[static_cast<std::size_t>(fine.corner_uvs[c])];
    const Vec3& x = fine.positions[static_cast<std::size_t>(fine.face_vertices[c])];
    EXPECT_NEAR((uv - x.head<2>()).norm(), 0, 0.02)
        << c;  // positions smooth along the border, texture linear
  }
}

TEST(Subdivision, ASphereStaysNearASphere) {
  const Mesh fine = Subdivision(shapes::sphere(1, 3), 2).mesh();
  for (const Vec3& x : fine.positions) {
    EXPECT_LE(x.norm(), 1);
    EXPECT_GT(x.norm(), 0.975);  // Loop's mask cuts off about half of the sagitta of 0.28
  }
}

TEST(Subdivision, RigidMotionsMoveThePointsRigidly) {
  const Mesh mesh = quads(3);
  const Subdivision subdivision(mesh, 2);
  const Eigen::Affine3d motion =
      Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized());
  std::vector<Vec3> moved = mesh.positions;
  for (Vec3& x : moved) x = motion * x;
  const std::vector<Vec3> points = subdivision.points(moved);
  for (std::size_t v = 0; v < points.size(); ++v)
    EXPECT_NEAR((points[v] - motion * subdivision.mesh().positions[v]).norm(), 0, 1e-6);
}

TEST(Subdivision, GroupsHoldThePartsOfTheirFaces) {
  Mesh mesh = quads(2);
  mesh.groups = {{"left", {0, 2}, {0, 1, 3, 4, 6, 7}}, {"corner", {}, {0, 1, 3, 4}}};
  mesh.materials = {{"blue", {0, 2}}, {"red", {1}}};
  const Mesh fine = Subdivision(mesh, 1).mesh();
  ASSERT_EQ(fine.materials.size(), 2U);
  EXPECT_EQ(fine.materials[0].faces, fine.groups[0].faces) << "materials go to the same parts";
  EXPECT_EQ(fine.materials[1].faces.size(), 4U);
  ASSERT_EQ(fine.groups.size(), 2U);
  EXPECT_EQ(fine.groups[0].faces.size(), 8U);
  EXPECT_EQ(fine.groups[0].vertices.size(), 15U);
  for (const int f : fine.groups[0].faces)
    for (const int v : fine.face(static_cast<std::size_t>(f)))
      EXPECT_LE(fine.positions[static_cast<std::size_t>(v)].x(), 0.5 + 1e-12);
  // Made of the four corners of the first face alone: all corners of its parts but those that its neighbours
  // move.
  EXPECT_TRUE(fine.groups[1].faces.empty());
  for (const int v : fine.groups[1].vertices)
    EXPECT_LE(fine.positions[static_cast<std::size_t>(v)].maxCoeff(), 0.5 + 1e-12);
  EXPECT_GE(fine.groups[1].vertices.size(), 4U);
}

TEST(Subdivision, EdgesOfThreeFacesStay) {
  Mesh mesh = shapes::from({{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 0, 1}},
                           {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  const Mesh fine = Subdivision(mesh, 2).mesh();
  EXPECT_EQ(fine.face_count(), 48U);
  std::vector<double> along;  // the edge, in quarters
  for (const Vec3& x : fine.positions)
    if (std::abs(x.x()) < 1e-7 && std::abs(x.z()) < 1e-7) along.push_back(x.y());
  std::sort(along.begin(), along.end());
  ASSERT_EQ(along.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(along[i], 0.25 * static_cast<double>(i), 1e-6);
}

TEST(Subdivision, RefusesWhatItCannotSubdivide) {
  const auto problem = [](const Mesh& mesh, int levels) -> std::string {
    try {
      const Subdivision made(mesh, levels);
    } catch (const Error& error) {
      return error.problem();
    }
    return "none";
  };
  EXPECT_THAT(problem(quads(200), 8), HasSubstr("million faces"));
  Mesh twice = quads(1);
  twice.face_vertices[1] = twice.face_vertices[0];
  EXPECT_THAT(problem(twice, 1), HasSubstr("face 0 names a vertex twice"));
}

}  // namespace
}  // namespace muslin
