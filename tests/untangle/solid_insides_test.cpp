// Points inside solids know the nearest way out.
#include "muslin/untangle/solid_insides.hpp"

#include <algorithm>
#include <functional>

#include "support/tangles.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/contact/contact_model.hpp"

namespace muslin {
namespace {

using test::TangledScene;

TEST(SolidInsides, AreThePointsInsideWithTheNearestWayOut) {
  TangledScene scene;
  scene.sheet("cloth", 0.4, 20, [](double, double) { return 0.095; });
  scene.add("[[collider]]\nname = 'box'\nshape = 'box'\ncenter = [0, 0, 0]\nsize = [0.21, 0.2, 0.21]\n");
  const auto model = scene.build();
  const ContactModel& contact = *model->contact;
  std::vector<Vec3> x(contact.surface->point_count());
  contact.map->apply(model->rest_positions, x);
  const SurfacePieces pieces(*contact.surface, x);
  ASSERT_EQ(pieces.count(), 2);
  EXPECT_FALSE(pieces.is_solid(0));
  EXPECT_TRUE(pieces.is_solid(1));
  const std::vector<LostPoint> lost =
      find_solid_insides(*contact.surface, pieces, x, std::vector<std::array<int, 2>>{{0, 801}});
  EXPECT_EQ(lost.size(), 11U * 11U);  // |x|, |z| ≤ 0.1
  for (const LostPoint& l : lost) {
    EXPECT_EQ(l.piece, 1);
    EXPECT_NEAR(l.depth, 0.005, 1e-12);
    const Vec3 out = l.out;
    EXPECT_NEAR(std::max({out.y(), std::abs(out.x()), std::abs(out.z())}), 1, 1e-12);
  }
}

/// The twelve triangles of a box, turned outward, on eight points that `corner` numbers: bit i of its
/// argument is set on the upper side of axis i.
void add_box(std::vector<Vec3i>& triangles, const std::function<int(int)>& corner) {
  for (int axis = 0; axis < 3; ++axis) {
    const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3;
    for (const int side : {0, 1 << axis}) {
      const int a = corner(side), b = corner(side + u), c = corner(side + u + v), d = corner(side + v);
      const bool upper = side != 0;
      triangles.push_back(upper ? Vec3i(a, b, c) : Vec3i(a, c, b));
      triangles.push_back(upper ? Vec3i(a, c, d) : Vec3i(a, d, c));
    }
  }
}

TEST(SolidInsides, AreFoundWhereBoxesShareAnEdge) {
  // Two unit cubes touch in the edge x = y = 1: four triangles meet in it. Cloth passes through the second.
  const auto place = [](int c) { return Vec3(c & 1, c >> 1 & 1, c >> 2 & 1); };
  std::vector<Vec3> x;
  for (int c = 0; c < 8; ++c) x.push_back(place(c));
  std::vector<int> second(8);
  for (int c = 0; c < 8; ++c) {
    const bool shared = (c & 3) == 0;
    second[static_cast<std::size_t>(c)] = shared ? (c | 3) : static_cast<int>(x.size());
    if (!shared) x.push_back(place(c) + Vec3(1, 1, 0));
  }
  std::vector<Vec3i> triangles;
  add_box(triangles, [](int c) { return c; });
  add_box(triangles, [&](int c) { return second[static_cast<std::size_t>(c)]; });
  const std::size_t points_of_solid = x.size();
  x.insert(x.end(), {Vec3(1.9, 1.5, 0.5), Vec3(1.9, 1.6, 0.5), Vec3(3, 1.5, 0.5)});
  const int cloth = static_cast<int>(points_of_solid);
  triangles.emplace_back(cloth, cloth + 1, cloth + 2);
  std::vector<int> body_of_point(x.size(), 0);
  std::fill(body_of_point.begin() + cloth, body_of_point.end(), 1);
  ContactBody solid;
  solid.solid = true;

  const auto insides = [&](const std::vector<Vec3i>& faces) {
    const ContactSurface surface(faces, body_of_point, {solid, ContactBody()});
    const SurfacePieces pieces(surface, x);
    EXPECT_EQ(pieces.count(), 2);
    const auto last = static_cast<int>(faces.size()) - 1;
    return find_solid_insides(surface, pieces, x, std::vector<std::array<int, 2>>{{12, last}});
  };
  const std::vector<LostPoint> lost = insides(triangles);
  ASSERT_EQ(lost.size(), 2U);
  for (const LostPoint& l : lost) {
    EXPECT_NEAR(l.depth, 0.1, 1e-12);
    EXPECT_NEAR((l.out - Vec3(1, 0, 0)).norm(), 0, 1e-12);
  }
  // Without one of its triangles, or with one that is turned over, the piece has no inside.
  std::vector<Vec3i> open = triangles;
  open.erase(open.begin() + 3);
  EXPECT_TRUE(insides(open).empty());
  std::swap(triangles[3][0], triangles[3][1]);
  EXPECT_TRUE(insides(triangles).empty());
}

}  // namespace
}  // namespace muslin
