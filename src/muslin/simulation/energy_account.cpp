#include "muslin/simulation/energy_account.hpp"

#include <algorithm>

#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

constexpr std::size_t grain = 4096;

double dot(ConstVectors a, ConstVectors b) {
  return parallel_sum(a.size(), grain, 0.0, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t v = begin; v < end; ++v) sum += a[v].dot(b[v]);
    return sum;
  });
}

bool is_implicit(Integrator integrator) {
  return integrator == Integrator::implicit_euler || integrator == Integrator::bdf2;
}

/// Adds the generalised force gᵢ that the integrator uses for a potential: the gradient at the end of the
/// step, its linearisation about the beginning, or the gradient at the beginning. Returns the energy that the
/// potential stores at the end [J].
double act_in(const SolvedStep& step, const ActingPotential& act, ConstVectors displacement, Vectors g) {
  const Potential& potential = *act.potential;
  const std::vector<Vec3>&before = step.before->positions, &after = step.after->positions;
  const bool by_value = is_stored(act.role) && !act.after;
  if (is_implicit(step.integrator) && by_value) return potential.add_gradient_and_value(after, g);
  potential.add_gradient(is_implicit(step.integrator) ? after : before, g);
  if (step.integrator == Integrator::linearly_implicit_euler)
    potential.add_hessian_product(before, displacement, g);
  return by_value ? potential.value(after) : act.after.value_or(0);
}

}  // namespace

EnergyFlow energy_flow(const SolvedStep& step) {
  const std::size_t count = step.masses.size();
  const State& before = *step.before;
  const State& after = *step.after;
  EnergyFlow flow;

  std::vector<Vec3> displacement(count), g(count), total(count, Vec3::Zero());
  parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) displacement[v] = after.positions[v] - before.positions[v];
  });

  for (const ActingPotential& act : step.acts) {
    std::fill(g.begin(), g.end(), Vec3::Zero());
    const double stored = act_in(step, act, displacement, g);
    flow.stored.push_back(stored);
    parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) total[v] += g[v];
    });
    const double spent = dot(g, displacement);
    if (act.role == EnergyRole::work || act.role == EnergyRole::support) {
      flow.work -= spent;
    } else {
      flow.dissipated += spent - (is_stored(act.role) ? stored - act.before : 0);
    }
  }

  const bool all_euler = step.integrator != Integrator::bdf2;
  const std::vector<std::uint8_t>& rigidly_rotated = step.context->rigidly_rotated;
  const double tau = step.context->dt;
  struct Sums {
    double loss = 0, reaction = 0, residual = 0;
    Sums operator+(const Sums& other) const {
      return {loss + other.loss, reaction + other.reaction, residual + other.residual};
    }
  };
  if (step.wants_reactions) flow.reactions.assign(count, Vec3::Zero());
  const Sums sums = parallel_sum(count, grain, Sums{}, [&](std::size_t begin, std::size_t end) {
    Sums sum;
    for (std::size_t v = begin; v < end; ++v) {
      const Vec3& v0 = before.velocities[v];
      const Vec3& v1 = after.velocities[v];
      // The velocities of a rotating body are not differences of positions.
      const bool euler = all_euler && (rigidly_rotated.empty() || rigidly_rotated[v] == 0);
      // The prediction of symplectic Euler is used only by loads; its inertia follows from the velocities.
      const Vec3 acceleration =
          euler ? Vec3((v1 - v0) / step.length)
                : Vec3((after.positions[v] - step.context->inertial_prediction[v]) / (tau * tau));
      const Vec3 inertia = step.masses[v] * acceleration;
      sum.loss += euler ? 0.5 * step.masses[v] * (v1 - v0).squaredNorm()
                        : inertia.dot(displacement[v]) - 0.5 * step.masses[v] * (v1 - v0).dot(v1 + v0);
      (step.fixed[v] ? sum.reaction : sum.residual) += (inertia + total[v]).dot(displacement[v]);
      if (step.wants_reactions && step.fixed[v]) flow.reactions[v] = inertia + total[v];
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
