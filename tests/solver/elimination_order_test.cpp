// The order of elimination: every coupling once, seen from both of its ends, nothing read before it is known
// and nothing shared by tasks that run side by side.
#include "muslin/solver/elimination_order.hpp"

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <tuple>

#include "support/lattice_box.hpp"
#include <gtest/gtest.h>

namespace muslin {
namespace {

constexpr int lanes = EliminationOrder::lanes;

std::vector<CouplingRun> runs_of(const Springs& springs) {
  std::vector<CouplingRun> runs;
  for (const SpringRun& run : springs.runs) runs.push_back({run.direction, run.a, run.b, run.length});
  return runs;
}

/// A box with voxels missing at random.
Lattice riddled_box(const Vec3i& extent, double kept) {
  Lattice lattice = test::box_lattice(extent);
  std::mt19937 random(5);
  std::vector<std::array<int, 8>> voxels;
  for (const auto& corners : lattice.voxel_vertices)
    if (static_cast<double>(random()) < kept * 4294967296.0) voxels.push_back(corners);
  std::vector<int> number(lattice.vertex_count(), -1);
  for (const auto& corners : voxels)
    for (const int v : corners) number[static_cast<std::size_t>(v)] = 0;
  Lattice result;
  result.extent = extent;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] < 0) continue;
    number[v] = static_cast<int>(result.vertices.size());
    result.vertices.push_back(lattice.vertices[v]);
  }
  for (auto corners : voxels) {
    result.voxels.push_back(lattice.vertices[static_cast<std::size_t>(corners[0])]);
    result.fill.push_back(1);
    for (int& v : corners) v = number[static_cast<std::size_t>(v)];
    result.voxel_vertices.push_back(corners);
  }
  return result;
}

using Coupling = std::tuple<int, int, int>;  // lower vertex, higher vertex, kind

std::multiset<Coupling> couplings_of(const std::vector<CouplingRun>& runs) {
  std::multiset<Coupling> all;
  for (const CouplingRun& run : runs)
    for (int i = 0; i < run.length; ++i)
      all.insert({std::min(run.a, run.b) + i, std::max(run.a, run.b) + i, run.kind});
  return all;
}

void expect_sound(const std::vector<CouplingRun>& runs, int vertex_count) {
  std::vector<std::int64_t> order;
  const EliminationOrder pattern(runs, vertex_count, &order);
  ASSERT_EQ(pattern.vertex_count(), vertex_count);
  ASSERT_EQ(order.size(), pattern.block_count() * lanes);

  // Positions and vertices are one to one, and every vertex is in a group of one task.
  std::vector<int> task_of(pattern.groups().size(), -1), phase_of(pattern.tasks().size());
  for (std::size_t p = 0; p + 1 < pattern.phases().size(); ++p)
    for (int t = pattern.phases()[p]; t < pattern.phases()[p + 1]; ++t)
      phase_of[static_cast<std::size_t>(t)] = static_cast<int>(p);
  for (std::size_t t = 0; t < pattern.tasks().size(); ++t)
    for (int g = pattern.tasks()[t].group_begin; g < pattern.tasks()[t].group_end; ++g) {
      ASSERT_EQ(task_of[static_cast<std::size_t>(g)], -1);
      task_of[static_cast<std::size_t>(g)] = static_cast<int>(t);
    }
  int vertices = 0;
  for (std::size_t i = 0; i < pattern.position_count(); ++i) {
    if (pattern.vertex(i) < 0) continue;
    ++vertices;
    ASSERT_EQ(pattern.position(static_cast<std::size_t>(pattern.vertex(i))), static_cast<int>(i));
    ASSERT_GE(task_of[i / lanes], 0);
  }
  ASSERT_EQ(vertices, vertex_count);

  std::vector<Coupling> flat;
  for (const CouplingRun& run : runs)
    for (int i = 0; i < run.length; ++i)
      flat.emplace_back(std::min(run.a, run.b) + i, std::max(run.a, run.b) + i, run.kind);
  std::multiset<Coupling> from_blocks, from_links;
  const auto coupling = [&](int p, int q, int kind) {
    const int u = pattern.vertex(static_cast<std::size_t>(p)),
              v = pattern.vertex(static_cast<std::size_t>(q));
    return Coupling(std::min(u, v), std::max(u, v), kind);
  };
  for (std::size_t g = 0; g < pattern.groups().size(); ++g) {
    const EliminationOrder::Group& group = pattern.groups()[g];
    for (int b = group.block_begin; b < group.block_end; ++b) {
      const EliminationOrder::Block& block = pattern.blocks()[static_cast<std::size_t>(b)];
      ASSERT_EQ(block.group, static_cast<int>(g));
      for (int l = 0; l < lanes; ++l) {
        const int earlier = l + (l < block.cut ? block.first : block.second);
        ASSERT_GE(earlier - l, 0);
        ASSERT_LE(static_cast<std::size_t>(earlier - l + lanes), pattern.position_count());
        const std::int64_t index = order[static_cast<std::size_t>(b * lanes + l)];
        ASSERT_EQ(index >= 0, (block.used >> l & 1) != 0);
        if (index < 0) continue;
        const Coupling c = coupling(earlier, static_cast<int>(g) * lanes + l, block.kind);
        ASSERT_EQ(c, flat[static_cast<std::size_t>(index)]);
        from_blocks.insert(c);
        // Known before: in an earlier group of the same task, or in an earlier phase.
        const int from = task_of[static_cast<std::size_t>(earlier / lanes)], to = task_of[g];
        if (from == to) {
          ASSERT_LT(earlier / lanes, static_cast<int>(g));
        } else {
          ASSERT_LT(phase_of[static_cast<std::size_t>(from)], phase_of[static_cast<std::size_t>(to)]);
        }
      }
    }
    for (int k = group.link_begin; k < group.link_end; ++k) {
      const EliminationOrder::Link& link = pattern.links()[static_cast<std::size_t>(k)];
      ASSERT_EQ(link.used[0] & link.used[1], 0);
      ASSERT_NE(link.used[0], 0);
      for (std::size_t h = 0; h < 2; ++h) {
        for (int l = 0; l < lanes; ++l) {
          if ((link.used[h] >> l & 1) == 0) continue;
          const EliminationOrder::Block& block = pattern.blocks()[static_cast<std::size_t>(link.block[h])];
          const int lane = l + link.shift[h];
          ASSERT_NE(block.used >> lane & 1, 0);
          const int earlier = lane + (lane < block.cut ? block.first : block.second);
          ASSERT_EQ(earlier, static_cast<int>(g) * lanes + l);
          ASSERT_EQ(l + link.position[h], block.group * lanes + lane);
          from_links.insert(coupling(earlier, l + link.position[h], block.kind));
        }
      }
    }
  }
  const std::multiset<Coupling> expected = couplings_of(runs);
  EXPECT_TRUE(from_blocks == expected);
  EXPECT_TRUE(from_links == expected);
}

