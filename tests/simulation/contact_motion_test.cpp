// Motion in contact against closed forms and promises: balls that roll and slide, a ball that turns and takes
// cloth along, colliders that are held back, tangled starts that part for ever.
#include <cmath>
#include <memory>

#include "support/contact_scene.hpp"
#include <gtest/gtest.h>

#include "muslin/contact/crossings.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

/// Stiff springs between four vertices: a body that keeps its shape.
class Struts : public Potential {
 public:
  Struts(int first, ConstVectors x, double stiffness)
      : first_(static_cast<std::size_t>(first)), k_(stiffness) {
    length_ = (x[first_] - x[first_ + 1]).norm();
  }
  double value(ConstVectors x) const override {
    double sum = 0;
    for_each(
        [&](std::size_t a, std::size_t b) { sum += k_ * std::pow((x[a] - x[b]).norm() - length_, 2) / 2; });
    return sum;
  }
  void add_gradient(ConstVectors x, Vectors g) const override {
    for_each([&](std::size_t a, std::size_t b) {
      const Vec3 d = x[a] - x[b], f = k_ * (d.norm() - length_) * d.normalized();
      g[a] += f;
      g[b] -= f;
    });
  }
  void add_hessian_product(ConstVectors x, ConstVectors p, Vectors y) const override {
    for_each([&](std::size_t a, std::size_t b) {
      const Vec3 f = block(x[a] - x[b]) * (p[a] - p[b]);
      y[a] += f;
      y[b] -= f;
    });
  }
  void add_diagonal_blocks(ConstVectors x, std::span<Mat3> blocks) const override {
    for_each([&](std::size_t a, std::size_t b) {
      blocks[a] += block(x[a] - x[b]);
      blocks[b] += block(x[a] - x[b]);
    });
  }

 private:
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b < a; ++b) visit(first_ + a, first_ + b);
  }
  Mat3 block(const Vec3& d) const {
    const Vec3 n = d.normalized();
    const double across = std::max(0.0, 1 - length_ / d.norm());
    return k_ * (n * n.transpose() + across * (Mat3::Identity() - n * n.transpose()));
  }
  std::size_t first_;
  double k_, length_;
};

/// Returns the distance that a solid ball rolls down a slope from rest in 0.4 s [m].
double distance_down(double slope, double friction) {
  test::ContactScene scene(16);
  scene.friction = friction;
  scene.model.scene.solver.tolerance = 1e-6;
  const double radius = 0.1;
  const Vec3 normal(std::sin(slope), std::cos(slope), 0), down(std::cos(slope), -std::sin(slope), 0);
  // Height at which the plane carries it: (d̂ − g) k = m g cos(slope).
  const double gap = scene.distance - 9.81 * std::cos(slope) / 1e5;
  const int first = scene.add_turning_ball((radius + gap) * normal, radius, 1);
  scene.add_plane(Vec3::Zero(), normal);
  scene.model.potentials.push_back(
      {"struts", EnergyRole::elastic, std::make_shared<Struts>(first, scene.model.rest_positions, 1e6)});
  Simulation simulation(scene.finish());
  const auto centre = [&] {
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < 4; ++k) sum += simulation.state().positions[static_cast<std::size_t>(first + k)] / 4;
    return sum;
  };
  const Vec3 start = centre();
  for (int frame = 0; frame < 24; ++frame) simulation.advance();
  EXPECT_NEAR(centre().dot(normal), start.dot(normal), 1e-4);
  return (centre() - start).dot(down);
}

TEST(ContactMotion, ABallRollsDownASlopeAtFiveSeventhsOfItsFall) {
  const double slope = 20 * M_PI / 180, time = 0.4, g = 9.81;
  const double rolls = 0.5 * 5.0 / 7 * g * std::sin(slope) * time * time;
  EXPECT_NEAR(distance_down(slope, 0.5), rolls, 0.01 * rolls);
  // Below 2/7 of the slope it slips.
  const double slips = 0.5 * g * (std::sin(slope) - 0.05 * std::cos(slope)) * time * time;
  EXPECT_NEAR(distance_down(slope, 0.05), slips, 0.01 * slips);
}

TEST(ContactMotion, RotatingBallDragsCloth) {
  test::ContactScene scene;
  scene.friction = 0.5;
  test::ClothGrid cloth(9, 9, 0.025);
  for (Vec3& p : cloth.positions) {
    p -= Vec3(0.1, 0, 0.1);
    p.y() = std::sqrt(0.5015 * 0.5015 - p.x() * p.x() - p.z() * p.z());
  }
  scene.add_cloth(cloth);
  Motion turn;
  for (int k = 0; k <= 10; ++k)
    turn.keys.push_back(
        {0.1 * k, Vec3::Zero(), Eigen::Quaterniond(Eigen::AngleAxisd(0.1 * k, Vec3(0, 1, 0)))});
  scene.add_turning_ball(Vec3::Zero(), 0.5, 0, turn);
  const auto model = scene.finish();
  Simulation simulation(model);
  const std::vector<Vec3> start = simulation.state().positions;
  for (int frame = 0; frame < 30; ++frame) simulation.advance();
  const Mat3 turned = Eigen::AngleAxisd(0.5, Vec3(0, 1, 0)).toRotationMatrix();
  for (std::size_t v : {0U, 8U, 20U, 60U, 80U})
    EXPECT_LT((simulation.state().positions[v] - turned * start[v]).norm(), 0.004) << v;
}

