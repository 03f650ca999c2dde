#include "muslin/lattice/embedding.hpp"

#include <random>

#include "lattice/shapes.hpp"
#include <gtest/gtest.h>

#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

std::vector<Vec3> rest_positions(const Lattice& lattice) {
  std::vector<Vec3> rest(lattice.vertex_count());
  for (std::size_t v = 0; v < rest.size(); ++v) rest[v] = lattice.rest_position(v);
  return rest;
}

std::vector<Vec3> random_points(std::size_t count, double reach, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-reach, reach);
  std::vector<Vec3> points(count);
  for (Vec3& p : points) p = {uniform(random), uniform(random), uniform(random)};
  return points;
}

class EmbeddingTest : public testing::Test {
 protected:
  Mesh mesh_ = shapes::star(10, [](const Vec3& d) { return 1 + 0.4 * std::sin(5 * d.x()); });
  Lattice lattice_ = build_lattice(mesh_, SignedDistance(mesh_), {0.17});
};

TEST_F(EmbeddingTest, ReproducesPointsAtRestAndLinearFields) {
  std::vector<Vec3> points = mesh_.positions;
  for (const Vec3& p : random_points(500, 3, 1)) points.push_back(p);
  for (const Vec3& p : rest_positions(lattice_)) points.push_back(p);
  const Embedding embedding = embed(lattice_, points);
  const std::vector<Vec3> rest = rest_positions(lattice_);
  std::vector<Vec3> carried(points.size());
  embedding.apply(rest, carried);
  for (std::size_t p = 0; p < points.size(); ++p) ASSERT_LT((carried[p] - points[p]).norm(), 1e-12);

  Mat3 gradient;
  gradient << 1, 2, -3, 0.5, -1, 4, 2, 0, 7;
  const Vec3 shift(10, -20, 30);
  std::vector<Vec3> field(rest);
  for (Vec3& x : field) x = gradient * x + shift;
  embedding.apply(field, carried);
  for (std::size_t p = 0; p < points.size(); ++p)
    ASSERT_LT((carried[p] - gradient * points[p] - shift).norm(), 1e-10);
}

TEST_F(EmbeddingTest, PointsOfTheSolidAreInsideTheirVoxel) {
  const Embedding embedding = embed(lattice_, mesh_.positions);
  for (const auto& weights : embedding.weights) {
    for (double w : weights) {
      ASSERT_GE(w, -1e-12);
      ASSERT_LE(w, 1 + 1e-12);
    }
  }
}

TEST_F(EmbeddingTest, PointsOutsideAreCarriedByTheNearestVoxel) {
  const auto points = random_points(300, 6, 2);
  const Embedding embedding = embed(lattice_, points);
  const auto distance = [&](const Vec3& p, const Vec3i& low) {
    const Vec3 local = (p - lattice_.origin) / lattice_.width - low.cast<double>();
    return (local - local.cwiseMax(0.0).cwiseMin(1.0)).norm();
  };
  for (std::size_t p = 0; p < points.size(); ++p) {
    double best = INFINITY;
    for (const Vec3i& voxel : lattice_.voxels) best = std::min(best, distance(points[p], voxel));
    ASSERT_NEAR(distance(points[p], lattice_.vertices[embedding.vertices[p][0]]), best, 1e-9);
  }
}

TEST_F(EmbeddingTest, TransposeIsTheAdjointWithTheSameBitsPreparedOrNot) {
  const auto points = random_points(2000, 1.5, 3);
  const Embedding embedding = embed(lattice_, points);
  const auto q = random_points(lattice_.vertex_count(), 1, 4), f = random_points(points.size(), 1, 5);
  std::vector<Vec3> x(points.size()), back(q.size(), Vec3::Ones()), plain(q.size(), Vec3::Ones());
  embedding.apply(q, x);
  embedding.add_transpose(f, back);
  double left = 0, right = 0;
  for (std::size_t p = 0; p < x.size(); ++p) left += f[p].dot(x[p]);
  for (std::size_t v = 0; v < q.size(); ++v) right += q[v].dot(back[v] - Vec3::Ones());
  EXPECT_NEAR(left, right, 1e-9 * (1 + std::abs(left)));

  Embedding unprepared;
  unprepared.vertices = embedding.vertices;
  unprepared.weights = embedding.weights;
  unprepared.add_transpose(f, plain);
  EXPECT_EQ(back, plain);
}

}  // namespace
}  // namespace muslin
