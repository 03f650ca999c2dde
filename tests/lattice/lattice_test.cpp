#include "muslin/lattice/lattice.hpp"

#include <chrono>
#include <numeric>
#include <set>

#include "lattice/shapes.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

Lattice lattice_of(const Mesh& mesh, double width, VoxelRule rule = VoxelRule::cover,
                   double threshold = 0.5) {
  return build_lattice(mesh, SignedDistance(mesh), {width, rule, threshold});
}

double filled_volume(const Lattice& lattice) {
  return std::accumulate(lattice.fill.begin(), lattice.fill.end(), 0.0) * std::pow(lattice.width, 3);
}

/// Textbook triangle–box overlap by separating axes; the box is centred at 0 with half edge `half`.
bool overlaps(const std::array<Vec3, 3>& triangle, double half) {
  std::vector<Vec3> axes = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ(),
                            (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0])};
  for (int e = 0; e < 3; ++e)
    for (int a = 0; a < 3; ++a) axes.push_back((triangle[(e + 1) % 3] - triangle[e]).cross(Vec3::Unit(a)));
  for (const Vec3& axis : axes) {
    const double reach = half * axis.cwiseAbs().sum();
    const double a = axis.dot(triangle[0]), b = axis.dot(triangle[1]), c = axis.dot(triangle[2]);
    if (std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach) return false;
  }
  return true;
}

/// The cover rule word by word, over the whole grid.
std::set<std::array<int, 3>> covering_voxels(const Mesh& mesh, const Lattice& grid) {
  const SignedDistance distance(mesh);
  const auto triangles = triangulate(mesh).triangles;
  std::set<std::array<int, 3>> kept;
  for (int j = 0; j < grid.extent.y(); ++j) {
    for (int k = 0; k < grid.extent.z(); ++k) {
      for (int i = 0; i < grid.extent.x(); ++i) {
        const Vec3 centre = grid.origin + grid.width * (Vec3(i, j, k) + Vec3::Constant(0.5));
        bool keep = distance.inside(centre);
        for (const Vec3i& t : triangles) {
          if (keep) break;
          std::array<Vec3, 3> local;
          for (int c = 0; c < 3; ++c) local[c] = (mesh.positions[t[c]] - centre) / grid.width;
          keep = overlaps(local, 0.5 - 1e-6);
        }
        if (keep) kept.insert({i, j, k});
      }
    }
  }
  return kept;
}

std::set<std::array<int, 3>> kept_voxels(const Lattice& lattice) {
  std::set<std::array<int, 3>> kept;
  for (const Vec3i& v : lattice.voxels) kept.insert({v.x(), v.y(), v.z()});
  return kept;
}

void expect_consistent(const Lattice& lattice) {
  const auto before = [](const Vec3i& a, const Vec3i& b) {
    return std::tuple(a.y(), a.z(), a.x()) < std::tuple(b.y(), b.z(), b.x());
  };
  ASSERT_EQ(lattice.fill.size(), lattice.voxel_count());
  ASSERT_EQ(lattice.voxel_vertices.size(), lattice.voxel_count());
  std::vector<char> used(lattice.vertex_count());
  for (std::size_t v = 0; v < lattice.voxel_count(); ++v) {
    ASSERT_TRUE(v == 0 || before(lattice.voxels[v - 1], lattice.voxels[v]));
    ASSERT_GE(lattice.fill[v], 1e-3);
    ASSERT_LE(lattice.fill[v], 1);
    for (int c = 0; c < 8; ++c) {
      const int vertex = lattice.voxel_vertices[v][c];
      ASSERT_EQ(lattice.vertices[vertex], lattice.voxels[v] + Vec3i(c & 1, c >> 1 & 1, c >> 2 & 1));
      used[vertex] = 1;
    }
    ASSERT_EQ(lattice.find_voxel(lattice.voxels[v]), static_cast<int>(v));
  }
  for (std::size_t v = 0; v < lattice.vertex_count(); ++v) {
    ASSERT_TRUE(v == 0 || before(lattice.vertices[v - 1], lattice.vertices[v]));
    ASSERT_TRUE(used[v]);
    ASSERT_EQ(lattice.find_vertex(lattice.vertices[v]), static_cast<int>(v));
  }
  EXPECT_EQ(lattice.find_voxel({-1, 0, 0}), -1);
  EXPECT_EQ(lattice.find_vertex(lattice.extent + Vec3i::Ones()), -1);
}

