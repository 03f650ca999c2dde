#include "muslin/component/stability_bound.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "muslin/component/component.hpp"

namespace muslin {
namespace {

double largest_eigenvalue(const Mat3& block) {
  Eigen::SelfAdjointEigenSolver<Mat3> solver;
  solver.computeDirect(block, Eigen::EigenvaluesOnly);
  return solver.eigenvalues().maxCoeff();
}

}  // namespace

StabilityBound::StabilityBound(ConstVectors rest)
    : rest_(rest.begin(), rest.end()),
      stiffness_(rest.size(), Mat3::Zero()),
      damping_(rest.size(), Mat3::Zero()) {}

void StabilityBound::add(const Potential& elements, double vertices_of_element, double beta) {
  std::vector<Mat3> blocks(rest_.size(), Mat3::Zero());
  elements.add_diagonal_blocks(rest_, blocks);
  for (std::size_t v = 0; v < blocks.size(); ++v) {
    stiffness_[v] += vertices_of_element * blocks[v];
    damping_[v] += beta * vertices_of_element * blocks[v];
  }
}

void StabilityBound::apply(std::span<const double> masses, double alpha, BodyStatistics& statistics) const {
  for (std::size_t v = 0; v < masses.size(); ++v) {
    const double k = std::max(0.0, largest_eigenvalue(stiffness_[v]) / masses[v]);
    const double c = alpha + std::max(0.0, largest_eigenvalue(damping_[v]) / masses[v]);
    if (k > 0) statistics.undamped_step = std::min(statistics.undamped_step, 2 / std::sqrt(k));
    if (k > 0 || c > 0)
      statistics.stable_step = std::min(statistics.stable_step, 4 / (c + std::sqrt(c * c + 4 * k)));
  }
}

}  // namespace muslin