TEST(EliminationOrder, HoldsEveryCouplingOfALatticeOnceFromBothEnds) {
  for (const Bracing bracing : {Bracing::kuhn, Bracing::full}) {
    for (const Vec3i& extent : {Vec3i(1, 1, 1), Vec3i(10, 6, 1), Vec3i(100, 60, 1), Vec3i(1, 90, 80),
                                Vec3i(5, 400, 1), Vec3i(24, 21, 22)}) {
      const Lattice lattice = test::box_lattice(extent);
      expect_sound(runs_of(build_springs(lattice, bracing)), static_cast<int>(lattice.vertex_count()));
    }
    const Lattice lattice = riddled_box({40, 40, 12}, 0.5);
    expect_sound(runs_of(build_springs(lattice, bracing)), static_cast<int>(lattice.vertex_count()));
  }
}

TEST(EliminationOrder, HoldsCouplingsOfAnyGraph) {
  std::mt19937 random(3);
  std::vector<CouplingRun> runs;
  const int vertices = 500;
  for (int i = 0; i < 3000; ++i) {
    const int a = static_cast<int>(random() % vertices), b = static_cast<int>(random() % vertices);
    if (a != b) runs.push_back({static_cast<int>(random() % 3), a, b, 1});
  }
  expect_sound(runs, vertices);
}

TEST(EliminationOrder, HandlesNoCouplingsAndNoVertices) {
  expect_sound({}, 0);
  expect_sound({}, 1);
  expect_sound({}, 20000);
  expect_sound({{0, 3, 7, 2}}, 10);
}

TEST(EliminationOrder, DividesLargeBodiesIntoParallelTasks) {
  const Lattice lattice = test::box_lattice({100, 60, 1});
  const EliminationOrder pattern(runs_of(build_springs(lattice, Bracing::kuhn)),
                                 static_cast<int>(lattice.vertex_count()));
  int most = 0;
  for (std::size_t p = 0; p + 1 < pattern.phases().size(); ++p)
    most = std::max(most, pattern.phases()[p + 1] - pattern.phases()[p]);
  EXPECT_EQ(most, 2);
}

TEST(EliminationOrder, AGroupIsNearlyFullInsideALattice) {
  const auto fill = [](const Vec3i& extent) {
    const Lattice lattice = test::box_lattice(extent);
    const Springs springs = build_springs(lattice, Bracing::kuhn);
    const EliminationOrder pattern(runs_of(springs), static_cast<int>(lattice.vertex_count()));
    return static_cast<double>(springs.count) / static_cast<double>(lanes * pattern.block_count());
  };
  EXPECT_GE(fill({400, 240, 1}), 0.78);
  EXPECT_GE(fill({100, 60, 1}), 0.5);
  EXPECT_GE(fill({40, 40, 40}), 0.78);
}

}  // namespace
}  // namespace muslin
