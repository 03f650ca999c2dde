#include "muslin/geometry/mesh.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

Mesh polygon(const std::vector<Vec3>& corners) {
  Mesh mesh;
  mesh.positions = corners;
  std::vector<int> face(corners.size());
  for (std::size_t c = 0; c < face.size(); ++c) face[c] = static_cast<int>(c);
  mesh.add_face(face);
  return mesh;
}

Mesh outline(const std::vector<Vec2>& corners, const Mat3& rotation = Mat3::Identity()) {
  std::vector<Vec3> positions;
  for (const Vec2& c : corners) positions.push_back(rotation * Vec3(c.x(), c.y(), 0) + Vec3(3, -2, 5));
  return polygon(positions);
}

double area(const Mesh& mesh, const Vec3i& triangle) {
  return newell_normal(mesh.positions, {triangle.data(), 3}).norm() / 2;
}

// The triangles of a simple polygon: right count, every boundary edge once, the polygon's area with no
// overlap (all oriented alike and their areas add up).
void expect_partition(const Mesh& mesh) {
  const Triangulation cut = triangulate(mesh);
  ASSERT_EQ(cut.triangles.size(), mesh.face(0).size() - 2);
  const Vec3 normal = newell_normal(mesh.positions, mesh.face(0));
  double sum = 0;
  std::map<std::pair<int, int>, int> edges;
  for (const Vec3i& t : cut.triangles) {
    EXPECT_GT(newell_normal(mesh.positions, {t.data(), 3}).dot(normal), 0) << t.transpose();
    sum += area(mesh, t);
    for (int i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
  }
  EXPECT_NEAR(sum, normal.norm() / 2, 1e-12 * normal.norm());
  const auto face = mesh.face(0);
  for (std::size_t c = 0; c < face.size(); ++c)
    EXPECT_EQ((edges[{face[c], face[(c + 1) % face.size()]}]), 1) << "edge " << c;
}

const Mat3 tilted = Eigen::AngleAxisd(1.1, Vec3(1, 2, -0.5).normalized()).toRotationMatrix();

TEST(Mesh, AddFaceKeepsCornersAndUvsInStep) {
  Mesh mesh;
  mesh.positions.assign(5, Vec3::Zero());
  EXPECT_EQ(mesh.face_count(), 0u);
  mesh.add_face(std::vector<int>{0, 1, 2, 3});
  mesh.corner_uvs = {0, 1, 2, 3};
  mesh.add_face(std::vector<int>{4, 1, 0});
  ASSERT_EQ(mesh.face_count(), 2u);
  EXPECT_EQ(mesh.face(1)[0], 4);
  EXPECT_EQ(mesh.corner_uvs, (std::vector<int>{0, 1, 2, 3, -1, -1, -1}));
  EXPECT_THROW(mesh.add_face(std::vector<int>{0, 1}), Error);
}

TEST(Mesh, BoundsAreOfTheFacesNotOfStrayVertices) {
  Mesh mesh = outline({{0, 0}, {2, 0}, {0, 1}});
  mesh.positions.push_back(Vec3(100, 100, 100));
  EXPECT_EQ(mesh.bounds().min(), Vec3(3, -2, 5));
  EXPECT_EQ(mesh.bounds().max(), Vec3(5, -1, 5));
  mesh.face_offsets.clear();
  mesh.face_vertices.clear();
  EXPECT_EQ(mesh.bounds().max(), Vec3(100, 100, 100));
}

TEST(Triangulate, KeepsFaceOrderAndOrientation) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}};
  mesh.add_face(std::vector<int>{1, 4, 2});
  mesh.add_face(std::vector<int>{0, 1, 2, 3});
  const Triangulation cut = triangulate(mesh);
  ASSERT_EQ(cut.triangles.size(), 3u);
  EXPECT_EQ(cut.triangles[0], Vec3i(1, 4, 2));
  EXPECT_EQ(cut.faces, (std::vector<int>{0, 1, 1}));
  EXPECT_TRUE(triangulate(Mesh{}).triangles.empty());
}

