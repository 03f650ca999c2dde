// Cuts open what they should and nothing else.
#include "muslin/topology/topology.hpp"

#include <array>
#include <set>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/core/disjoint_sets.hpp"
#include "muslin/core/error.hpp"

namespace muslin {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Edges = std::vector<std::array<int, 2>>;

/// A grid of squares, `columns` by `rows`; vertex (i, j) is j (columns + 1) + i.
struct Grid {
  int columns, rows;
  int vertex(int i, int j) const { return j * (columns + 1) + i; }
  std::size_t vertex_count() const { return static_cast<std::size_t>((columns + 1) * (rows + 1)); }
  Topology topology() const {
    Topology t;
    t.face_offsets.push_back(0);
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        for (const int v : {vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)})
          t.face_vertices.push_back(v);
        t.face_offsets.push_back(static_cast<int>(t.face_vertices.size()));
      }
    }
    return t;
  }
  /// The edges along column line i between rows `from` and `to`.
  Edges line(int i, int from, int to) const {
    Edges edges;
    for (int j = from; j < to; ++j) edges.push_back({vertex(i, j), vertex(i, j + 1)});
    return edges;
  }
};

/// Number of sets of faces that edges join.
std::size_t pieces(const Topology& topology) {
  DisjointSets faces(topology.face_count());
  for_each_edge(edge_uses(topology), [&](std::span<const EdgeUse> edge) {
    for (const EdgeUse& use : edge) faces.join(edge[0].face, use.face);
  });
  std::set<int> roots;
  for (std::size_t f = 0; f < topology.face_count(); ++f) roots.insert(faces.find(static_cast<int>(f)));
  return roots.size();
}

TEST(Cut, ThroughAGridMakesTwoPieces) {
  const Grid grid{4, 3};
  const TopologyChange change = cut(grid.topology(), grid.vertex_count(), grid.line(2, 0, 3));
  EXPECT_EQ(pieces(change.topology), 2u);
  EXPECT_EQ(change.topology.version, 1);
  ASSERT_EQ(change.origins.size(), grid.vertex_count() + 4);
  EXPECT_THAT(std::vector<int>(change.origins.end() - 4, change.origins.end()),
              testing::UnorderedElementsAre(grid.vertex(2, 0), grid.vertex(2, 1), grid.vertex(2, 2),
                                            grid.vertex(2, 3)));
  // Faces keep their corners: each is where its origin was.
  const Topology before = grid.topology();
  EXPECT_EQ(change.topology.face_offsets, before.face_offsets);
  for (std::size_t c = 0; c < before.face_vertices.size(); ++c)
    EXPECT_EQ(change.origins[static_cast<std::size_t>(change.topology.face_vertices[c])],
              before.face_vertices[c]);
}

TEST(Cut, SlitDoublesVerticesUpToItsTip) {
  const Grid grid{4, 4};
  const TopologyChange change = cut(grid.topology(), grid.vertex_count(), grid.line(2, 0, 2));
  EXPECT_EQ(pieces(change.topology), 1u);
  EXPECT_THAT(std::vector<int>(change.origins.begin() + static_cast<std::ptrdiff_t>(grid.vertex_count()),
                               change.origins.end()),
              ElementsAre(grid.vertex(2, 0), grid.vertex(2, 1)));
}

TEST(Cut, OneInnerEdgeStaysClosed) {
  const Grid grid{4, 4};
  const TopologyChange change = cut(grid.topology(), grid.vertex_count(), grid.line(2, 1, 2));
  EXPECT_EQ(change.origins.size(), grid.vertex_count());
  EXPECT_EQ(change.topology.face_vertices, grid.topology().face_vertices);
}

TEST(Cut, CrossOfTwoLinesMakesFourPieces) {
  const Grid grid{4, 4};
  Edges edges = grid.line(2, 0, 4);
  for (int i = 0; i < 4; ++i) edges.push_back({grid.vertex(i, 2), grid.vertex(i + 1, 2)});
  const TopologyChange change = cut(grid.topology(), grid.vertex_count(), edges);
  EXPECT_EQ(pieces(change.topology), 4u);
  EXPECT_EQ(change.origins.size(), grid.vertex_count() + 8 + 3);  // the middle vertex is now four
}

TEST(Cut, OrderAndRepetitionOfEdgesDoNotMatter) {
  const Grid grid{4, 3};
  Edges edges = grid.line(2, 0, 3);
  const TopologyChange once = cut(grid.topology(), grid.vertex_count(), edges);
  Edges shuffled = {{edges[2][1], edges[2][0]}, edges[0], edges[2], edges[1], edges[0]};
  const TopologyChange twice = cut(grid.topology(), grid.vertex_count(), shuffled);
  EXPECT_EQ(once.topology.face_vertices, twice.topology.face_vertices);
  EXPECT_EQ(once.origins, twice.origins);
}

TEST(Cut, ThreeFacesAtOneEdgeSeparate) {
  Topology t;
  t.face_offsets = {0, 3, 6, 9};
  t.face_vertices = {0, 1, 2, 0, 1, 3, 1, 0, 4};
  const TopologyChange change = cut(t, 5, Edges{{0, 1}});
  EXPECT_EQ(pieces(change.topology), 3u);
  EXPECT_THAT(change.origins, ElementsAre(0, 1, 2, 3, 4, 0, 1, 1, 0));
}

TEST(Cut, RefusesPairsThatAreNotEdges) {
  const Grid grid{4, 3};
  const auto complaint = [&](Edges edges) -> std::string {
    try {
      cut(grid.topology(), grid.vertex_count(), edges);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(complaint({{0, 6}}), HasSubstr("vertices 0 and 6 share no edge"));  // a diagonal
  EXPECT_THAT(complaint({{0, 0}}), HasSubstr("vertices 0 and 0 share no edge"));
  EXPECT_THAT(complaint({{-1, 900}}), HasSubstr("vertices -1 and 900 share no edge"));
}

}  // namespace
}  // namespace muslin
