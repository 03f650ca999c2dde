#include "muslin/surface/contour.hpp"

#include <map>
#include <numbers>
#include <random>

#include "lattice/shapes.hpp"
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

struct Built {
  Lattice lattice;
  Contour contour;
};

Built build(const Mesh& mesh, double width, ContourMethod method, VoxelRule rule = VoxelRule::cover) {
  const SignedDistance distance(mesh);
  Built built;
  built.lattice = build_lattice(mesh, distance, {width, rule, 0});
  built.contour = build_contour(built.lattice, mesh, distance, method);
  return built;
}

/// Every edge exactly once in either direction, every vertex one fan, no triangle without area.
void expect_manifold(const Mesh& mesh) {
  std::map<std::pair<int, int>, int> next;  // around vertex `first`: from one neighbour to the one after it
  std::vector<int> degree(mesh.vertex_count(), 0);
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    ASSERT_EQ(face.size(), 3u);
    for (int c = 0; c < 3; ++c) {
      const int v = face[c], after = face[(c + 1) % 3], before = face[(c + 2) % 3];
      ASSERT_TRUE(next.emplace(std::pair(v, after), before).second) << "an edge is run twice";
      ++degree[v];
    }
    const Vec3 &a = mesh.positions[face[0]], &b = mesh.positions[face[1]], &c = mesh.positions[face[2]];
    ASSERT_GT((b - a).cross(c - a).norm(), 0);
  }
  for (const auto& [edge, other] : next)
    ASSERT_TRUE(next.contains({edge.second, edge.first})) << "an open edge";
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    ASSERT_GT(degree[v], 0);
    const int vertex = static_cast<int>(v), first = next.lower_bound({vertex, 0})->first.second;
    int at = first, steps = 0;
    do {
      at = next.at({vertex, at});
      ++steps;
    } while (at != first);
    ASSERT_EQ(steps, degree[v]) << "two fans meet in a vertex";
  }
}

void expect_carried(const Built& built) {
  std::vector<Vec3> rest(built.lattice.vertex_count()), points(built.contour.mesh.vertex_count());
  for (std::size_t v = 0; v < rest.size(); ++v) rest[v] = built.lattice.rest_position(v);
  built.contour.embedding.apply(rest, points);
  for (std::size_t p = 0; p < points.size(); ++p)
    ASSERT_LT((points[p] - built.contour.mesh.positions[p]).norm(), 1e-12);
}

TEST(MarchingCubes, ASphereIsASphere) {
  const Mesh mesh = shapes::sphere(60);
  const Built built = build(mesh, 0.1, ContourMethod::cubes);
  const SignedDistance distance(mesh);
  expect_manifold(built.contour.mesh);
  expect_carried(built);
  for (const Vec3& p : built.contour.mesh.positions) ASSERT_LT(distance.distance(p), 1e-4);
  EXPECT_NEAR(shapes::volume(built.contour.mesh), shapes::volume(mesh), 0.01 * shapes::volume(mesh));
  EXPECT_GT(built.contour.distance, 0);
  EXPECT_LT(built.contour.distance, 0.2 * 0.1);
  const auto edges = 3 * built.contour.mesh.face_count() / 2;
  EXPECT_EQ(built.contour.mesh.vertex_count() + built.contour.mesh.face_count() - edges, 2u);
}

TEST(MarchingCubes, ABoxOnTheLatticesBoundaryIsItself) {
  const Mesh mesh = shapes::box({0, 0, 0}, {4, 3, 2});
  const Built built = build(mesh, 1, ContourMethod::cubes);
  expect_manifold(built.contour.mesh);
  expect_carried(built);
  EXPECT_NEAR(shapes::volume(built.contour.mesh), 24, 1e-12);
  EXPECT_NEAR(built.contour.distance, 0, 1e-12);
}

TEST(MarchingCubes, ClosedOnRandomSetsOfVoxels) {
  // Random boxes of one voxel: they meet in faces, edges and corners in every way there is.
  std::mt19937 random(7);
  for (int round = 0; round < 30; ++round) {
    Mesh mesh = shapes::box({0, 0, 0}, {1, 1, 1});
    shapes::add_box(mesh, {5, 5, 5}, {6, 6, 6});
    int count = 2;
    for (int v = 0; v < 125; ++v) {
      if (random() % 100 >= 40) continue;
      const Vec3 low(v % 5, v / 5 % 5, v / 25);
      if (low.norm() == 0) continue;
      shapes::add_box(mesh, low, low + Vec3::Ones());
      ++count;
    }
    const Built built = build(mesh, 1, ContourMethod::cubes);
    ASSERT_EQ(built.lattice.voxel_count(), static_cast<std::size_t>(count));
    expect_manifold(built.contour.mesh);
    expect_carried(built);
    EXPECT_NEAR(shapes::volume(built.contour.mesh), count, 1e-9);
  }
}

TEST(MarchingCubes, ClosedOnRandomShapesInLatticesTooSmallForThem) {
  // Threshold 0 keeps too few voxels, so that the shape is cut off at the lattice's faces.
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int round = 0; round < 8; ++round) {
    const Vec3 a(uniform(random), uniform(random), uniform(random));
    const Mesh mesh =
        shapes::star(12, [&](const Vec3& d) { return 1 + 0.6 * std::sin(9 * d.dot(a) + 3 * d.x()); });
    for (const VoxelRule rule : {VoxelRule::cover, VoxelRule::threshold}) {
      const Built built = build(mesh, 0.21, ContourMethod::cubes, rule);
      expect_manifold(built.contour.mesh);
      expect_carried(built);
      EXPECT_GT(shapes::volume(built.contour.mesh), 0);
    }
  }
}

