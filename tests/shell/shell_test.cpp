// From meshes to shells: areas, hinges, threads, and meshes that cannot be shells.
#include "muslin/shell/shell.hpp"

#include <cmath>
#include <numbers>

#include "support/sheet.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

using ::testing::HasSubstr;

const Weave along_x{Vec3::UnitX()};

std::string problem(const Mesh& mesh, const Weave& weave = along_x) {
  try {
    build_shell(mesh, mesh.positions, weave);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_FALSE(error.remedy().empty());
    return error.problem();
  }
  return {};
}

TEST(Shell, QuadsAreSplitAndAllAreaIsCounted) {
  const Mesh mesh = test::flat_sheet(4, 3, 0.8, 0.6);
  const Shell shell = build_shell(mesh, mesh.positions, along_x);
  EXPECT_EQ(shell.triangles.size(), 24U);
  // Edges: 4·4 + 3·5 of squares and 12 diagonals, less 14 on the boundary.
  EXPECT_EQ(shell.hinges.size(), 43U - 14U);
  EXPECT_NEAR(shell.area, 0.48, 1e-15);
  double sum = 0;
  for (const double a : shell.vertex_areas) sum += a;
  EXPECT_NEAR(sum, 0.48, 1e-15);
  EXPECT_NEAR(shell.mean_edge, (31 * 0.2 + 12 * 0.2 * std::numbers::sqrt2) / 43, 1e-12);
  for (const Hinge& hinge : shell.hinges) {
    EXPECT_NEAR(hinge.area, 0.04, 1e-15);
    EXPECT_NEAR(hinge.angle, 0, 1e-15);
    const double along = (mesh.positions[static_cast<std::size_t>(hinge.vertices[1])] -
                          mesh.positions[static_cast<std::size_t>(hinge.vertices[0])])
                             .normalized()
                             .x();
    EXPECT_NEAR(hinge.warp_share, 1 - along * along, 1e-12);
  }
}

TEST(Shell, ThreadsFollowTheTexture) {
  Mesh mesh = test::flat_sheet(3, 3, 1, 1);
  const double angle = 0.3;
  test::add_flat_uvs(mesh, angle);
  const Shell shell = build_shell(mesh, mesh.positions, {});
  const Vec3 warp(std::cos(angle), 0, std::sin(angle));
  for (std::size_t t = 0; t < shell.triangles.size(); ++t) {
    const auto x = [&](int c) { return mesh.positions[static_cast<std::size_t>(shell.triangles[t][c])]; };
    // F's first column is where a unit of warp went: nowhere yet.
    Eigen::Matrix<double, 3, 2> edges;
    edges << x(1) - x(0), x(2) - x(0);
    EXPECT_LT(((edges * shell.inverses[t]).col(0) - warp).norm(), 1e-12);
  }
}

TEST(Shell, FacePerpendicularToTheWarpGetsAnotherDirection) {
  Mesh mesh = test::flat_sheet(1, 1, 1, 1);
  const Shell shell = build_shell(mesh, mesh.positions, {Vec3::UnitY()});
  EXPECT_EQ(shell.odd_faces, 2U);
  EXPECT_TRUE(shell.inverses[0].allFinite());
}

TEST(Shell, ThreadsOfUntexturedPolygonsContinueThoseOfTheirNeighbours) {
  // A rolled sheet whose texture turns the warp by half a radian; then half of it loses the texture.
  Mesh mesh = test::flat_sheet(6, 3, 1, 0.5);
  const double c = std::cos(0.5), s = std::sin(0.5);
  for (const Vec3& x : mesh.positions) mesh.uvs.emplace_back(c * x.x() + s * x.z(), c * x.z() - s * x.x());
  mesh.corner_uvs = mesh.face_vertices;
  const std::vector<Vec3> rest = test::rolled(mesh.positions, 2);
  const Shell whole = build_shell(mesh, rest, {});
  Mesh half = mesh;
  for (std::size_t corner = half.corner_uvs.size() / 2; corner < half.corner_uvs.size(); ++corner)
    half.corner_uvs[corner] = -1;
  half.corner_uvs[0] = -1;
  const Shell carried = build_shell(half, rest, {});
  ASSERT_EQ(carried.inverses.size(), whole.inverses.size());
  for (std::size_t t = 0; t < whole.inverses.size(); ++t)
    EXPECT_LT((carried.inverses[t] - whole.inverses[t]).norm(), 1e-6 * whole.inverses[t].norm()) << t;
}

