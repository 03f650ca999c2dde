#include "muslin/simulation/energy_account.hpp"

#include <array>
#include <cmath>

#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

constexpr std::size_t grain = 4096;

/// Nodes and weights of Gauss–Legendre quadrature on [0, 1]: exact for polynomials of degree 5.
struct Node {
  double at, weight;
};
const std::array<Node, 3> gauss = {
    {{0.5 - 0.5 * std::sqrt(0.6), 5.0 / 18}, {0.5, 8.0 / 18}, {0.5 + 0.5 * std::sqrt(0.6), 5.0 / 18}}};

double dot(ConstVectors a, ConstVectors b) {
  return parallel_sum(a.size(), grain, 0.0, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t v = begin; v < end; ++v) sum += a[v].dot(b[v]);
    return sum;
  });
}

void clear(std::vector<Vec3>& vectors) { std::fill(vectors.begin(), vectors.end(), Vec3::Zero()); }

/// The generalised force gᵢ with which the integrator lets a potential act: the gradient at the end of the
/// step, its linearisation about the beginning, or the gradient at the beginning.
void add_acting_gradient(const SolvedStep& step, const Potential& potential, ConstVectors displacement,
                         Vectors g) {
  switch (step.integrator) {
    case Integrator::implicit_euler:
    case Integrator::bdf2:
      potential.add_gradient(step.after->positions, g);
      return;
    case Integrator::linearly_implicit_euler:
      potential.add_gradient(step.before->positions, g);
      potential.add_hessian_product(step.before->positions, displacement, g);
      return;
    case Integrator::symplectic_euler:
      potential.add_gradient(step.before->positions, g);
      return;
  }
}

}  // namespace

EnergyFlow energy_flow(const SolvedStep& step) {
  const std::size_t count = step.masses.size();
  const State& before = *step.before;
  const State& after = *step.after;
  EnergyFlow flow;

  std::vector<Vec3> displacement(count), g(count), total(count, Vec3::Zero()), point(count);
  parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) displacement[v] = after.positions[v] - before.positions[v];
  });

  for (const ActingPotential& act : step.acts) {
    clear(g);
    add_acting_gradient(step, *act.potential, displacement, g);
    parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) total[v] += g[v];
    });
    const double spent = dot(g, displacement);
    if (act.role == EnergyRole::work) {
      flow.work -= spent;
    } else if (act.role == EnergyRole::dissipation) {
      flow.dissipated += spent;
    } else if (act.gain) {
      flow.dissipated += spent - *act.gain;
    } else {
      double stored = 0;
      for (const Node& node : gauss) {
        parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
          for (std::size_t v = begin; v < end; ++v) {
            point[v] = before.positions[v] + node.at * displacement[v];
            g[v].setZero();
          }
        });
        act.potential->add_gradient(point, g);
        stored += node.weight * dot(g, displacement);
      }
      flow.dissipated += spent - stored;
    }
  }

  const bool all_euler = step.integrator != Integrator::bdf2;
  const std::vector<std::uint8_t>& turned = step.context->turned;
  const double tau = step.context->dt;
  struct Sums {
    double loss = 0, reaction = 0, residual = 0;
    Sums operator+(const Sums& other) const {
      return {loss + other.loss, reaction + other.reaction, residual + other.residual};
    }
  };
  const Sums sums = parallel_sum(count, grain, Sums{}, [&](std::size_t begin, std::size_t end) {
    Sums sum;
    for (std::size_t v = begin; v < end; ++v) {
      const Vec3& v0 = before.velocities[v];
      const Vec3& v1 = after.velocities[v];
      // A turning body's velocities are no differences of positions.
      const bool euler = all_euler && (turned.empty() || turned[v] == 0);
      // The prediction of symplectic Euler is of use only to loads; its inertia is that of its velocities.
      const Vec3 acceleration =
          euler ? Vec3((v1 - v0) / step.length)
                : Vec3((after.positions[v] - step.context->inertial_prediction[v]) / (tau * tau));
      const Vec3 inertia = step.masses[v] * acceleration;
      sum.loss += euler ? 0.5 * step.masses[v] * (v1 - v0).squaredNorm()
                        : inertia.dot(displacement[v]) - 0.5 * step.masses[v] * (v1 - v0).dot(v1 + v0);
      (step.fixed[v] ? sum.reaction : sum.residual) += (inertia + total[v]).dot(displacement[v]);
    }
    return sum;
  });
  flow.dissipated += sums.loss;
  flow.work += sums.reaction;
  flow.unbalanced = sums.residual;
  return flow;
}

double kinetic_energy(std::span<const double> masses, ConstVectors velocities) {
  return parallel_sum(masses.size(), grain, 0.0, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t v = begin; v < end; ++v) sum += 0.5 * masses[v] * velocities[v].squaredNorm();
    return sum;
  });
}

Vec3 total_momentum(std::span<const double> masses, ConstVectors velocities) {
  return parallel_sum(masses.size(), grain, Vec3(Vec3::Zero()), [&](std::size_t begin, std::size_t end) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t v = begin; v < end; ++v) sum += masses[v] * velocities[v];
    return sum;
  });
}

}  // namespace muslin
