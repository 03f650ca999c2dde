#include "muslin/solver/inner_solver.hpp"

#include <algorithm>
#include <cmath>

#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

double largest_entry(ConstVectors b) {
  struct Largest {
    double value = 0;
    Largest operator+(const Largest& other) const { return {std::max(value, other.value)}; }
  };
  return parallel_sum(b.size(), 8192, Largest{},
                      [&](std::size_t begin, std::size_t end) {
                        double largest = 0;
                        for (std::size_t v = begin; v < end; ++v)
                          largest = std::max(largest, b[v].cwiseAbs().maxCoeff());
                        return Largest{largest};
                      })
      .value;
}

}  // namespace

void InnerSolver::linearize(const IncrementalPotential& function, ConstVectors x) {
  function.linearize(x, h_);
  stiffest_ = system_.factor(h_);
  projected_ = false;
}

bool InnerSolver::project() {
  if (projected_) return false;
  h_.project();
  system_.factor(h_);
  projected_ = true;
  return true;
}

LinearReport InnerSolver::solve(ConstVectors b, const LinearSettings& settings, Vectors s, double& norm) {
  // Scaled to entries of at most 1, far from the ends of float's range.
  const double scale = largest_entry(b);
  LinearReport report;
  norm = 0;
  const auto nothing = [&] {
    std::fill(s.begin(), s.end(), Vec3::Zero());
    report.converged = true;
    return report;
  };
  if (scale == 0) {
    report.relative_residual = 0;
    return nothing();
  }
  double rr = system_.start(b, 1 / scale);
  const double first = rr;
  const double stop = settings.tolerance * settings.tolerance * rr;
  norm = scale * std::sqrt(rr);
  if (norm <= settings.enough) return nothing();
  double alpha = 0, beta = 0;
  while (report.iterations < settings.max_iterations) {
    const double curvature = system_.direction(alpha, beta);
    alpha = 0;
    ++report.iterations;
    // H is of no use here, or its couplings are so far from definite that the factorisation grows without
    // bound.
    const bool stop_at_negative = settings.negative_curvature == NegativeCurvature::stop;
    if (report.iterations == 1 && !(curvature > 0) && stop_at_negative && !projected_) {
      project();
      return solve(b, settings, s, norm);
    }
    if (!std::isfinite(curvature) || curvature == 0) break;
    if (curvature < 0 && stop_at_negative) {
      if (report.iterations == 1) alpha = 1;
      report.negative_curvature = true;
      break;
    }
    alpha = rr / curvature;
    const double rr_next = system_.residual(alpha);
    beta = rr_next / rr;
    rr = rr_next;
    if (rr <= stop) {
      report.converged = true;
      break;
    }
  }
  system_.solution(alpha, scale, s);
  report.relative_residual = first > 0 ? std::sqrt(rr / first) : 0;
  return report;
}

}  // namespace muslin
