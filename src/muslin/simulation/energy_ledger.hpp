// EnergyLedger is the energy account of a run: the energy stored by each term, and the work and losses since
// the start.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "muslin/contact/contact_potential.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/potential/potential.hpp"
#include "muslin/potential/state.hpp"
#include "muslin/scene/model.hpp"
#include "muslin/simulation/energy_account.hpp"

namespace muslin {

/// All terms of a run: the potentials of its model, then the loads of its model, then added loads. Slots
/// number them in this order.
struct Terms {
  std::span<const PotentialTerm> potentials;
  std::span<const LoadTerm> loads;

  std::size_t size() const { return potentials.size() + loads.size(); }
  EnergyRole role(std::size_t slot) const {
    return slot < potentials.size() ? potentials[slot].role : loads[slot - potentials.size()].role;
  }
  /// Returns the potential of each load in a step; null where it does not act.
  std::vector<std::unique_ptr<Potential>> potentials_of_loads(const StepContext& context) const;
  /// Returns those of the loads that drive; null for all others.
  std::vector<std::unique_ptr<Potential>> driving_potentials(const StepContext& context) const;
  /// Returns hashes of the names, #slots.
  std::vector<std::uint64_t> keys() const;
};

/// Part of the state of a run.
struct EnergyLedger {
  double work = 0, dissipated = 0;   ///< since the start [J]
  double unbalanced = 0;             ///< since the start [J]
  double material_work = 0;          ///< share of `work` by changes of the material's numbers [J]
  double contact_energy = 0;         ///< [J]
  std::vector<std::uint64_t> terms;  ///< the terms of `stored`, by Terms::keys
  std::vector<double> stored;        ///< energy of each, 0 for roles that store none [J]

  template <class Self, class Arrays>
  static void name_arrays(Self& self, Arrays& arrays) {
    arrays("energy.work", self.work);
    arrays("energy.dissipated", self.dissipated);
    arrays("energy.unbalanced", self.unbalanced);
    arrays("energy.material_work", self.material_work);
    arrays("energy.pressed", self.contact_energy);
    arrays("energy.terms", self.terms);
    arrays("energy.stored", self.stored);
  }

  /// Returns the energy that all terms of one role store, without contact [J].
  double sum(const Terms& acting, EnergyRole role) const;

  /// Records the energy stored at `positions`, with fields and numbers as in the step of `context`.
  void measure(const Terms& acting, const StepContext& context, ConstVectors positions);

  /// Adds a step; `step.acts` is filled in here. `loads`: the potentials of the loads in the step. `contact`:
  /// the potential of contact, null if nothing can touch. Returns EnergyFlow::reactions.
  std::vector<Vec3> enter(const Terms& acting, SolvedStep step,
                          std::span<const std::unique_ptr<Potential>> loads, const ContactPotential* contact);

  /// Continues with other terms, from `positions`: the energy of terms with the same name is kept; the change
  /// of energy counts as work.
  void go_on_with(const Terms& acting, ConstVectors positions);

 private:
  /// Sets the energy stored by a term that has changed at constant positions; the change is work.
  void change(std::size_t slot, EnergyRole role, double now);
};

}  // namespace muslin
