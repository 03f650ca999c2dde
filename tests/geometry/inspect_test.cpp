#include "muslin/geometry/inspect.hpp"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

using testing::HasSubstr;

Mesh cube() {
  Mesh mesh;
  for (int v = 0; v < 8; ++v) mesh.positions.push_back(Vec3(v & 1, v >> 1 & 1, v >> 2 & 1));
  for (const auto& face : std::vector<std::vector<int>>{
           {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}})
    mesh.add_face(face);
  return mesh;
}

TEST(Inspect, CubeIsClosedAndClean) {
  const MeshReport report = inspect(cube());
  EXPECT_EQ(report.vertices, 8u);
  EXPECT_EQ(report.faces, 6u);
  EXPECT_EQ(report.triangles, 12u);
  EXPECT_EQ(report.components, 1u);
  EXPECT_TRUE(report.closed);
  EXPECT_EQ(report.flat_axis, -1);
  EXPECT_DOUBLE_EQ(report.area, 6);
  EXPECT_DOUBLE_EQ(report.volume, 1);
  EXPECT_THAT(report.warnings, testing::IsEmpty());
}

TEST(Inspect, CountsOpenFlippedAndNonManifoldEdges) {
  Mesh open = cube();
  open.face_offsets.pop_back();
  open.face_vertices.resize(20);
  EXPECT_EQ(inspect(open).open_edges, 4u);
  EXPECT_FALSE(inspect(open).closed);

  Mesh flipped = cube();
  std::reverse(flipped.face_vertices.end() - 4, flipped.face_vertices.end());
  EXPECT_EQ(inspect(flipped).flipped_edges, 4u);
  EXPECT_TRUE(inspect(flipped).closed);

  Mesh fin = cube();
  fin.positions.push_back(Vec3(2, 2, 0));
  fin.add_face(std::vector<int>{1, 3, 8});
  EXPECT_EQ(inspect(fin).non_manifold_edges, 1u);
  EXPECT_EQ(inspect(fin).open_edges, 2u);
}

TEST(Inspect, WarnsOfInvertedDuplicateDegenerateAndLooseParts) {
  Mesh mesh = cube();
  for (std::size_t f = 0; f < 6; ++f)
    std::reverse(mesh.face_vertices.begin() + static_cast<std::ptrdiff_t>(4 * f),
                 mesh.face_vertices.begin() + static_cast<std::ptrdiff_t>(4 * f) + 4);
  EXPECT_DOUBLE_EQ(inspect(mesh).volume, -1);
  EXPECT_THAT(inspect(mesh).warnings, testing::ElementsAre(HasSubstr("inward")));

  mesh = cube();
  mesh.add_face(std::vector<int>{3, 1, 0, 2});
  mesh.add_face(std::vector<int>{0, 1, 1});
  mesh.positions.push_back(Vec3(0.5, 0.5, 0.5));
  const MeshReport report = inspect(mesh);
  EXPECT_EQ(report.duplicate_faces, 1u);
  EXPECT_EQ(report.degenerate_faces, 1u);
  EXPECT_EQ(report.unused_vertices, 1u);
  EXPECT_EQ(report.components, 1u);
  EXPECT_THAT(report.warnings, testing::Contains(HasSubstr("1 vertex belongs to no face")));
}

TEST(Inspect, FindsTheAxisOfAFlatMesh) {
  for (int axis = 0; axis < 3; ++axis) {
    Mesh mesh;
    for (int v = 0; v < 4; ++v) {
      Vec3 position = Vec3::Constant(1000);
      position[(axis + 1) % 3] += v & 1;
      position[(axis + 2) % 3] += v >> 1;
      mesh.positions.push_back(position);
    }
    mesh.add_face(std::vector<int>{0, 1, 3, 2});
    EXPECT_EQ(inspect(mesh).flat_axis, axis);
    mesh.positions[0][axis] += 1e-6;
    EXPECT_EQ(inspect(mesh).flat_axis, -1);
  }
}

TEST(Inspect, CountsComponents) {
  Mesh mesh = cube();
  for (int copy = 1; copy < 5; ++copy) {
    const Mesh one = cube();
    for (const Vec3& position : one.positions) mesh.positions.push_back(position + Vec3(3.0 * copy, 0, 0));
    for (std::size_t f = 0; f < one.face_count(); ++f) {
      std::vector<int> face(one.face(f).begin(), one.face(f).end());
      for (int& v : face) v += 8 * copy;
      mesh.add_face(face);
    }
  }
  EXPECT_EQ(inspect(mesh).components, 5u);
  EXPECT_DOUBLE_EQ(inspect(mesh).volume, 5);
}

TEST(RequireUsable, ErrorsStateProblemAndPlace) {
  const auto complaint = [](const Mesh& mesh) -> std::string {
    try {
      require_usable(mesh, "flag.obj");
      return "";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      EXPECT_EQ(error.place().file, "flag.obj");
      EXPECT_FALSE(error.remedy().empty());
      EXPECT_NO_THROW(inspect(mesh));
      return error.problem();
    }
  };
  EXPECT_EQ(complaint(cube()), "");
  EXPECT_THAT(complaint(Mesh{}), HasSubstr("no vertices"));
  Mesh mesh = cube();
  mesh.face_offsets.clear();
  mesh.face_vertices.clear();
  EXPECT_THAT(complaint(mesh), HasSubstr("no faces"));
  mesh = cube();
  mesh.positions[2].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(complaint(mesh), HasSubstr("vertex 3"));
  mesh.positions[2].y() = 1e30;
  EXPECT_THAT(complaint(mesh), HasSubstr("1e9 m"));
  mesh = cube();
  mesh.face_vertices[5] = 8;
  EXPECT_THAT(complaint(mesh), HasSubstr("face 2 uses vertex 9, but there are 8"));
  mesh.face_vertices[5] = -1;
  EXPECT_THAT(complaint(mesh), HasSubstr("face 2"));
  mesh = cube();
  for (Vec3& position : mesh.positions) position.tail<2>().setZero();
  EXPECT_THAT(complaint(mesh), HasSubstr("no area"));
  mesh = cube();
  mesh.corner_uvs = {1};
  EXPECT_THAT(complaint(mesh), HasSubstr("texture"));
  mesh = cube();
  for (Vec3& position : mesh.positions) position *= 1e-6;
  EXPECT_EQ(complaint(mesh), "");
}

}  // namespace
}  // namespace muslin