TEST(Lattice, FlagHasSixtyVoxelsForAnyThickness) {
  for (double thickness : {1.0, 0.3, 0.1, 1e-4}) {
    const Lattice lattice = lattice_of(shapes::box({0, 0, -thickness / 2}, {10, 6, thickness / 2}), 1);
    EXPECT_EQ(lattice.voxel_count(), 60u);
    EXPECT_EQ(lattice.vertex_count(), 154u);
    EXPECT_EQ(lattice.extent, Vec3i(10, 6, 1));
    EXPECT_NEAR(lattice.origin.z(), -0.5, 1e-12);
    EXPECT_EQ(lattice.coverage, 1);
    for (double fill : lattice.fill) EXPECT_NEAR(fill, std::max(thickness, 1e-3), 1e-9);
    expect_consistent(lattice);
  }
}

TEST(Lattice, BoxHasTheSameVoxelsAnywhere) {
  // Widths that no double holds exactly, far from the origin: rounding must not add a layer.
  for (const Vec3& low : {Vec3(0, 0, 0), Vec3(0.3, -17.7, 123.456), Vec3(-1000.1, 0.7, 0.1)}) {
    const Mesh mesh = shapes::box(low, low + Vec3(1.5, 0.9, 0.3));
    const Lattice lattice = lattice_of(mesh, 0.1);
    EXPECT_EQ(lattice.extent, Vec3i(15, 9, 3));
    EXPECT_EQ(lattice.voxel_count(), 15u * 9u * 3u);
    EXPECT_NEAR(filled_volume(lattice), 1.5 * 0.9 * 0.3, 1e-9);
    expect_consistent(lattice);
  }
}

TEST(Lattice, BoxesThatDoNotFitTheGridKeepTheirVolume) {
  const Lattice lattice = lattice_of(shapes::box({0, 0, 0}, {2.5, 1.25, 0.1}), 1);
  EXPECT_EQ(lattice.extent, Vec3i(3, 2, 1));
  EXPECT_NEAR(filled_volume(lattice), 2.5 * 1.25 * 0.1, 1e-9);
  EXPECT_NEAR(lattice.fill[lattice.find_voxel({0, 0, 0})], 0.75 * 0.625 * 0.1, 1e-9);
  EXPECT_NEAR(lattice.fill[lattice.find_voxel({1, 1, 0})], 1 * 0.625 * 0.1, 1e-9);
}

TEST(Lattice, CoverKeepsExactlyTheVoxelsTheSolidMeets) {
  const Mesh bump = shapes::star(9, [](const Vec3& d) { return 1 + 0.4 * std::sin(5 * d.x()) * d.y(); });
  Mesh steps = shapes::box({0, 0, 0}, {3, 1, 2});
  shapes::add_box(steps, {0, 1, 0}, {2, 2, 2});
  shapes::add_box(steps, {5, 0, 0}, {6, 1, 1});
  const std::vector<std::pair<Mesh, double>> cases = {
      {bump, 0.17},
      {shapes::moved(shapes::box({0, 0, 0}, {3, 0.05, 2}), shapes::some_rotation(), {1, 2, 3}), 0.2},
      {shapes::sphere(6), 0.3},
      {shapes::sphere(6, 0.3), 1},
      {steps, 1},
      {steps, 0.5}};
  for (const auto& [mesh, width] : cases) {
    const Lattice lattice = lattice_of(mesh, width);
    EXPECT_EQ(kept_voxels(lattice), covering_voxels(mesh, lattice));
    EXPECT_NEAR(filled_volume(lattice), shapes::volume(mesh), 2e-3 * shapes::volume(mesh));
    expect_consistent(lattice);
  }
}

