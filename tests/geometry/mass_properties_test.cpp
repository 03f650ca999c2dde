// Volume, centre and second moments: polyhedra against closed forms, closed forms against sampled solids, and
// the meshes of simple shapes against both.
#include "muslin/geometry/mass_properties.hpp"

#include <numbers>

#include <gtest/gtest.h>

#include "muslin/geometry/affine_frame.hpp"
#include "muslin/geometry/inspect.hpp"
#include "muslin/geometry/shapes.hpp"

namespace muslin {
namespace {

MassProperties of(const Mesh& mesh) { return polyhedron_mass(mesh.positions, triangulate(mesh).triangles); }

void expect_near(const MassProperties& a, const MassProperties& b, double relative) {
  EXPECT_NEAR(a.volume, b.volume, relative * b.volume);
  EXPECT_LT((a.centre - b.centre).norm(), relative * std::cbrt(b.volume));
  EXPECT_LT((a.second_moment - b.second_moment).norm(), relative * b.second_moment.norm());
}

TEST(MassProperties, OfABoxAreExactForAnyPlacement) {
  Mesh mesh = box_mesh(Vec3(1, 2, 3), Vec3(0.5, 2, 0.01));
  const MassProperties box = box_mass(Vec3(1, 2, 3), Vec3(0.5, 2, 0.01));
  expect_near(of(mesh), box, 1e-13);
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  const Vec3 far(1000, -500, 20);
  for (Vec3& x : mesh.positions) x = turn * x + far;
  expect_near(of(mesh), {box.volume, turn * box.centre + far, turn * box.second_moment * turn.transpose()},
              1e-9);
}

TEST(MassProperties, OfATetrahedronHaveTheClosedForm) {
  // The standard simplex: ∫ x² = 1/60, ∫ x y = 1/120, centre ¼.
  const std::vector<Vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<Vec3i> faces = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  const MassProperties mass = polyhedron_mass(corners, faces);
  EXPECT_NEAR(mass.volume, 1.0 / 6, 1e-15);
  EXPECT_LT((mass.centre - Vec3::Constant(0.25)).norm(), 1e-15);
  const double off = 1.0 / 120 - 1.0 / 96, on = 1.0 / 60 - 1.0 / 96;
  EXPECT_NEAR(mass.second_moment(0, 0), on, 1e-16);
  EXPECT_NEAR(mass.second_moment(1, 2), off, 1e-16);
}

TEST(MassProperties, OfSphereAndCapsuleAgreeWithTheirMeshes) {
  // Inscribed meshes are a little smaller: 642 vertices of a sphere lose 0.9 % of its volume.
  expect_near(of(sphere_mesh(Vec3(1, 0, 0), 0.3)), sphere_mass(Vec3(1, 0, 0), 0.3), 0.02);
  const Vec3 a(0, 1, 0), b(1, 1.5, -0.3);
  expect_near(of(capsule_mesh(a, b, 0.2)), capsule_mass(a, b, 0.2), 0.02);
  // In the limit of no length a capsule is a sphere; of great length, a rod.
  expect_near(capsule_mass(Vec3(0, 0, 0), Vec3(1e-9, 0, 0), 0.5), sphere_mass(Vec3(0, 0, 0), 0.5), 1e-8);
  const MassProperties rod = capsule_mass(Vec3(0, 0, 0), Vec3(100, 0, 0), 0.01);
  EXPECT_NEAR(rod.second_moment(0, 0), rod.volume * 100 * 100 / 12, 1e-3 * rod.second_moment(0, 0));
}

TEST(Shapes, AreClosedOutwardAndCorrectlyPlaced) {
  for (const Mesh& mesh : {sphere_mesh(Vec3(1, 2, 3), 0.5), capsule_mesh(Vec3(0, 0, 0), Vec3(0, 0, 1), 0.2),
                           box_mesh(Vec3(0, 1, 0), Vec3(1, 2, 3))}) {
    const MeshReport report = inspect(mesh);
    EXPECT_TRUE(report.closed);
    EXPECT_EQ(report.flipped_edges, 0u);
    EXPECT_EQ(report.degenerate_faces, 0u);
    EXPECT_GT(report.volume, 0);
  }
  for (const Vec3& x : sphere_mesh(Vec3(1, 2, 3), 0.5).positions)
    EXPECT_NEAR((x - Vec3(1, 2, 3)).norm(), 0.5, 1e-14);
  EXPECT_EQ(sphere_mesh(Vec3::Zero(), 1).vertex_count(), 642u);
  const Box box = capsule_mesh(Vec3(0, 0, 0), Vec3(0, 0, 1), 0.2).bounds();
  EXPECT_NEAR(box.min().z(), -0.2, 1e-14);
  EXPECT_NEAR(box.max().z(), 1.2, 1e-14);
  const Mesh plane = plane_mesh(Vec3(0, -1, 0), Vec3(0, 1, 0), 4);
  EXPECT_LT((newell_normal(plane.positions, plane.face(0)) - Vec3(0, 32, 0)).norm(), 1e-12);
  EXPECT_NEAR(plane.bounds().sizes().x(), 4, 1e-12);  // its sides along the axes
}

/// Four masses at the corners have the mass, centre and second moment of the body.
void expect_equimomental(const MassProperties& body, double tolerance = 1e-12) {
  const AffineFrame frame = equimomental_frame(body);
  EXPECT_GT(frame.axes.determinant(), 0);
  Vec3 first = Vec3::Zero();
  for (const Vec3& q : frame.corners()) first += q / 4;
  EXPECT_LT((first - body.centre).norm(), tolerance * (1 + body.centre.norm()));
  Mat3 second = Mat3::Zero();
  for (const Vec3& q : frame.corners()) second += (q - first) * (q - first).transpose() / 4;
  EXPECT_LT((second - body.second_moment / body.volume).norm(), tolerance * second.norm());
}

TEST(AffineFrame, HasTheMomentsOfTheBody) {
  expect_equimomental(sphere_mass(Vec3(1, 2, 3), 0.5));
  expect_equimomental(capsule_mass(Vec3(1, 0, 0), Vec3(2, 3, 1), 0.2));
  expect_equimomental(box_mass(Vec3(0, 0, 0), Vec3(3, 1, 0.05)));
  const AffineFrame ball = equimomental_frame(sphere_mass(Vec3::Zero(), 0.5));
  EXPECT_LT((ball.radii - Vec3::Constant(0.5 / std::sqrt(5.0))).norm(), 1e-14);
  EXPECT_EQ(ball.axes, Mat3::Identity());
  // A foil: too thin by itself, kept from degenerating.
  const AffineFrame foil = equimomental_frame(box_mass(Vec3::Zero(), Vec3(1, 1e-9, 1)));
  EXPECT_NEAR(foil.radii.y(), 1e-3 * foil.radii.x(), 1e-9);
}

TEST(AffineFrame, WeightsReproducePointsAndMoveAffinely) {
  const AffineFrame frame = equimomental_frame(capsule_mass(Vec3(1, 0, 0), Vec3(2, 3, 1), 0.2));
  const Eigen::Affine3d map =
      Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(0.4, Vec3::UnitY()) * Eigen::Scaling(1.0, 2.0, 0.5);
  const auto corners = frame.corners();
  for (const Vec3& point : {Vec3(0, 0, 0), Vec3(1.5, 1.5, 0.5), Vec3(-3, 7, 2)}) {
    const auto w = frame.weights(point);
    EXPECT_NEAR(w[0] + w[1] + w[2] + w[3], 1, 1e-13);
    Vec3 here = Vec3::Zero(), there = Vec3::Zero();
    for (std::size_t i = 0; i < 4; ++i) {
      here += w[i] * corners[i];
      there += w[i] * (map * corners[i]);
    }
    EXPECT_LT((here - point).norm(), 1e-12);
    EXPECT_LT((there - map * point).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace muslin
