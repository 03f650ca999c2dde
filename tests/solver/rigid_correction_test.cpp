// Corrections at the end of a loosely solved step: momenta are exact for each part, and what is left out of
// balance does no work.
#include "muslin/solver/rigid_correction.hpp"

#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "support/lattice_box.hpp"
#include "support/potential_battery.hpp"
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "muslin/energy/spring_energy.hpp"
#include "muslin/potential/restricted.hpp"

namespace muslin {
namespace {

/// Two boxes of springs that turn, stretch and fly, one a thousand times as heavy, at the end of a step that
/// was solved loosely.
class LooseStep : public testing::Test {
 protected:
  void SetUp() override {
    const Lattice lattice = test::box_lattice({3, 2, 2}, 0.1);
    const std::vector<Vec3> rest = test::rest_positions(lattice);
    size_ = rest.size();
    const auto springs = std::make_shared<SpringEnergy>(build_springs(lattice, Bracing::full), 0.1,
                                                        std::array<double, 3>{40, 10, 10});
    for (std::size_t part = 0; part < 2; ++part) {
      potentials_.push_back(std::make_unique<RestrictedPotential>(springs, part * size_, size_));
      for (const Vec3& p : rest) from_.push_back(p + Vec3(static_cast<double>(part), 0, 0));
      masses_.insert(masses_.end(), size_, part == 0 ? 0.01 : 10.0);
      parts_.insert(parts_.end(), size_, static_cast<int>(part));
    }
    from_ = test::sum(from_, 1, test::random_vectors(from_.size(), 2e-3, 1));
    fixed_.assign(from_.size(), 0);
    problem_.masses = masses_;
    problem_.fixed = fixed_;
    problem_.targets = from_;
    problem_.parts = parts_;
    for (const auto& potential : potentials_) problem_.potentials.push_back(potential.get());
    for (const Vec3& p : from_)
      prediction_.push_back(p +
                            dt_ * (Vec3(1, 2, 3) + Vec3(4, -5, 6).cross(p) + 20 * Vec3(p.x(), -p.y(), 0)));
    function_.emplace(problem_, prediction_, dt_);
    x_ = test::sum(prediction_, 1, test::random_vectors(from_.size(), 3e-4, 2));
  }
  std::vector<Vec3> gradient() const {
    std::vector<Vec3> g(x_.size());
    function_->gradient(x_, g);
    return g;
  }
  /// Returns |Σ g| and |Σ r × g| of one part, as shares of the sums of the lengths.
  std::pair<double, double> imbalance(std::size_t part) const {
    const std::vector<Vec3> g = gradient();
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    double forces = 0, torques = 0;
    for (std::size_t v = part * size_; v < (part + 1) * size_; ++v) {
      const Vec3 moment = (x_[v] - Vec3(static_cast<double>(part), 0, 0)).cross(g[v]);
      force += g[v], torque += moment;
      forces += g[v].norm(), torques += moment.norm();
    }
    return {force.norm() / forces, torque.norm() / torques};
  }

  double dt_ = 1.0 / 240;
  std::size_t size_ = 0;
  std::vector<std::unique_ptr<Potential>> potentials_;
  std::vector<Vec3> from_, prediction_, x_;
  std::vector<double> masses_;
  std::vector<std::uint8_t> fixed_;
  std::vector<int> parts_;
  StepProblem problem_;
  std::optional<IncrementalPotential> function_;
};

TEST_F(LooseStep, EndsWithTheMomentaOfEachPart) {
  EXPECT_GT(imbalance(0).first, 1e-2);
  EXPECT_GT(imbalance(1).second, 1e-2);
  correct_rigid_motions(problem_, *function_, nullptr, gradient(), x_);
  for (const std::size_t part : {0, 1}) {
    EXPECT_LT(imbalance(part).first, 1e-12) << part;
    EXPECT_LT(imbalance(part).second, 1e-9) << part;
  }
}

TEST_F(LooseStep, IsMovedRigidly) {
  const std::vector<Vec3> before = x_;
  correct_rigid_motions(problem_, *function_, nullptr, gradient(), x_);
  EXPECT_GT((x_[0] - before[0]).norm(), 1e-6);
  for (std::size_t v = 1; v < size_; ++v)
    EXPECT_NEAR((x_[v] - x_[0]).norm(), (before[v] - before[0]).norm(), 1e-14) << v;
}

TEST_F(LooseStep, ResidualDoesNoWork) {
  // It has gone a little too far, and is not quite where it should be besides.
  x_ = test::sum(from_, 1.005, test::sum(prediction_, -1, from_));
  x_ = test::sum(x_, 1, test::random_vectors(x_.size(), 1e-6, 2));
  correct_rigid_motions(problem_, *function_, nullptr, gradient(), x_);
  const auto work = [&](std::size_t part) {
    const std::vector<Vec3> g = gradient();
    double sum = 0;
    for (std::size_t v = part * size_; v < (part + 1) * size_; ++v) sum += g[v].dot(x_[v] - from_[v]);
    return std::abs(sum);
  };
  const double light = work(0), heavy = work(1);
  std::vector<Vec3> g = gradient();
  correct_work(problem_, *function_, nullptr, from_, g, x_);
  EXPECT_LT(work(0), 0.02 * light);
  EXPECT_LT(work(1), 0.02 * heavy);
  const std::vector<Vec3> now = gradient();
  for (std::size_t v = 0; v < g.size(); ++v) EXPECT_LT((g[v] - now[v]).norm(), 1e-3 * (now[v].norm() + 1e-3));
  for (const std::size_t part : {0, 1}) EXPECT_LT(imbalance(part).first, 1e-11) << part;
}

TEST_F(LooseStep, DoesNotMoveHeldVertices) {
  fixed_[3] = 1;
  const Vec3 held = x_[3];
  std::vector<Vec3> g = gradient();
  correct_work(problem_, *function_, nullptr, from_, g, x_);
  correct_rigid_motions(problem_, *function_, nullptr, g, x_);
  EXPECT_EQ(x_[3], held);
  EXPECT_GT(imbalance(0).first, 1e-6);   // what is held has no momentum of its own
  EXPECT_LT(imbalance(1).first, 1e-12);  // its neighbour has
}

}  // namespace
}  // namespace muslin
