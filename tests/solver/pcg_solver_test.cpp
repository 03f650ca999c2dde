// Linear systems in float against the same in double, where contact is ever stiffer beside the masses.
#include "muslin/solver/pcg_solver.hpp"

#include <vector>

#include "support/potential_battery.hpp"
#include "support/sheet.hpp"
#include <Eigen/Cholesky>
#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "muslin/energy/membrane_energy.hpp"

namespace muslin {
namespace {

/// Springs of one stiffness between vertices, along normals that differ, several at a vertex: as contacts add
/// them.
class Presses : public Potential {
 public:
  Presses(int vertices, double stiffness) : count_(vertices), stiffness_(stiffness) {
    for (int i = 0; i + 7 < vertices; i += 2) {
      for (const int other : {i + 5, i + 7})
        pairs_.push_back({i, other, Vec3(1, 0.3 * (i % 5), 0.2 * (other % 3)).normalized()});
    }
  }
  double value(ConstVectors) const override { return 0; }
  void add_gradient(ConstVectors, Vectors) const override {}
  void add_hessian_product(ConstVectors, ConstVectors p, Vectors y) const override {
    for (const Pair& pair : pairs_) {
      const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
      const Vec3 f = stiffness_ * pair.normal.dot(p[a] - p[b]) * pair.normal;
      y[a] += f, y[b] -= f;
    }
  }
  void add_diagonal_blocks(ConstVectors, std::span<Mat3>) const override {}
  void linearize(ConstVectors, HessianSink& into, std::size_t first) const override {
    const RelativeTerms k =
        into.relative_terms(first, static_cast<std::size_t>(count_), pairs_.size(), 2 * pairs_.size());
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      const RelativeTerms::Weight weights[] = {{pairs_[i].a, 1}, {pairs_[i].b, -1}};
      k.set(i, 2 * i, pairs_[i].normal, into.scale() * stiffness_, 0, weights);
    }
  }

 private:
  struct Pair {
    int a, b;
    Vec3 normal;
  };
  int count_;
  double stiffness_;
  std::vector<Pair> pairs_;
};

TEST(PcgSolver, SolvesContactMuchStifferThanMasses) {
  const Mesh mesh = test::flat_sheet(8, 7, 0.16, 0.14);
  const Shell shell = build_shell(mesh, mesh.positions, {Vec3::UnitX()});
  const MembraneEnergy membrane(shell, {900, 500, 130, 0.25}, block_pattern(shell));
  const std::size_t count = mesh.vertex_count();
  const std::vector<double> masses(count, 1e-4);
  const std::vector<std::uint8_t> fixed(count, 0);
  const double dt = 1.0 / 240;
  const auto n = static_cast<Eigen::Index>(3 * count);
  const std::vector<Vec3> b = test::random_vectors(count, 1e-6, 3);
  for (const double ratio : {1e3, 1e5, 1e7, 1e9}) {
    const Presses presses(static_cast<int>(count), ratio * masses[0] / (dt * dt));
    StepProblem problem;
    problem.masses = masses;
    problem.fixed = fixed;
    problem.targets = mesh.positions;
    problem.potentials = {&membrane, &presses};
    const IncrementalPotential function(problem, mesh.positions, dt);
    Eigen::MatrixXd h(n, n);
    Eigen::VectorXd right(n);
    std::vector<Vec3> unit(count, Vec3::Zero()), column(count);
    for (Eigen::Index i = 0; i < n; ++i) {
      unit[static_cast<std::size_t>(i / 3)][i % 3] = 1;
      function.hessian_product(mesh.positions, unit, column);
      unit[static_cast<std::size_t>(i / 3)][i % 3] = 0;
      for (Eigen::Index j = 0; j < n; ++j) h(j, i) = column[static_cast<std::size_t>(j / 3)][j % 3];
      right[i] = b[static_cast<std::size_t>(i / 3)][i % 3];
    }
    const Eigen::VectorXd exact = h.ldlt().solve(right);
    PcgSolver pcg;
    pcg.begin_step();
    pcg.linearize(function, mesh.positions);
    EXPECT_TRUE(pcg.fits_float());
    EXPECT_GT(pcg.stiffest(), 0.5 * ratio);
    LinearSettings settings;
    settings.tolerance = 1e-3;
    std::vector<Vec3> s(count);
    double norm;
    const LinearReport report = pcg.solve(b, settings, s, norm);
    EXPECT_TRUE(report.converged) << ratio;
    Eigen::VectorXd error = -exact;
    for (Eigen::Index i = 0; i < n; ++i) error[i] += s[static_cast<std::size_t>(i / 3)][i % 3];
    // In the norm of H, which Newton's method goes by, and as motion.
    EXPECT_LT(std::sqrt(error.dot(h * error) / exact.dot(h * exact)), 0.05) << ratio;
    EXPECT_LT(error.norm() / exact.norm(), 0.05) << ratio;
  }
}

}  // namespace
}  // namespace muslin