TEST(Shell, RestShapeMayDiffer) {
  const Mesh mesh = test::flat_sheet(4, 4, 1, 1);
  const std::vector<Vec3> rest = test::rolled(mesh.positions, 2);
  const Shell shell = build_shell(mesh, rest, along_x);
  double bent = 0;
  for (const Hinge& hinge : shell.hinges) bent = std::max(bent, std::abs(hinge.angle));
  EXPECT_NEAR(bent, 2 * 0.25, 1e-6);
}

TEST(Shell, EdgeOfThreeTrianglesHasTwoHingesWithTheFirst) {
  Mesh mesh;
  mesh.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 0, 1)};
  for (const auto& face : {std::array{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}) mesh.add_face(face);
  const Shell shell = build_shell(mesh, mesh.positions, along_x);
  ASSERT_EQ(shell.hinges.size(), 2U);
  EXPECT_EQ(shell.hinges[0].vertices, (std::array{0, 1, 2, 3}));
  EXPECT_EQ(shell.hinges[1].vertices, (std::array{0, 1, 2, 4}));
  EXPECT_NEAR(shell.hinges[0].angle, 0, 1e-12);
  EXPECT_NEAR(std::abs(shell.hinges[1].angle), std::numbers::pi / 2, 1e-12);
}

TEST(Shell, ErrorsDescribeTheDefect) {
  Mesh twice = test::flat_sheet(2, 1, 1, 1);
  twice.add_face(std::array{0, 3, 4});
  EXPECT_THAT(problem(twice), HasSubstr("polygons 1 and 3 both have the triangle of vertices"));

  Mesh flat = test::flat_sheet(1, 1, 1, 1);
  flat.positions.emplace_back(2, 0, 0);
  flat.add_face(std::array{0, 1, 4});
  EXPECT_THAT(problem(flat), HasSubstr("polygon 2 has a triangle without area"));

  Mesh loose = test::flat_sheet(1, 1, 1, 1);
  loose.positions.emplace_back(2, 0, 0);
  EXPECT_THAT(problem(loose), HasSubstr("vertex 5 belongs to no polygon"));

  Mesh pinched = test::flat_sheet(1, 1, 1, 1);
  pinched.uvs.assign(4, Vec2(0.5, 0.5));
  pinched.corner_uvs = pinched.face_vertices;
  EXPECT_THAT(problem(pinched, {}), HasSubstr("no polygon has texture coordinates with an area"));
}

TEST(Shell, ThreadsWithoutTextureRunAlongTheLongestSide) {
  const Mesh mesh = test::flat_sheet(1, 2, 2, 3);
  const Shell bare = build_shell(mesh, mesh.positions, {}),
              given = build_shell(mesh, mesh.positions, {Vec3::UnitZ()});
  ASSERT_EQ(bare.inverses.size(), given.inverses.size());
  for (std::size_t t = 0; t < bare.inverses.size(); ++t) EXPECT_EQ(bare.inverses[t], given.inverses[t]);
}

TEST(Shell, StretchIsTheLargestInAnyDirection) {
  const Mesh mesh = test::flat_sheet(2, 2, 1, 1);
  const Shell shell = build_shell(mesh, mesh.positions, along_x);
  EXPECT_DOUBLE_EQ(max_stretch(shell, mesh.positions), 1);
  // A simple shear by 1 stretches its longest diagonal direction by the golden ratio.
  std::vector<Vec3> sheared = mesh.positions;
  for (Vec3& p : sheared) p.x() += p.z();
  EXPECT_NEAR(max_stretch(shell, sheared), std::numbers::phi, 1e-12);
}

}  // namespace
}  // namespace muslin