TEST(Lattice, FillOfASphereIsItsVolume) {
  const Mesh mesh = shapes::sphere(40);
  const Lattice lattice = lattice_of(mesh, 0.13);
  EXPECT_NEAR(filled_volume(lattice), shapes::volume(mesh), 1e-3 * shapes::volume(mesh));
  // Against samples, voxel by voxel.
  const SignedDistance distance(mesh);
  for (std::size_t v = 0; v < lattice.voxel_count(); v += 37) {
    int inside = 0;
    constexpr int n = 8;
    for (int s = 0; s < n * n * n; ++s) {
      const Vec3 sample((s % n + 0.5) / n, (s / n % n + 0.5) / n, (s / n / n + 0.5) / n);
      inside += distance.inside(lattice.origin + lattice.width * (lattice.voxels[v].cast<double>() + sample));
    }
    EXPECT_NEAR(lattice.fill[v], static_cast<double>(inside) / (n * n * n), 0.04);
  }
}

TEST(Lattice, ACavityIsNotSolid) {
  Mesh mesh = shapes::box({0, 0, 0}, {5, 5, 5});
  const Mesh hole = shapes::box({1, 1, 1}, {4, 4, 4});
  const int first = static_cast<int>(mesh.vertex_count());
  mesh.positions.insert(mesh.positions.end(), hole.positions.begin(), hole.positions.end());
  for (std::size_t f = 0; f < hole.face_count(); ++f) {
    std::vector<int> face(hole.face(f).rbegin(), hole.face(f).rend());
    for (int& v : face) v += first;
    mesh.add_face(face);
  }
  const Lattice lattice = lattice_of(mesh, 1);
  EXPECT_EQ(lattice.voxel_count(), 125u - 27u);
  EXPECT_NEAR(filled_volume(lattice), 98, 1e-9);
}

TEST(Lattice, OverlappingBodiesAreNotCountedTwice) {
  Mesh mesh = shapes::box({0, 0, 0}, {3, 2, 2});
  shapes::add_box(mesh, {1.5, 0, 0}, {4.5, 2, 2});
  const Lattice lattice = lattice_of(mesh, 0.5);
  EXPECT_EQ(lattice.voxel_count(), 9u * 4u * 4u);
  EXPECT_NEAR(filled_volume(lattice), 4.5 * 2 * 2, 0.01);
}

TEST(Lattice, AMeshWithAHoleIsFilledUpToTheHole) {
  Mesh closed = shapes::box({0, 0, 0}, {6, 5, 4}), open;
  open.positions = closed.positions;
  for (std::size_t f = 0; f < closed.face_count(); ++f)
    if (f != 1) open.add_face(closed.face(f));
  const Lattice lattice = lattice_of(open, 0.5);
  EXPECT_EQ(lattice.voxel_count(), 12u * 10u * 8u);
  EXPECT_NEAR(filled_volume(lattice), 120, 0.5);
  expect_consistent(lattice);
}

TEST(Lattice, ThresholdIsStrictAndTiesAreOut) {
  // The outermost centres are half a width inside the faces.
  const Mesh mesh = shapes::box({0, 0, 0}, {4, 4, 4});
  EXPECT_EQ(lattice_of(mesh, 1, VoxelRule::threshold, 0.5).voxel_count(), 64u);
  EXPECT_EQ(lattice_of(mesh, 1, VoxelRule::threshold, -0.5).voxel_count(), 8u);
  EXPECT_EQ(lattice_of(mesh, 1, VoxelRule::threshold, -0.4).voxel_count(), 64u);
  EXPECT_EQ(lattice_of(mesh, 1, VoxelRule::threshold, -1.4).voxel_count(), 8u);
  // One layer more on the six sides, its edges and corners being farther than 0.6 widths.
  EXPECT_EQ(lattice_of(mesh, 1, VoxelRule::threshold, 0.6).voxel_count(), 64u + 6u * 16u);
  EXPECT_EQ(lattice_of(mesh, 1, VoxelRule::threshold, 0.9).voxel_count(), 216u);
  EXPECT_THROW(lattice_of(mesh, 1, VoxelRule::threshold, -1.5), Error);
}