TEST(MarchingCubes, WallThinnerThanAVoxelIsLostAndReported) {
  const Built built = build(shapes::box({0, 0, 0}, {4, 3, 0.1}), 1, ContourMethod::cubes);
  EXPECT_EQ(built.contour.mesh.face_count(), 0u);
  EXPECT_GT(built.contour.distance, 1);
}

TEST(MarchingCubes, SameBitsForAnyThreadCount) {
  const Mesh mesh = shapes::sphere(20);
  set_thread_count(1);
  const Built one = build(mesh, 0.13, ContourMethod::cubes);
  set_thread_count(2);
  const Built two = build(mesh, 0.13, ContourMethod::cubes);
  set_thread_count(0);
  EXPECT_EQ(one.contour.mesh.positions, two.contour.mesh.positions);
  EXPECT_EQ(one.contour.mesh.face_vertices, two.contour.mesh.face_vertices);
  EXPECT_EQ(one.contour.distance, two.contour.distance);
}

TEST(MarchingSquares, AFlatRectangleIsItsBox) {
  for (double thickness : {0.1, 1.0}) {
    const Built built =
        build(shapes::box({0, 0, -thickness / 2}, {10, 6, thickness / 2}), 1, ContourMethod::squares);
    expect_manifold(built.contour.mesh);
    expect_carried(built);
    EXPECT_NEAR(shapes::volume(built.contour.mesh), 60 * thickness, 1e-9);
    EXPECT_NEAR(built.contour.distance, 0, 1e-12);
  }
}

TEST(MarchingSquares, AnyAxisMayBeTheThinOne) {
  for (int thin = 0; thin < 3; ++thin) {
    Vec3 high(4, 4, 4);
    high[thin] = 0.2;
    high[(thin + 1) % 3] = 7;
    const Built built = build(shapes::box({0, 0, 0}, high), 1, ContourMethod::squares);
    expect_manifold(built.contour.mesh);
    EXPECT_NEAR(shapes::volume(built.contour.mesh), high.prod(), 1e-9);
    EXPECT_NEAR(built.contour.distance, 0, 1e-12);
  }
}

/// A leaf with two pointed tips: |y| = sin(πx/4)·(1.2 − 0.1x), 0 ≤ x ≤ 4.
double leaf_width(double x) { return std::sin(std::numbers::pi * x / 4) * (1.2 - 0.1 * x); }

Mesh leaf(double thickness) {
  std::vector<Vec2> outline;
  constexpr int n = 200;
  for (int i = 0; i < n; ++i) outline.push_back({4.0 * i / n, -leaf_width(4.0 * i / n)});
  for (int i = n; i > 0; --i) outline.push_back({4.0 * i / n, leaf_width(4.0 * i / n)});
  return shapes::prism(outline, thickness);
}

TEST(MarchingSquares, ALeafKeepsItsShape) {
  const double width = 0.1;
  for (double thickness : {0.004, 0.02}) {
    const Mesh mesh = leaf(thickness);
    const Built built = build(mesh, width, ContourMethod::squares);
    expect_manifold(built.contour.mesh);
    expect_carried(built);
    EXPECT_NEAR(shapes::volume(built.contour.mesh), shapes::volume(mesh), 0.005 * shapes::volume(mesh));
    // Every vertex of the contour lies on the leaf's outline or on its two faces, and between vertices the
    // contour is no farther away than a chord is from its arc.
    const SignedDistance distance(mesh), back(built.contour.mesh);
    for (const Vec3& p : built.contour.mesh.positions) ASSERT_LT(distance.distance(p), 1e-3 * width);
    for (const Vec3& p : mesh.positions) {
      if (p.x() <= 2 * width || p.x() >= 4 - 2 * width) continue;
      ASSERT_LT(back.distance(p), 0.05 * width) << p.transpose();
    }
    EXPECT_LT(built.contour.distance, 1.5 * width);  // the tips
  }
}

TEST(MarchingSquares, ClosedOnRandomFlatSetsOfVoxels) {
  std::mt19937 random(5);
  for (int round = 0; round < 30; ++round) {
    Mesh mesh;
    int count = 0;
    for (int v = 0; v < 81; ++v) {
      if (v != 0 && v != 80 && random() % 2 == 0) continue;
      const Vec3 low(v % 9, v / 9, 0);
      shapes::add_box(mesh, low, low + Vec3(1, 1, 0.3));
      ++count;
    }
    const Built built = build(mesh, 1, ContourMethod::squares);
    ASSERT_EQ(built.lattice.voxel_count(), static_cast<std::size_t>(count));
    expect_manifold(built.contour.mesh);
    expect_carried(built);
    EXPECT_NEAR(shapes::volume(built.contour.mesh), 0.3 * count, 1e-9);
  }
}

TEST(MarchingSquares, ThickLatticesAreRefused) {
  EXPECT_THROW(build(shapes::box({0, 0, 0}, {3, 3, 3}), 1, ContourMethod::squares), Error);
}

}  // namespace
}  // namespace muslin