/// A strip that stands in a sheet, drawn out of it and pushed back to where it was.
TEST(ContactMotion, TangledSheetsSeparateForGood) {
  test::ContactScene scene;
  test::ClothGrid sheet(11, 11, 0.03), strip(5, 5, 0.03);
  scene.add_cloth(sheet);
  std::vector<int> border;
  for (int j = 0; j < 11; ++j)
    for (int i = 0; i < 11; ++i)
      if (i == 0 || j == 0 || i == 10 || j == 10) border.push_back(11 * j + i);
  scene.hold(border);
  for (Vec3& p : strip.positions) p = Vec3(p.x() + 0.08, p.z() - 0.05, 0.14);
  const int first = scene.add_cloth(strip);
  Motion motion;
  motion.keys = {{0, Vec3::Zero()}, {0.5, Vec3(0, 0.15, 0)}, {1.0, Vec3(0, 0.03, 0)}};
  std::vector<int> all;
  for (int v = 0; v < 25; ++v) all.push_back(first + v);
  scene.hold(all, motion);
  const auto model = scene.finish(Vec3::Zero());
  Simulation simulation(model, {.allow_tangled = true});
  EXPECT_GT(simulation.tangled(), 0U);
  EXPECT_LE(simulation.diagnostics().min_distance, 0);
  bool parted = false;
  for (int frame = 0; frame < 60; ++frame) {
    simulation.advance();
    const std::size_t crossings = find_crossings(*model->contact, simulation.state().positions).size();
    EXPECT_EQ(simulation.tangled(), crossings);
    if (crossings > 0) {
      EXPECT_LE(simulation.diagnostics().min_distance, 0) << frame;
    }
    if (parted) {
      EXPECT_EQ(crossings, 0U) << frame;
    }
    parted = parted || crossings == 0;
  }
  EXPECT_TRUE(parted);
  // The strip has come down again and takes the sheet with it.
  EXPECT_LT(simulation.state().positions[60].y(), -0.005);
}

/// Cloth that falls on a ball: the balance changes by the work of what is left out of balance, which is next
/// to nothing where steps are solved exactly.
TEST(ContactMotion, BalanceChangesByTheWorkOfTheResiduals) {
  for (const double tolerance : {0.01, 1e-6}) {
    test::ContactScene scene;
    scene.model.scene.solver.tolerance = tolerance;
    test::ClothGrid cloth(11, 11, 0.03);
    for (Vec3& p : cloth.positions) p -= Vec3(0.15, -0.003, 0.15);
    scene.add_cloth(cloth);
    scene.add_ball(Vec3(0, -0.1, 0), 0.1);
    Simulation simulation(scene.finish());
    const double start = simulation.diagnostics().balance();
    double unbalanced = 0;
    for (int frame = 0; frame < 20; ++frame) {
      simulation.advance();
      const Diagnostics& now = simulation.diagnostics();
      EXPECT_NEAR(now.balance() - start, now.unbalanced, 1e-6) << frame;
      unbalanced = std::max(unbalanced, std::abs(now.unbalanced));
    }
    if (tolerance < 1e-5) {
      EXPECT_LT(unbalanced, 1e-5);
    }
  }
}

TEST(ContactMotion, BlockedColliderIsHeldBack) {
  // A ball pressed down on a fixed sheet of held vertices.
  test::ContactScene scene;
  test::ClothGrid sheet(9, 9, 0.05);
  scene.add_cloth(sheet);
  std::vector<int> all;
  for (int v = 0; v < 81; ++v) all.push_back(v);
  scene.hold(all);
  Motion motion;
  motion.keys = {{0, Vec3::Zero()}, {0.2, Vec3(0, -0.3, 0)}, {0.4, Vec3::Zero()}};
  const int ball = scene.add_ball(Vec3(0.2, 0.15, 0.2), 0.1, motion);
  const auto model = scene.finish();
  Simulation simulation(model);
  bool held_back = false;
  for (int frame = 0; frame < 24; ++frame) {
    simulation.advance();
    held_back = held_back || simulation.diagnostics().held_back > 0;
    const auto crossings = find_crossings(*model->contact, simulation.state().positions);
    ASSERT_TRUE(crossings.empty()) << frame << ": " << describe(*model->contact, crossings.front());
    ASSERT_GT(simulation.state().positions[static_cast<std::size_t>(ball)].y(), 0.1) << frame;
  }
  EXPECT_TRUE(held_back);
  EXPECT_EQ(simulation.diagnostics().held_back, 0);
  EXPECT_NEAR(simulation.state().positions[static_cast<std::size_t>(ball)].y(), 0.15, 1e-9);
}

}  // namespace
}  // namespace muslin
