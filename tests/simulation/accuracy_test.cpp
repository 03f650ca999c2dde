// Accuracy of the efforts relative to the tight solution: cloth that falls on a ball, up to the first folds.
#include <cmath>
#include <vector>

#include "support/contact_scene.hpp"
#include <gtest/gtest.h>

#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

/// Positions after each of seven frames of four steps: the sheet of 1 m meets the ball in the sixth, and
/// folds in the eighth, from where rounding grows tenfold a frame.
std::vector<std::vector<Vec3>> drop(const SolverSettings& solver) {
  constexpr int n = 50, frames = 7;
  test::ContactScene scene(4);
  scene.model.scene.solver = solver;
  test::ClothGrid cloth(n, n, 1.0 / (n - 1));
  for (Vec3& p : cloth.positions) p += Vec3(-0.5, 0.3, -0.5);
  scene.add_cloth(cloth);
  scene.add_ball(Vec3::Zero(), 0.25);
  Simulation simulation(scene.finish());
  std::vector<std::vector<Vec3>> positions;
  for (int f = 0; f < frames; ++f) {
    simulation.advance();
    positions.push_back(simulation.state().positions);
  }
  return positions;
}

/// Root mean square over the vertices, in the worst frame [m].
double distance(const std::vector<std::vector<Vec3>>& a, const std::vector<std::vector<Vec3>>& b) {
  double largest = 0;
  for (std::size_t f = 0; f < a.size(); ++f) {
    double sum = 0;
    for (std::size_t v = 0; v < a[f].size(); ++v) sum += (a[f][v] - b[f][v]).squaredNorm();
    largest = std::max(largest, std::sqrt(sum / static_cast<double>(a[f].size())));
  }
  return largest;
}

TEST(Accuracy, EffortsHaveTheirAccuracyUpToTheFirstFolds) {
  SolverSettings tight;
  tight.effort = Effort::exact;
  tight.tolerance = 1e-5;
  const auto reference = drop(tight);
  const auto off = [&](Effort effort) {
    SolverSettings settings;
    settings.effort = effort;
    return distance(drop(settings), reference);
  };
  EXPECT_LT(off(Effort::draft), 1e-3);
  EXPECT_LT(off(Effort::normal), 4e-4);
  EXPECT_LT(off(Effort::exact), 5e-6);
}

}  // namespace
}  // namespace muslin
