#include "verify_watch.hpp"

#include <algorithm>

namespace muslin::app {
namespace {

double energy(const Diagnostics& row) { return row.kinetic + row.elastic + row.potential; }

}  // namespace

Watch::Watch(const Simulation& simulation)
    : start_potential_(simulation.diagnostics().potential),
      least_energy_(energy(simulation.diagnostics())),
      least_balance_(simulation.diagnostics().balance()) {}

void Watch::look(const Simulation& simulation) {
  const Diagnostics& row = simulation.diagnostics();
  fallen_ = std::max(fallen_, start_potential_ - row.potential);
  gained_ = std::max(gained_, energy(row) - least_energy_);
  if (fallen_ > 0) gained_share_ = std::max(gained_share_, gained_ / fallen_);
  least_energy_ = std::min(least_energy_, energy(row));
  balance_gained_ = std::max(balance_gained_, row.balance() - least_balance_);
  least_balance_ = std::min(least_balance_, row.balance());
  largest_kinetic_ = std::max(largest_kinetic_, row.kinetic);
  largest_stretch_ = std::max(largest_stretch_, row.max_stretch);
  unconverged_steps_ += row.steps - row.converged_steps;
  max_held_back_ = std::max(max_held_back_, row.held_back);
}

void Watch::advance(Simulation& simulation, int frames) {
  for (int frame = 0; frame < frames; ++frame) {
    simulation.advance();
    look(simulation);
  }
}

}  // namespace muslin::app
