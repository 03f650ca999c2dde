#include "muslin/geometry/orientation.hpp"

#include "geometry/shapes.hpp"
#include <gtest/gtest.h>

#include "muslin/geometry/winding_number.hpp"

namespace muslin {
namespace {

OrientedTriangles oriented(const Mesh& mesh) { return orient(mesh.positions, triangulate(mesh).triangles); }

double winding_at(const Mesh& mesh, const Vec3& p) {
  return WindingNumber(mesh.positions, oriented(mesh).triangles)(p);
}

const auto all = [](std::size_t) { return true; };
const auto none = [](std::size_t) { return false; };

TEST(Orient, DoesNotChangeAConsistentMesh) {
  const Mesh mesh = shapes::sphere(1, 2);
  const OrientedTriangles result = oriented(mesh);
  EXPECT_TRUE(result.watertight);
  EXPECT_EQ(result.triangles, triangulate(mesh).triangles);
}

TEST(Orient, FlipsAnInvertedMesh) {
  const Mesh mesh = shapes::selected(shapes::sphere(1, 2), all, all);
  EXPECT_NEAR(winding_at(mesh, Vec3(0.1, 0.2, 0)), 1, 5e-3);
}

TEST(Orient, RepairsRandomlyFlippedFaces) {
  const Mesh mesh = shapes::selected(shapes::sphere(1, 3), all, [](std::size_t f) { return f * 7 % 5 < 2; });
  const OrientedTriangles result = oriented(mesh);
  EXPECT_TRUE(result.watertight);
  EXPECT_NEAR(winding_at(mesh, Vec3(0.1, 0.2, 0)), 1, 5e-3);
}

TEST(Orient, KeepsACavityOfAnInvertedMesh) {
  const Mesh inner = shapes::selected(shapes::sphere(0.5, 2), all, all);
  const Mesh hollow = shapes::joined(shapes::sphere(1, 2), inner);
  const Mesh turned = shapes::selected(hollow, all, all);
  for (const Mesh& mesh : {hollow, turned}) {
    EXPECT_NEAR(winding_at(mesh, Vec3::Zero()), 0, 5e-3);
    EXPECT_NEAR(winding_at(mesh, Vec3(0.7, 0, 0)), 1, 5e-3);
  }
}

TEST(Orient, FlipsASeparateInvertedPart) {
  const Mesh other = shapes::selected(shapes::sphere(0.5, 2, Vec3(3, 0, 0)), all, all);
  const Mesh mesh = shapes::joined(shapes::sphere(1, 2), other);
  EXPECT_NEAR(winding_at(mesh, Vec3::Zero()), 1, 5e-3);
  EXPECT_NEAR(winding_at(mesh, Vec3(3, 0, 0)), 1, 5e-3);
}

TEST(Orient, JoinsVerticesSplitAtSeams) {
  Mesh split;  // every face with vertices of its own, every third one turned
  const Mesh whole = shapes::sphere(1, 2);
  for (std::size_t f = 0; f < whole.face_count(); ++f) {
    const int v = static_cast<int>(split.positions.size());
    for (const int w : whole.face(f)) split.positions.push_back(whole.positions[static_cast<std::size_t>(w)]);
    if (f % 3 == 0)
      split.add_face(std::array{v, v + 2, v + 1});
    else
      split.add_face(std::array{v, v + 1, v + 2});
  }
  EXPECT_TRUE(oriented(split).watertight);
  EXPECT_NEAR(winding_at(split, Vec3::Zero()), 1, 5e-3);
}

TEST(Orient, MeshWithAHoleIsNotWatertight) {
  EXPECT_FALSE(oriented(shapes::selected(
                            shapes::sphere(1, 2), [](std::size_t f) { return f != 5; }, none))
                   .watertight);
}

TEST(Patches, AMoebiusStripIsNotOrientable) {
  Mesh mesh;
  constexpr int n = 12;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * EIGEN_PI * i / n;
    for (const double s : {-0.3, 0.3}) {
      const double r = 1 + s * std::cos(a / 2);
      mesh.positions.emplace_back(r * std::cos(a), r * std::sin(a), s * std::sin(a / 2));
    }
  }
  for (int i = 0; i < n; ++i) {
    const int v = 2 * i, w = i + 1 < n ? v + 2 : 0;
    const bool last = i + 1 == n;
    mesh.add_face(std::array{v, v + 1, last ? w : w + 1, last ? w + 1 : w});
  }
  const Patches patches = find_patches(edge_uses(mesh), mesh.face_count());
  ASSERT_EQ(patches.orientable.size(), 1u);
  EXPECT_FALSE(patches.orientable[0]);
}

}  // namespace
}  // namespace muslin
