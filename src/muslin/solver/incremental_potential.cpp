#include "muslin/solver/incremental_potential.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "muslin/solver/vector_operations.hpp"

namespace muslin {
namespace {

void set_zero(Vectors y) { std::fill(y.begin(), y.end(), Vec3::Zero()); }

}  // namespace

IncrementalPotential::IncrementalPotential(const StepProblem& problem, ConstVectors prediction, double dt)
    : problem_(problem), prediction_(prediction), dt_(dt) {}

IncrementalPotential::Value IncrementalPotential::value(ConstVectors x) const {
  const double inertia = parallel_sum(size(), vector_grain, 0.0, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t v = begin; v < end; ++v) {
      sum += 0.5 * problem_.masses[v] * (x[v] - prediction_[v]).squaredNorm();
    }
    return sum;
  });
  Value result{inertia, inertia};
  for (const Potential* potential : problem_.potentials) {
    const double w = dt_ * dt_ * potential->value(x);
    result.value += w;
    result.magnitude += std::abs(w);
  }
  return result;
}

void IncrementalPotential::gradient(ConstVectors x, Vectors g) const {
  set_zero(g);
  for (const Potential* potential : problem_.potentials) potential->add_gradient(x, g);
  parallel_for(size(), vector_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      g[v] = held(v) ? Vec3(Vec3::Zero())
                     : Vec3(dt_ * dt_ * g[v] + problem_.masses[v] * (x[v] - prediction_[v]));
    }
  });
}

void IncrementalPotential::hessian_product(ConstVectors x, ConstVectors p, Vectors y) const {
  set_zero(y);
  for (const Potential* potential : problem_.potentials) potential->add_hessian_product(x, p, y);
  parallel_for(size(), vector_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      y[v] = held(v) ? Vec3(Vec3::Zero()) : Vec3(dt_ * dt_ * y[v] + problem_.masses[v] * p[v]);
    }
  });
}

void IncrementalPotential::diagonal_blocks(ConstVectors x, std::span<Mat3> blocks) const {
  std::fill(blocks.begin(), blocks.end(), Mat3::Zero());
  for (const Potential* potential : problem_.potentials) potential->add_diagonal_blocks(x, blocks);
  parallel_for(size(), vector_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      if (held(v)) {
        blocks[v].setZero();
      } else {
        blocks[v] *= dt_ * dt_;
      }
      blocks[v].diagonal().array() += problem_.masses[v];
    }
  });
}

void IncrementalPotential::linearize(ConstVectors x, Linearization& into) const {
  into.reset(problem_.masses, problem_.fixed, dt_ * dt_);
  for (const Potential* potential : problem_.potentials) potential->linearize(x, into, 0);
  into.finish();
}

double IncrementalPotential::max_step(ConstVectors x, ConstVectors d) const {
  double t = std::numeric_limits<double>::infinity();
  for (const Potential* potential : problem_.potentials) t = std::min(t, potential->max_step(x, d));
  return t;
}

IncrementalPotential::Imbalance IncrementalPotential::imbalance(ConstVectors g) const {
  Imbalance worst;
  for (std::size_t v = 0; v < size(); ++v) {
    if (held(v)) continue;
    const double acceleration = g[v].norm() / (problem_.masses[v] * dt_ * dt_);
    // A NaN must not hide: it compares false with everything.
    if (!(acceleration <= worst.largest)) worst = {acceleration, static_cast<int>(v)};
    if (std::isnan(acceleration)) break;
  }
  return worst;
}

double IncrementalPotential::rounding_floor(ConstVectors x, double stiffest) const {
  constexpr double half_ulp = std::numeric_limits<double>::epsilon() / 2;
  double farthest = 0;  // largest coordinate [m]
  for (const Vec3& p : x) farthest = std::max(farthest, p.lpNorm<Eigen::Infinity>());
  // Neighbours' couplings add up to no more than the diagonal block again.
  return 2 * stiffest / (dt_ * dt_) * farthest * half_ulp;
}

}  // namespace muslin
