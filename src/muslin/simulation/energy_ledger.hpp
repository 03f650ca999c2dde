// The energy of a run so far: what is stored where, and what came and went since the start.
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

/// All that acts in a run: the potentials of its model, then its loads, those that were added last. Slots
/// number them in this order.
struct Terms {
  std::span<const PotentialTerm> potentials;
  std::span<const LoadTerm> loads;

  std::size_t size() const { return potentials.size() + loads.size(); }
  EnergyRole role(std::size_t slot) const {
    return slot < potentials.size() ? potentials[slot].role : loads[slot - potentials.size()].role;
  }
  /// The potential of each load in a step; null where it does not act.
  std::vector<std::unique_ptr<Potential>> potentials_of_loads(const StepContext& context) const;
  /// Hashes of the names, #slots.
  std::vector<std::uint64_t> keys() const;
};

/// Part of the state of a run.
struct EnergyLedger {
  double work = 0, dissipated = 0;   ///< since the start [J]
  double unbalanced = 0;             ///< since the start [J]
  double contact_energy = 0;         ///< [J]
  std::vector<std::uint64_t> terms;  ///< which `stored` is about, by Terms::keys
  std::vector<double> stored;        ///< of each of these, 0 where its role is not to store [J]

  template <class Self, class Arrays>
  static void name_arrays(Self& self, Arrays& arrays) {
    arrays("energy.work", self.work);
    arrays("energy.dissipated", self.dissipated);
    arrays("energy.unbalanced", self.unbalanced);
    arrays("energy.pressed", self.contact_energy);
    arrays("energy.terms", self.terms);
    arrays("energy.stored", self.stored);
  }

  /// The energy that all terms of one role store, without contact [J].
  double sum(const Terms& acting, EnergyRole role) const;

  /// Takes down what is stored at `positions`, fields as they are in the step that `context` begins.
  void measure(const Terms& acting, const StepContext& context, ConstVectors positions);

  /// Enters a step; `step.acts` are filled in here. `loads`: what the loads amounted to in it. `contact`:
  /// the potential of contact, null if nothing can touch.
  void enter(const Terms& acting, SolvedStep step, std::span<const std::unique_ptr<Potential>> loads,
             const ContactPotential* contact);

  /// Goes on with other terms than the ledger was kept for, from `positions`: the energy of terms with the
  /// same name stays, what has changed between counts as work.
  void go_on_with(const Terms& acting, ConstVectors positions);
};

}  // namespace muslin
