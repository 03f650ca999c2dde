#include "muslin/surface/edge_stretch.hpp"

#include <gtest/gtest.h>

namespace muslin {
namespace {

Mesh two_squares() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}};
  mesh.face_offsets = {0, 4, 8};
  mesh.face_vertices = {0, 1, 4, 3, 1, 2, 5, 4};
  return mesh;
}

TEST(EdgeStretch, CountsEveryEdgeOnce) {
  const EdgeStretch stretch(two_squares());
  EXPECT_EQ(stretch.edges().size(), 7u);
  for (const EdgeStretch::Edge& edge : stretch.edges()) {
    EXPECT_LT(edge.ends[0], edge.ends[1]);
    EXPECT_EQ(edge.rest_length, 1);
  }
}

TEST(EdgeStretch, IsTheLargestOfAVertexAndNotNegative) {
  const Mesh mesh = two_squares();
  const EdgeStretch stretch(mesh);
  std::vector<Vec3> moved = mesh.positions;
  for (Vec3& p : moved) p.y() *= 0.5;  // compression counts as none
  EXPECT_EQ(stretch.at(moved), std::vector<double>(6, 0.0));
  moved = mesh.positions;
  for (const std::size_t right : {2u, 5u}) moved[right].x() = 2.25;
  const std::vector<double> percent = stretch.at(moved);
  const std::vector<double> expected = {0, 25, 25, 0, 25, 25};
  for (std::size_t v = 0; v < 6; ++v) EXPECT_NEAR(percent[v], expected[v], 1e-12) << v;
}

}  // namespace
}  // namespace muslin
