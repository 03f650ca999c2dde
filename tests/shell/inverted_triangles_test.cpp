// Triangles that are turned over in a rest shape.
#include "muslin/shell/inverted_triangles.hpp"

#include "support/sheet.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace muslin {
namespace {

using testing::IsEmpty;

/// The triangles whose normal does not point along +y.
std::vector<int> downward(std::span<const Vec3i> triangles, ConstVectors x) {
  std::vector<int> list;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto at = [&](int c) { return x[static_cast<std::size_t>(triangles[t][c])]; };
    if ((at(1) - at(0)).cross(at(2) - at(0)).y() < 0) list.push_back(static_cast<int>(t));
  }
  return list;
}

TEST(InvertedTriangles, AreThoseThatAVertexTurnsOver) {
  Mesh mesh = test::flat_sheet(6, 6, 6, 6);
  const std::vector<Vec3i> triangles = triangulate(mesh).triangles;
  EXPECT_THAT(inverted_triangles(triangles, mesh.positions), IsEmpty());
  for (const double moved : {1.3, 1.6}) {
    mesh.positions[24].x() = 3 + moved;  // the vertex in the middle passes that beside it
    mesh.positions[24].z() = 3.2;
    const std::vector<int> turned = downward(triangles, mesh.positions);
    ASSERT_FALSE(turned.empty());
    EXPECT_EQ(inverted_triangles(triangles, mesh.positions), turned) << moved;
  }
}

TEST(InvertedTriangles, AreNotPartsOfFoldsThatAreMeant) {
  const Mesh mesh = test::flat_sheet(4, 2, 1, 0.5);
  std::vector<Vec3> folded = mesh.positions;
  for (Vec3& x : folded)
    if (x.x() > 0.5) x.x() = 1 - x.x();
  EXPECT_THAT(inverted_triangles(triangulate(mesh).triangles, folded), IsEmpty());
}

}  // namespace
}  // namespace muslin
