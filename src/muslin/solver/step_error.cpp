#include "muslin/solver/step_error.hpp"

#include <algorithm>
#include <cmath>

#include "muslin/potential/stopping_time.hpp"
#include "muslin/solver/part_sums.hpp"

namespace muslin {
namespace {

/// The error of a single vertex may be the allowed error of its part divided by this.
constexpr double local_share = 0.03;
/// M⁻¹ g bounds the error only where potentials are convex: it must be at most this share of the allowed
/// error.
constexpr double bound_share = 0.1;
/// An error of this share of an edge is always allowed.
constexpr double smallest = 1e-14;
/// Bound on the work of the residual over Σ m |Δx|², as a multiple of the tolerance: correct_work can remove
/// this much. Twice the energy of springs of yielding vertices, times dt², is added to the sum: they press
/// with forces beside which those of inertia are nothing.
constexpr double leak_share = 0.01;
constexpr double slowest = 0.9;
/// The linear system was solved for a part if |s| is at least this share of |P⁻¹g|.
constexpr double solved_share = 0.5;

}  // namespace

template <class Sum, class Add>
std::vector<Sum> StepError::sum(const Add& add) const {
  return sum_by_part<Sum>(function_.size(), parts_.size(), [this](std::size_t v) { return part_of(v); }, add);
}

StepError::StepError(const StepProblem& problem, const IncrementalPotential& function, double tolerance)
    : problem_(problem), function_(function), tolerance_(tolerance) {
  std::size_t count = 1;
  for (const int part : problem.parts) count = std::max(count, static_cast<std::size_t>(part) + 1);
  parts_.resize(count);
  counts_.resize(function.size());
  for (std::size_t v = 0; v < function.size(); ++v) counts_[v] = function.held(v) ? 0 : 1;
  for (const int v : problem.yielding.vertices) counts_[static_cast<std::size_t>(v)] = 0;
  for (std::size_t v = 0; v < function.size(); ++v)
    if (counts(v)) parts_[part_of(v)].mass += problem.masses[v];
}

void StepError::find_allowed(ConstVectors x) {
  const double dt = function_.dt();
  const auto squares = sum<double>([&](double& square, std::size_t v) {
    if (counts(v)) square += problem_.masses[v] * (x[v] - function_.prediction()[v]).squaredNorm();
  });
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    Part& part = parts_[p];
    if (!(part.mass > 0)) continue;
    double motion = std::sqrt(squares[p] / part.mass);
    const double settling = problem_.guard ? std::min(dt, stopping_time) : dt;
    if (p < problem_.accelerations.size())
      motion = std::max(motion, problem_.accelerations[p] * settling * settling);
    const double edge = p < problem_.edges.size() ? problem_.edges[p] : motion;
    part.allowed = std::max(tolerance_ * std::min(motion, edge), smallest * edge);
  }
}

bool StepError::bound(ConstVectors x, ConstVectors g) {
  find_allowed(x);
  const auto squares = sum<double>([&](double& square, std::size_t v) {
    if (counts(v)) square += g[v].squaredNorm() / problem_.masses[v];
  });
  bool good = true;
  largest_ = 0;
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    if (!(parts_[p].mass > 0)) continue;
    const double error = std::sqrt(squares[p] / parts_[p].mass);
    largest_ = std::max(largest_, error);
    good = good && error <= bound_share * parts_[p].allowed;
  }
  return good;
}

void StepError::begin(ConstVectors g, ConstVectors z) {
  struct Sums {
    double norm = 0, foretold = 0;
    void operator+=(const Sums& other) { norm += other.norm, foretold += other.foretold; }
  };
  const auto sums = sum<Sums>([&](Sums& s, std::size_t v) {
    if (!counts(v)) return;
    s.norm += g[v].dot(z[v]);
    s.foretold += problem_.masses[v] * z[v].squaredNorm();
  });
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    parts_[p].norm = sums[p].norm;
    parts_[p].foretold = sums[p].foretold;
  }
}

bool StepError::end(ConstVectors x, ConstVectors from, ConstVectors g, ConstVectors z, ConstVectors s,
                    ConstVectors d, double t) {
  struct Sums {
    double norm = 0, step = 0, gone = 0, cut = 0, largest_step = 0, largest_cut = 0, leak = 0, moved = 0;
    void operator+=(const Sums& other) {
      norm += other.norm, step += other.step, gone += other.gone, cut += other.cut;
      largest_step = std::max(largest_step, other.largest_step);
      largest_cut = std::max(largest_cut, other.largest_cut);
      leak += other.leak, moved += other.moved;
    }
  };
  find_allowed(x);
  const auto sums = sum<Sums>([&](Sums& part, std::size_t v) {
    if (!counts(v)) return;
    const double m = problem_.masses[v], step = s[v].squaredNorm(), cut = (s[v] - t * d[v]).squaredNorm();
    const Vec3 moved = x[v] - from[v];
    part.norm += g[v].dot(z[v]);
    part.step += m * step;
    part.gone += m * t * t * d[v].squaredNorm();
    part.cut += m * cut;
    part.largest_step = std::max(part.largest_step, step);
    part.largest_cut = std::max(part.largest_cut, cut);
    part.leak += g[v].dot(moved);
    part.moved += m * moved.squaredNorm();
  });
  bool good = true;
  const Potential* yielding = problem_.yielding.springs;
  const double held = yielding ? 2 * function_.dt() * function_.dt() * yielding->value(x) : 0;
  largest_ = worst_ratio_ = 0;
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    Part& part = parts_[p];
    const Sums& sum = sums[p];
    if (!(part.mass > 0)) continue;
    // Rounding may make the preconditioner indefinite. Then the ratio is meaningless, and 1 is safe.
    const double fallen = sum.norm / part.norm;
    double ratio = part.norm == 0 ? 0 : fallen >= 0 ? std::sqrt(fallen) : 1;
    if (part.gone > 0 && sum.step >= solved_share * solved_share * part.foretold)
      ratio = std::min(ratio, std::sqrt(sum.step / part.gone));
    part.gone = sum.gone;
    const double left = ratio / (1 - std::min(ratio, slowest));
    const double mean = (left * std::sqrt(sum.step) + std::sqrt(sum.cut)) / std::sqrt(part.mass);
    const double local = left * std::sqrt(sum.largest_step) + std::sqrt(sum.largest_cut);
    const double error = std::max(mean, local_share * local);
    const double moved =
        sum.moved + part.mass * part.allowed * part.allowed / (tolerance_ * tolerance_) + held;
    good = good && error <= part.allowed && std::abs(sum.leak) <= leak_share * tolerance_ * moved;
    if (error >= worst_ratio_ * part.allowed) {
      worst_ratio_ = error / part.allowed;
      largest_ = error;
    }
  }
  return good;
}

void StepError::give_up(ConstVectors s) {
  largest_ = 0;
  for (std::size_t v = 0; v < s.size(); ++v)
    if (counts(v)) largest_ = std::max(largest_, local_share * s[v].norm());
}

double StepError::wanted_forcing() const { return worst_ratio_ > 0 ? 0.3 / worst_ratio_ : 1; }

}  // namespace muslin