TEST(Lattice, ThresholdAgreesWithTheFieldAtEveryCentre) {
  const Mesh mesh = shapes::moved(shapes::sphere(8), shapes::some_rotation(), {0.1, 0, 0});
  const SignedDistance distance(mesh);
  for (double threshold : {-0.8, 0.0, 0.3, 0.5, 1.2}) {
    const Lattice lattice = lattice_of(mesh, 0.21, VoxelRule::threshold, threshold);
    std::size_t count = 0;
    for (int j = 0; j < lattice.extent.y(); ++j) {
      for (int k = 0; k < lattice.extent.z(); ++k) {
        for (int i = 0; i < lattice.extent.x(); ++i) {
          const Vec3 centre = lattice.origin + lattice.width * (Vec3(i, j, k) + Vec3::Constant(0.5));
          const bool keep = distance(centre) < (threshold - 1e-6) * lattice.width;
          count += keep;
          EXPECT_EQ(lattice.find_voxel({i, j, k}) >= 0, keep);
        }
      }
    }
    EXPECT_EQ(lattice.voxel_count(), count);
  }
}

TEST(Lattice, CoverageIsTheShareOfTheAreaInKeptVoxels) {
  EXPECT_NEAR(lattice_of(shapes::box({0, 0, 0}, {4, 4, 4}), 1, VoxelRule::threshold).coverage, 1, 1e-12);
  // The centres of the two end voxels are 0.25 widths inside the ends, so only the middle one is kept.
  const Mesh mesh = shapes::box({0, 0, 0}, {2.5, 1, 1});
  const Lattice lattice = lattice_of(mesh, 1, VoxelRule::threshold, -0.3);
  EXPECT_EQ(lattice.voxel_count(), 1u);
  EXPECT_NEAR(lattice.coverage, 4.0 / (2 + 4 * 2.5), 1e-12);
}

TEST(Lattice, MemoryGrowsWithTheKeptVoxels) {
  // A diagonal rod a thousand voxels long: its bounding grid has 2e8 voxels.
  const Mesh rod = shapes::moved(
      shapes::box({0, -0.4, -0.4}, {1000, 0.4, 0.4}),
      Eigen::Quaterniond::FromTwoVectors(Vec3::UnitX(), Vec3(1, 1, 1)).toRotationMatrix(), Vec3::Zero());
  const Lattice lattice = lattice_of(rod, 1);
  EXPECT_GT(lattice.voxel_count(), 1700u);
  EXPECT_LT(lattice.voxel_count(), 6000u);
  EXPECT_GT(lattice.extent.minCoeff(), 570);
  EXPECT_NEAR(filled_volume(lattice), 640, 0.5);
}

TEST(Lattice, HopelessWidthIsRefusedAtOnce) {
  const Mesh mesh = shapes::sphere(8);
  const SignedDistance distance(mesh);
  for (double width : {1e-4, 1e-9, 1e-30, 5e-324}) {
    const auto start = std::chrono::steady_clock::now();
    try {
      build_lattice(mesh, distance, {width});
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      EXPECT_THAT(error.what(), testing::HasSubstr("use a larger voxel width"));
    }
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
  }
  for (double width : {0.0, -1.0, std::nan(""), HUGE_VAL})
    EXPECT_THROW(build_lattice(mesh, distance, {width}), Error);
}

TEST(Lattice, StopsWhenCancelled) {
  const Mesh mesh = shapes::sphere(8);
  const SignedDistance distance(mesh);
  double last = 0;
  const Progress progress{[&](double fraction, std::string_view) {
                            EXPECT_GE(fraction, last);
                            last = fraction;
                          },
                          {}};
  build_lattice(mesh, distance, {0.2}, progress);
  EXPECT_EQ(last, 1);
  const Progress stop{{}, [] { return true; }};
  EXPECT_THROW(build_lattice(mesh, distance, {0.2}, stop), Error);
}

TEST(Lattice, SameBitsForAnyThreadCount) {
  const Mesh mesh = shapes::sphere(20);
  set_thread_count(1);
  const Lattice one = lattice_of(mesh, 0.11);
  set_thread_count(2);
  const Lattice two = lattice_of(mesh, 0.11);
  set_thread_count(0);
  EXPECT_EQ(one.voxels, two.voxels);
  EXPECT_EQ(one.fill, two.fill);
  EXPECT_EQ(one.voxel_vertices, two.voxel_vertices);
}

}  // namespace
}  // namespace muslin
