// Saves the state of a simulation as bytes and restores it.
#include <utility>

#include <fmt/format.h>

#include "muslin/contact/contact_model.hpp"
#include "muslin/contact/crossings.hpp"
#include "muslin/core/error.hpp"
#include "muslin/simulation/fingerprint.hpp"
#include "muslin/simulation/simulation_impl.hpp"

namespace muslin {

std::vector<std::uint8_t> Simulation::checkpoint() const {
  const RunState& state = impl_->state;
  return to_checkpoint({model_fingerprint(*impl_->model), state.frame, state.steps_done,
                        impl_->time().steps_per_frame.value_or(0)},
                       state);
}

void Simulation::restore(const std::vector<std::uint8_t>& bytes) {
  Impl& impl = *impl_;
  const Model& model = *impl.model;
  const CheckpointHeader header = read_checkpoint_header(bytes);
  if (header.fingerprint != model_fingerprint(model)) {
    throw Error(ErrorKind::input,
                "the checkpoint belongs to other bodies: a mesh, a lattice or a material changed",
                "undo the change, or restart the run");
  }
  const std::int64_t steps = impl.time().steps_per_frame.value_or(0);
  if (header.steps != 0 && header.steps_per_frame != steps) {
    const auto number = [](std::int64_t n) {
      return n == 0 ? std::string("\"auto\"") : fmt::format("{}", n);
    };
    throw Error(
        ErrorKind::input,
        fmt::format("the checkpoint lies inside a frame with steps_per_frame = {}, the scene now has {}",
                    number(header.steps_per_frame), number(steps)),
        "resume from the checkpoint before it");
  }
  RunState state = from_checkpoint(bytes, model.vertex_count());
  // Which triangles cross depends on the surfaces and the option, which may have changed.
  state.contact.tangled.clear();
  // Surfaces that crossed when a rule let them touch again are free until they part.
  const bool leave_free =
      impl.tangled_start() != TangledStart::refuse ||
      (model.contact && !model.contact->surface->rules().empty());
  if (model.contact) {
    if (!leave_free)
      refuse_crossings(*model.contact, state.motion.positions, state.motion.time, {model.scene.file.string()});
    require_fit(state.contact, *model.contact);
  } else {
    state.contact = {};
    state.energy.work -= std::exchange(state.energy.contact_energy, 0.0);
  }
  go_on_with(model.pins, state);
  state.energy.go_on_with(impl.terms(), state.motion.positions);

  impl.scratch.forget();
  impl.state = std::move(state);
  impl.wall_ms = 0;
  if (model.contact && leave_free)
    impl.scratch.guard(model, impl.state)->allow_initial_intersections(impl.state.motion.positions);
}

}  // namespace muslin
