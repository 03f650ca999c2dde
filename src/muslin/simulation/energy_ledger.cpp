#include "muslin/simulation/energy_ledger.hpp"

#include <utility>

#include "muslin/core/hash.hpp"

namespace muslin {

std::vector<std::unique_ptr<Potential>> Terms::potentials_of_loads(const StepContext& context) const {
  std::vector<std::unique_ptr<Potential>> found;
  for (const LoadTerm& term : loads) found.push_back(term.load->potential(context));
  return found;
}

std::vector<std::unique_ptr<Potential>> Terms::driving_potentials(const StepContext& context) const {
  std::vector<std::unique_ptr<Potential>> found;
  for (const LoadTerm& term : loads)
    found.push_back(drives(term.role) ? term.load->potential(context) : nullptr);
  return found;
}

std::vector<std::uint64_t> Terms::keys() const {
  std::vector<std::uint64_t> keys;
  for (const PotentialTerm& term : potentials) keys.push_back(hash_bytes(term.name.data(), term.name.size()));
  for (const LoadTerm& term : loads) keys.push_back(hash_bytes(term.name.data(), term.name.size()));
  return keys;
}

double EnergyLedger::sum(const Terms& acting, EnergyRole role) const {
  double sum = 0;
  for (std::size_t slot = 0; slot < stored.size(); ++slot)
    if (acting.role(slot) == role) sum += stored[slot];
  return sum;
}

void EnergyLedger::measure(const Terms& acting, const StepContext& context, ConstVectors positions) {
  terms = acting.keys();
  stored.clear();
  for (const PotentialTerm& term : acting.potentials)
    stored.push_back(is_stored(term.role) ? term.potential->value(positions) : 0.0);
  for (const LoadTerm& term : acting.loads) {
    const auto load = is_stored(term.role) ? term.load->potential(context) : nullptr;
    stored.push_back(load ? load->value(positions) : 0.0);
  }
}

std::vector<Vec3> EnergyLedger::enter(const Terms& acting, SolvedStep step,
                                      std::span<const std::unique_ptr<Potential>> loads,
                                      const ContactPotential* contact) {
  const std::vector<Vec3>&before = step.before->positions, &after = step.after->positions;
  std::vector<ActingPotential> acts;
  std::vector<std::size_t> slots;  // of the acts
  for (std::size_t slot = 0; slot < acting.potentials.size(); ++slot) {
    const PotentialTerm& term = acting.potentials[slot];
    acts.push_back({term.role, term.potential.get(), stored[slot]});
    slots.push_back(slot);
  }
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const std::size_t slot = acting.potentials.size() + i;
    const EnergyRole role = acting.role(slot);
    // A field that is switched or turned while a body is in it does work on the body, and so does a material
    // that stiffens.
    if (is_stored(role)) change(slot, role, loads[i] ? loads[i]->value(before) : 0.0);
    if (!loads[i]) continue;
    ActingPotential act{role, loads[i].get(), stored[slot]};
    const double lost = is_stored(role) ? loads[i]->dissipated(after) : 0;
    if (lost != 0) act.after = loads[i]->value(after) - lost;
    acts.push_back(act);
    slots.push_back(slot);
  }
  if (contact) acts.push_back({EnergyRole::elastic, contact, contact_energy, contact->parts(after).normal});
  step.acts = acts;
  EnergyFlow flow = energy_flow(step);
  for (std::size_t k = 0; k < slots.size(); ++k) stored[slots[k]] = flow.stored[k];
  if (contact) contact_energy = flow.stored.back();
  work += flow.work;
  dissipated += flow.dissipated;
  unbalanced += flow.unbalanced;
  return std::move(flow.reactions);
}

void EnergyLedger::go_on_with(const Terms& acting, ConstVectors positions) {
  const std::vector<std::uint64_t> earlier_terms = std::exchange(terms, acting.keys());
  std::vector<double> earlier = std::exchange(stored, std::vector<double>(acting.size(), 0.0));
  earlier.resize(earlier_terms.size());
  std::vector<bool> used(earlier.size(), false);
  for (std::size_t i = 0; i < terms.size(); ++i) {
    for (std::size_t j = 0; j < earlier.size(); ++j) {
      if (used[j] || earlier_terms[j] != terms[i]) continue;
      used[j] = true;
      stored[i] = earlier[j];
      break;
    }
  }
  // Energy that changed because the scene was changed in between counts as external work.
  for (std::size_t j = 0; j < earlier.size(); ++j)
    if (!used[j]) work -= earlier[j];
  for (std::size_t i = 0; i < acting.potentials.size(); ++i) {
    const PotentialTerm& term = acting.potentials[i];
    if (is_stored(term.role)) change(i, term.role, term.potential->value(positions));
  }
}

void EnergyLedger::change(std::size_t slot, EnergyRole role, double now) {
  const double done = now - stored[slot];
  work += done;
  if (role == EnergyRole::elastic) material_work += done;
  stored[slot] = now;
}

}  // namespace muslin
