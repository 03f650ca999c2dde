#include "muslin/lattice/springs.hpp"

#include <map>
#include <set>

#include "lattice/shapes.hpp"
#include <gtest/gtest.h>

#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

Lattice lattice_of(const Mesh& mesh, double width) {
  return build_lattice(mesh, SignedDistance(mesh), {width});
}

using Counts = std::array<std::int64_t, 3>;
using Ends = std::pair<int, int>;

TEST(Springs, TheFlagHasTheCountsOfTheThesis) {
  const Lattice flag = lattice_of(shapes::box({0, 0, 0}, {10, 6, 1}), 1);
  EXPECT_EQ(build_springs(flag, Bracing::kuhn).count_by_kind, (Counts{349, 256, 60}));
  EXPECT_EQ(build_springs(flag, Bracing::full).count_by_kind, (Counts{349, 512, 240}));
  EXPECT_EQ(build_tetrahedra(flag).size(), 360u);
}

TEST(Springs, ALoneVoxel) {
  const Lattice cube = lattice_of(shapes::box({0, 0, 0}, {1, 1, 1}), 1);
  EXPECT_EQ(build_springs(cube, Bracing::kuhn).count_by_kind, (Counts{12, 6, 1}));
  EXPECT_EQ(build_springs(cube, Bracing::full).count_by_kind, (Counts{12, 12, 4}));
}

/// Springs voxel by voxel: (a,b) → number of voxels and sum of fill.
std::map<Ends, std::pair<int, double>> springs_by_voxel(const Lattice& lattice, Bracing bracing) {
  std::map<Ends, std::pair<int, double>> springs;
  for (std::size_t v = 0; v < lattice.voxel_count(); ++v) {
    for (int a = 0; a < 8; ++a) {
      for (int b = a + 1; b < 8; ++b) {
        const bool along_kuhn = (a & b) == a;
        if (bracing == Bracing::kuhn && !along_kuhn) continue;
        const int va = lattice.voxel_vertices[v][a], vb = lattice.voxel_vertices[v][b];
        auto& [count, fill] = springs[std::minmax(va, vb)];
        ++count;
        fill += lattice.fill[v];
      }
    }
  }
  return springs;
}

TEST(Springs, EverySpringOfEveryVoxelOnce) {
  const Mesh mesh = shapes::star(9, [](const Vec3& d) { return 1 + 0.5 * std::sin(6 * d.x() + 2 * d.y()); });
  const Lattice lattice = lattice_of(mesh, 0.19);
  for (const Bracing bracing : {Bracing::kuhn, Bracing::full}) {
    const Springs springs = build_springs(lattice, bracing);
    auto expected = springs_by_voxel(lattice, bracing);
    ASSERT_EQ(springs.count, static_cast<std::int64_t>(expected.size()));
    ASSERT_EQ(springs.share.size(), expected.size());
    ASSERT_EQ(springs.mean_fill.size(), expected.size());
    std::int64_t next = 0;
    std::pair<int, int> last{-1, -1};
    for (const SpringRun& run : springs.runs) {
      ASSERT_LT(last, std::pair(run.direction, run.a));
      last = {run.direction, run.a};
      ASSERT_EQ(run.first, next);
      next += run.length;
      const SpringDirection& direction = springs.directions[run.direction];
      const double solid = std::array{4.0, 2.0, 1.0}[static_cast<int>(direction.kind)];
      for (int i = 0; i < run.length; ++i) {
        ASSERT_EQ(lattice.vertices[run.b + i] - lattice.vertices[run.a + i], direction.offset);
        const auto found = expected.find(std::minmax(run.a + i, run.b + i));
        ASSERT_NE(found, expected.end());
        const auto [count, fill] = found->second;
        ASSERT_NEAR(springs.share[run.first + i], fill / solid, 1e-6);
        ASSERT_NEAR(springs.mean_fill[run.first + i], fill / count, 1e-6);
        expected.erase(found);
      }
    }
    EXPECT_TRUE(expected.empty());
    EXPECT_EQ(next, springs.count);
    // Rows stay whole: a run per direction and row, not per spring.
    EXPECT_LT(springs.runs.size(), springs.share.size() / 4);
  }
}

TEST(Springs, DirectionsStartWithTheKuhnSplit) {
  const auto kuhn = spring_directions(Bracing::kuhn), full = spring_directions(Bracing::full);
  ASSERT_EQ(kuhn.size(), 7u);
  ASSERT_EQ(full.size(), 13u);
  for (std::size_t d = 0; d < 7; ++d) EXPECT_EQ(kuhn[d].offset, full[d].offset);
}

TEST(Springs, SameBitsForAnyThreadCount) {
  const Lattice lattice = lattice_of(shapes::sphere(20), 0.09);
  set_thread_count(1);
  const Springs one = build_springs(lattice, Bracing::full);
  set_thread_count(2);
  const Springs two = build_springs(lattice, Bracing::full);
  set_thread_count(0);
  EXPECT_EQ(one.share, two.share);
  EXPECT_EQ(one.mean_fill, two.mean_fill);
  EXPECT_EQ(one.runs.size(), two.runs.size());
}

TEST(Tetrahedra, FillEveryVoxelAndConform) {
  const Lattice lattice = lattice_of(shapes::sphere(8), 0.3);
  const auto tetrahedra = build_tetrahedra(lattice);
  ASSERT_EQ(tetrahedra.size(), 6 * lattice.voxel_count());
  double volume = 0;
  std::map<std::array<int, 3>, int> faces;
  for (std::size_t t = 0; t < tetrahedra.size(); ++t) {
    std::array<Vec3, 4> x;
    for (int c = 0; c < 4; ++c) x[c] = lattice.vertices[tetrahedra[t][c]].cast<double>();
    const double six = (x[1] - x[0]).dot((x[2] - x[0]).cross(x[3] - x[0]));
    EXPECT_NEAR(six, 1, 1e-12);
    volume += six / 6;
    for (int skip = 0; skip < 4; ++skip) {
      std::array<int, 3> face;
      for (int c = 0, f = 0; c < 4; ++c)
        if (c != skip) face[f++] = tetrahedra[t][c];
      std::sort(face.begin(), face.end());
      ++faces[face];
    }
  }
  EXPECT_NEAR(volume, static_cast<double>(lattice.voxel_count()), 1e-9);
  // Faces used once are two per outer face of the voxels; all others are shared by two tetrahedra.
  std::size_t outer = 0, once = 0;
  for (const Vec3i& voxel : lattice.voxels)
    for (int side = 0; side < 6; ++side)
      outer += lattice.find_voxel(voxel + (side % 2 ? 1 : -1) * Vec3i::Unit(side / 2)) < 0;
  for (const auto& [face, count] : faces) {
    ASSERT_LE(count, 2);
    once += count == 1;
  }
  EXPECT_EQ(once, 2 * outer);
}

}  // namespace
}  // namespace muslin
