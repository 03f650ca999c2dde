#include "muslin/solver/pcg_solver.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

/// A solve that takes more iterations uses the coarse space. An iteration with it costs three times as much
/// where the factorisation includes the couplings, hardly more where block matrices are multiplied.
constexpr int patience_of_couplings = 40, patience_of_matrices = 6;

double largest_entry(ConstVectors b) {
  struct Largest {
    double value = 0;
    Largest operator+(const Largest& other) const { return {std::max(value, other.value)}; }
  };
  return parallel_sum(b.size(), 8192, Largest{},
                      [&](std::size_t begin, std::size_t end) {
                        // Independent lanes.
                        constexpr std::size_t lanes = 12;
                        const double *const entries = b[begin].data(), *const last =
                                                                           entries + 3 * (end - begin);
                        double largest[lanes] = {};
                        const double* entry = entries;
                        for (; entry + lanes <= last; entry += lanes)
                          for (std::size_t l = 0; l < lanes; ++l)
                            largest[l] = std::max(largest[l], std::abs(entry[l]));
                        for (; entry < last; ++entry) largest[0] = std::max(largest[0], std::abs(*entry));
                        return Largest{*std::max_element(largest, largest + lanes)};
                      })
      .value;
}

}  // namespace

void PcgSolver::linearize(const IncrementalPotential& function, ConstVectors x) {
  function.linearize(x, h_);
  stiffest_ = system_.factor(h_);
  projected_ = false;
  rest_positions_ = function.rest_positions();
}

int PcgSolver::patience() const {
  return h_.matrices().empty() ? patience_of_couplings : patience_of_matrices;
}

/// False where there is none.
bool PcgSolver::prepare_coarse_space() {
  if (rest_positions_.size() != h_.size()) return false;
  if (!coarse_space_ || !coarse_space_->fits(h_, rest_positions_)) {
    coarse_space_ = std::make_unique<CoarseSpace>(h_, rest_positions_);
    assembled_ = false;
  }
  if (coarse_space_->empty()) return false;
  if (!assembled_) {
    h_.fill_stand_ins();
    coarse_space_->assemble(h_);
  }
  assembled_ = true;
  return true;
}

void PcgSolver::precondition(ConstVectors b, Vectors z) {
  const double scale = largest_entry(b);
  if (scale == 0) return std::fill(z.begin(), z.end(), Vec3::Zero());
  system_.start(b, 1 / scale);
  system_.precondition(scale, z);
}

bool PcgSolver::project() {
  if (projected_) return false;
  h_.project();
  system_.factor(h_);
  projected_ = true;
  return true;
}

LinearReport PcgSolver::solve(ConstVectors b, const LinearSettings& settings, Vectors s, double& norm) {
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
  double alpha = 0;
  double before = 0;  // rᵀP⁻¹r of the iteration before; 0: conjugate to nothing yet
  bool corrected = false;
  const auto expected = [&] { return -std::log10(settings.tolerance) * iterations_a_decade_; };
  const auto observe = [&] {
    const double decades = std::max(0.5 * std::log10(first / rr), 0.1);
    if (!corrected && report.iterations > 2) iterations_a_decade_ = report.iterations / decades;
  };
  while (report.iterations < settings.max_iterations) {
    const bool lengthy = report.iterations == 0 ? expected() > patience() : report.iterations == patience();
    if (!corrected && lengthy && prepare_coarse_space()) {
      observe();
      system_.find_product();
      corrected = true;
      before = 0;
    }
    double rz = rr;
    if (corrected) rz += coarse_space_->correct(system_.product(), system_.correction());
    const double beta = before > 0 ? rz / before : 0;
    const double curvature =
        corrected ? system_.corrected_direction(alpha, beta) : system_.direction(alpha, beta);
    alpha = 0;
    ++report.iterations;
    // H is unusable here, or its couplings are so indefinite that the factorisation grows without bound.
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
    alpha = rz / curvature;
    rr = corrected ? system_.residual_and_product(alpha) : system_.residual(alpha);
    before = rz;
    if (rr <= stop) {
      report.converged = true;
      break;
    }
  }
  observe();
  system_.solution(alpha, scale, s);
  report.relative_residual = first > 0 ? std::sqrt(rr / first) : 0;
  return report;
}

}  // namespace muslin
