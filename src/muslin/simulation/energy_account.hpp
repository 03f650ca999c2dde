// energy_flow computes the energy that a step stored, received from outside, or lost.
// docs/theory/energy-balance.md derives the sums; each follows from the integrator's discrete equation of
// motion
//
//   M (x₁ − x̃)/dt² + Σᵢ gᵢ = R,     R zero at free vertices and the reaction at held ones,
//
// multiplied by the displacement Δ = x₁ − x₀ of the step.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "muslin/potential/potential.hpp"
#include "muslin/potential/state.hpp"
#include "muslin/scene/model.hpp"
#include "muslin/solver/solver.hpp"

namespace muslin {

inline bool is_stored(EnergyRole role) {
  return role == EnergyRole::elastic || role == EnergyRole::joint || role == EnergyRole::potential;
}

/// True if a load of this role sets bodies in motion.
inline bool drives(EnergyRole role) { return role == EnergyRole::potential || role == EnergyRole::work; }

/// A potential of the step, with its role in the balance.
struct ActingPotential {
  EnergyRole role = EnergyRole::elastic;
  const Potential* potential = nullptr;
  /// Energy stored at the beginning of the step [J]; 0 for roles that store none.
  double before = 0;
  /// Energy stored at the end, if it differs from the value of the potential: contact lags some parts,
  /// plastic work is lost [J].
  std::optional<double> after = std::nullopt;
};

/// A step that has been solved.
struct SolvedStep {
  Integrator integrator = Integrator::implicit_euler;
  double length = 0;                      ///< [s]
  const StepContext* context = nullptr;   ///< as it was solved
  const State* before = nullptr;          ///< at its beginning
  const State* after = nullptr;           ///< at its end
  std::span<const double> masses;         ///< #V [kg]
  std::span<const std::uint8_t> fixed;    ///< #V, 1 where held
  std::span<const ActingPotential> acts;  ///< the potentials that acted
  bool wants_reactions = false;
};

/// Energies [J] that entered or left the system during a step.
struct EnergyFlow {
  double work = 0;             ///< done by loads and by held vertices that moved
  double dissipated = 0;       ///< by damping, internal friction and the integrator; < 0 if it adds energy
  double unbalanced = 0;       ///< work of the forces at free vertices that the solver left out of balance
  std::vector<double> stored;  ///< by each of `acts` at the end; 0 for roles that store none
  /// #V, the forces that hold the held vertices [N]; empty unless the step wants them.
  std::vector<Vec3> reactions;
};

/// Returns the flow of one step.
EnergyFlow energy_flow(const SolvedStep& step);

double kinetic_energy(std::span<const double> masses, ConstVectors velocities);  ///< ½ Σ m |v|² [J]
Vec3 total_momentum(std::span<const double> masses, ConstVectors velocities);    ///< Σ m v [kg·m/s]

}  // namespace muslin
