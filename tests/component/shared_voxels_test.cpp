// Parts of a mesh that share voxels though they are apart are told; parts of one solid are not.
#include "muslin/component/lattice/shared_voxels.hpp"

#include <algorithm>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/geometry/shapes.hpp"
#include "muslin/scene/model.hpp"

namespace muslin {
namespace {

using testing::HasSubstr;

void append(Mesh& mesh, const Mesh& part, bool inward = false) {
  const int first = static_cast<int>(mesh.vertex_count());
  mesh.positions.insert(mesh.positions.end(), part.positions.begin(), part.positions.end());
  for (std::size_t f = 0; f < part.face_count(); ++f) {
    std::vector<int> face;
    for (const int v : part.face(f)) face.push_back(first + v);
    if (inward) std::reverse(face.begin(), face.end());
    mesh.add_face(face);
  }
}

Mesh box_and(const Mesh& other, bool inward = false) {
  Mesh mesh = box_mesh(Vec3::Zero(), Vec3::Constant(0.1));
  append(mesh, other, inward);
  return mesh;
}

std::optional<SharedVoxels> found(const Mesh& mesh) {
  return find_shared_voxels(mesh, build_lattice(mesh, SignedDistance(mesh), {0.02}));
}

TEST(SharedVoxels, OfBoxesNearerThanAVoxelAreTold) {
  const auto shared = found(box_and(box_mesh(Vec3(0.104, 0, 0), Vec3::Constant(0.1))));
  ASSERT_TRUE(shared);
  EXPECT_EQ(shared->parts, 2U);
  EXPECT_NEAR(shared->distance, 0.004, 1e-9);
  EXPECT_LT(shared->vertices[0], 8);
  EXPECT_GE(shared->vertices[1], 8);
}

TEST(SharedVoxels, OfPartsOfOneSolidAreNot) {
  EXPECT_FALSE(found(box_mesh(Vec3::Zero(), Vec3::Constant(0.1))));
  EXPECT_FALSE(found(box_and(box_mesh(Vec3(0.2, 0, 0), Vec3::Constant(0.1))))) << "apart";
  EXPECT_FALSE(found(box_and(box_mesh(Vec3(0.09, 0.01, 0.01), Vec3::Constant(0.1))))) << "crossing";
  EXPECT_FALSE(found(box_and(box_mesh(Vec3::Zero(), Vec3::Constant(0.04)), true))) << "hollow";
}

TEST(SharedVoxels, AreAWarning) {
  Scene scene = parse_scene(
      "[[body]]\nname = \"boxes\"\nmesh = \"boxes.obj\"\nvoxel_width = 0.02\nmaterial = \"rubber\"\n",
      "scene.toml");
  scene.meshes["boxes.obj"] =
      std::make_shared<Mesh>(box_and(box_mesh(Vec3(0.104, 0, 0), Vec3::Constant(0.1))));
  EXPECT_THAT(build_model(scene).warnings,
              testing::ElementsAre(HasSubstr("body boxes: 2 parts of its mesh are apart but share voxels")));
}

}  // namespace
}  // namespace muslin