TEST(Triangulate, CutsConcaveOutlinesInside) {
  const std::vector<Vec2> arrow = {{0, 0}, {4, 2}, {0, 4}, {1, 2}};
  const std::vector<Vec2> letter_u = {{0, 0}, {5, 0}, {5, 5}, {4, 5}, {4, 1}, {1, 1}, {1, 5}, {0, 5}};
  const std::vector<Vec2> straight = {{0, 0}, {1, 0}, {2, 0}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
  for (auto corners : {arrow, letter_u, straight}) {
    for (std::size_t start = 0; start < corners.size(); ++start) {
      std::rotate(corners.begin(), corners.begin() + 1, corners.end());
      expect_partition(outline(corners));
      expect_partition(outline(corners, tilted));
    }
    std::reverse(corners.begin(), corners.end());
    expect_partition(outline(corners));
  }
}

// Dart quads are the common case in artists' meshes: the diagonal must not leave the outline.
TEST(Triangulate, CutsAnyDartAtItsNotch) {
  for (int start = 0; start < 4; ++start) {
    std::vector<Vec2> dart = {{0, 0}, {4, 2}, {0, 4}, {1, 2}};
    std::rotate(dart.begin(), dart.begin() + start, dart.end());
    for (const Vec3i& t : triangulate(outline(dart, tilted)).triangles)
      EXPECT_TRUE((t.array() == (7 - start) % 4).any());
  }
}

TEST(Triangulate, PartitionsRandomStarShapes) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> radius(0.1, 1);
  for (int n = 4; n < 200; n += 3) {
    std::vector<Vec2> corners;
    for (int c = 0; c < n; ++c) {
      const double angle = 2 * std::numbers::pi * c / n, r = radius(random);
      corners.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
    expect_partition(outline(corners, tilted));
  }
}

TEST(Triangulate, CutsAFaceWithAHoleJoinedByASlit) {
  // A square with a square hole, as exporters write it: out to the hole, around, and back the same way.
  const std::vector<Vec2> corners = {{0, 0}, {6, 0}, {6, 6}, {0, 6}, {0, 0},
                                     {2, 2}, {2, 4}, {4, 4}, {4, 2}, {2, 2}};
  const Mesh mesh = outline(corners);
  double sum = 0;
  for (const Vec3i& t : triangulate(mesh).triangles) sum += area(mesh, t);
  EXPECT_NEAR(sum, 36 - 4, 1e-12);
}

TEST(Triangulate, GivesTheCountForDegeneratePolygons) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::vector<Vec2>> shapes = {
      {{0, 0}, {0, 0}, {0, 0}, {0, 0}},                      // a point
      {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {1.5, 0}},            // a line
      {{0, 0}, {2, 2}, {2, 0}, {0, 2}},                      // a bow tie
      {{0, 1}, {-.6, -.8}, {.9, .3}, {-.9, .3}, {.6, -.8}},  // a pentagram
      {{0, 0}, {nan, 0}, {1, 1}, {0, 1}, {1, 0}},            // not a number
      {{0, 0}, {1e300, 0}, {1e300, 1e300}, {0, 1e300}},      // products overflow
  };
  for (const auto& corners : shapes) {
    const Mesh mesh = outline(corners);
    const Triangulation cut = triangulate(mesh);
    ASSERT_EQ(cut.triangles.size(), corners.size() - 2);
    std::vector<int> used(corners.size());
    for (const Vec3i& t : cut.triangles)
      for (const int v : t) ++used[static_cast<std::size_t>(v)];
    for (const int uses : used) EXPECT_GT(uses, 0);
  }
}

TEST(Triangulate, HugePolygonsTakeNoQuadraticTime) {
  const int teeth = 20000;
  std::vector<Vec2> comb, spiral, line;
  for (int t = 0; t < teeth; ++t) {
    comb.push_back({t + 0.0, 0});
    comb.push_back({t + 0.5, 1 + 1e-3 * (t % 7)});
  }
  comb.push_back({teeth + 0.0, 0});
  comb.push_back({teeth / 2.0, -teeth / 4.0});
  std::reverse(comb.begin(), comb.end());
  for (int c = 0; c < teeth; ++c) {
    const double angle = 1e-3 * c;
    spiral.push_back({(10 + angle) * std::cos(angle), (10 + angle) * std::sin(angle)});
  }
  for (int c = teeth - 1; c >= 0; --c) spiral.push_back(spiral[static_cast<std::size_t>(c)] * 0.99);
  for (int c = 0; c < teeth; ++c) line.push_back({c % 1000 + 0.0, 0});
  const auto start = std::chrono::steady_clock::now();
  expect_partition(outline(comb));
  expect_partition(outline(spiral));
  EXPECT_EQ(triangulate(outline(line)).triangles.size(), line.size() - 2);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_LT(took.count(), 10) << "seconds";  // quadratic: minutes
}

TEST(CutMesh, KeepsFacesTextureAndGroups) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}};
  mesh.add_face(std::array{0, 1, 4, 3});
  mesh.add_face(std::array{1, 2, 5, 4});
  mesh.uvs = {{0, 0}, {0.5, 0}, {1, 0}, {0, 1}, {0.5, 1}, {1, 1}};
  mesh.corner_uvs = {0, 1, 4, 3, 1, 2, 5, 4};
  mesh.groups = {{"top", {}, {3, 4, 5}}, {"right", {1}, {1, 2, 4, 5}}};

  const MeshCut halves = cut(mesh, std::vector<std::array<int, 2>>{{1, 4}});
  EXPECT_EQ(halves.origins, (std::vector<int>{0, 1, 2, 3, 4, 5, 1, 4}));
  EXPECT_EQ(halves.mesh.face_vertices, (std::vector<int>{0, 1, 4, 3, 6, 2, 5, 7}));
  EXPECT_EQ(halves.mesh.version, 1);
  EXPECT_EQ(halves.mesh.corner_uvs, mesh.corner_uvs);
  ASSERT_EQ(halves.mesh.vertex_count(), 8u);
  EXPECT_EQ(halves.mesh.positions[6], mesh.positions[1]);
  EXPECT_EQ(halves.mesh.positions[7], mesh.positions[4]);
  EXPECT_EQ(halves.mesh.groups[0].vertices, (std::vector<int>{3, 4, 5, 7}));
  EXPECT_EQ(halves.mesh.groups[1].vertices, (std::vector<int>{1, 2, 4, 5, 6, 7}));
}

}  // namespace
}  // namespace muslin
