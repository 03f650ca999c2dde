// Moves vertices of a simulation by hand, between two steps.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "muslin/contact/crossings.hpp"
#include "muslin/core/error.hpp"
#include "muslin/simulation/simulation_impl.hpp"

namespace muslin {
namespace {

void require_count(ConstVectors vectors, std::size_t count, const char* what) {
  if (vectors.size() == count) return;
  throw Error(ErrorKind::usage, fmt::format("{} {} for {} vertices", vectors.size(), what, count),
              "give one for each vertex of all bodies, in the order of the state");
}

}  // namespace

void Simulation::Impl::keep_prescribed(ConstVectors from, Vectors to) const {
  for (const Prescribed& motion : model->prescribed) {
    const auto first = static_cast<std::size_t>(motion.first), count = motion.start.size();
    std::copy_n(from.subspan(first, count).begin(), count, to.subspan(first, count).begin());
  }
}

void Simulation::Impl::put(State changed) {
  const auto energy = [&] {
    double sum = kinetic_energy(model->masses, state.motion.velocities) + state.energy.contact_energy;
    for (const double stored : state.energy.stored) sum += stored;
    return sum;
  };
  const double before = energy();
  const bool moved = changed.positions != state.motion.positions;
  state.motion = std::move(changed);
  state.motion.previous_positions.clear();
  state.motion.previous_velocities.clear();
  state.motion.previous_dt = 0;
  if (moved) {
    state.holds.reanchor(model->pins, state.motion.time, state.motion.positions);
    if (model->contact) touch(options.allow_tangled);
  }
  measure_energy();
  state.energy.work += energy() - before;
  if (state.steps_done > 0) return;
  describe_state(state.diagnostics);
  if (model->contact && moved) state.diagnostics.min_distance = state.contact.smallest_gap;
}

void Simulation::set_positions(ConstVectors positions) {
  Impl& impl = *impl_;
  const std::vector<Vec3>& now = impl.state.motion.positions;
  require_count(positions, now.size(), "positions");
  const int lost = vertex_out_of_range(positions);
  if (lost >= 0) {
    throw Error(ErrorKind::usage,
                fmt::format("the position of vertex {} is not finite or beyond {:.2g} m", lost, farthest),
                "give finite positions in metres");
  }
  State changed = impl.state.motion;
  changed.positions.assign(positions.begin(), positions.end());
  impl.keep_prescribed(now, changed.positions);
  if (impl.model->contact && !impl.options.allow_tangled)
    refuse_crossings(*impl.model->contact, changed.positions, changed.time);
  impl.put(std::move(changed));
}

void Simulation::set_velocities(ConstVectors velocities) {
  Impl& impl = *impl_;
  const std::vector<Vec3>& now = impl.state.motion.velocities;
  require_count(velocities, now.size(), "velocities");
  for (std::size_t v = 0; v < velocities.size(); ++v) {
    if (velocities[v].allFinite()) continue;
    throw Error(ErrorKind::usage, fmt::format("the velocity of vertex {} is not finite", v),
                "give finite velocities in metres per second");
  }
  State changed = impl.state.motion;
  changed.velocities.assign(velocities.begin(), velocities.end());
  impl.keep_prescribed(now, changed.velocities);
  impl.put(std::move(changed));
}

}  // namespace muslin
