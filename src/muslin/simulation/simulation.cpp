#include "muslin/simulation/simulation.hpp"

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "muslin/constraint/attachment.hpp"
#include "muslin/contact/crossings.hpp"
#include "muslin/core/error.hpp"
#include "muslin/simulation/simulation_impl.hpp"
#include "muslin/simulation/untangle.hpp"

namespace muslin {

namespace {

std::shared_ptr<const Model> not_null(std::shared_ptr<const Model> model) {
  require(model != nullptr, "a simulation needs a model", "give the one that build_model returns");
  return model;
}

/// Returns the largest distance of a held vertex from its target in the last step [m].
double farthest_behind(ConstVectors x, const Scratch& scratch) {
  double farthest = 0;
  for (std::size_t v = 0; v < x.size(); ++v)
    if (scratch.fixed[v] != 0) farthest = std::max(farthest, (scratch.targets[v] - x[v]).norm());
  return farthest;
}

}  // namespace

Simulation::Impl::Impl(std::shared_ptr<const Model> the_model, const SimulationOptions& the_options,
                       const Progress& progress)
    : model(not_null(std::move(the_model))), options(the_options), loads(model->loads) {
  state.motion.positions = model->rest_positions;
  state.motion.velocities = model->velocities;
  state.motion.velocities.resize(model->vertex_count(), Vec3::Zero());
  state.pins = pin_keys(model->pins);
  if (model->contact) {
    if (model->scene.solver.integrator == Integrator::symplectic_euler)
      throw Error(ErrorKind::usage, "symplectic_euler does not support contact",
                  "use implicit_euler, bdf2 or linearly_implicit_euler");
    begin_contact(progress);
    state.counts.smallest_gap = state.contact.smallest_gap;
  }
  measure_energy();
  finish_frame();
}

double Simulation::Impl::progress() const {
  return time().steps_per_frame
             ? static_cast<double>(state.steps_done) / *time().steps_per_frame
             : static_cast<double>(state.control.ticks) / static_cast<double>(StepControl::frame);
}

double Simulation::Impl::time_now() const {
  // One division of whole numbers, so that second 1 is exactly 1 however many steps lead there.
  const double parts =
      time().steps_per_frame ? *time().steps_per_frame : static_cast<double>(StepControl::frame);
  const double done = time().steps_per_frame ? state.steps_done : static_cast<double>(state.control.ticks);
  return (static_cast<double>(state.frame) * parts + done) / (time().frame_rate * parts);
}

double Simulation::Impl::step_length(int level) const {
  return time().steps_per_frame ? time().step()
                                : static_cast<double>(StepControl::length(level)) /
                                      (static_cast<double>(StepControl::frame) * time().frame_rate);
}

int Simulation::Impl::choose_level() {
  if (time().steps_per_frame) return 0;
  scratch.prepare(*model);
  const StepContext context =
      step_context(model->scene.solver.integrator, state.motion, 1 / time().frame_rate);
  const std::vector<double> accelerations = driving_accelerations(
      *model, terms(), terms().driving_potentials(context), state.motion.positions, scratch);
  return state.control.choose(scratch.parts, accelerations, scratch.masses, state.motion,
                              1 / time().frame_rate, model->scene.solver.effort_at(state.motion.time));
}

void Simulation::Impl::begin_contact(const Progress& progress) {
  const std::vector<Vec3>& x = state.motion.positions;
  if (options.resumes) return touch(true);
  if (tangled_start() == TangledStart::refuse)
    refuse_crossings(*model->contact, x, state.motion.time, {model->scene.file.string()});
  if (tangled_start() == TangledStart::repair) {
    const std::vector<Vec3> start = x;
    untangled = untangle(*model, terms(), state, scratch, progress);
    // A thickness of kilometres is a mistake, not a tangle.
    if (vertex_out_of_range(x) >= 0)
      refuse_crossings(*model->contact, start, state.motion.time, {model->scene.file.string()});
  }
  touch(tangled_start() == TangledStart::ignore || untangled.left > 0);
}

void Simulation::Impl::touch(bool leave_free) {
  scratch.forget();
  scratch.prepare(*model);
  state.contact = {};
  ContactGuard& guard = *scratch.guard(*model, state);
  const std::vector<Vec3>& x = state.motion.positions;
  guard.follow_time(x, state.motion.time, state.motion.time);
  if (leave_free) guard.allow_initial_intersections(x);
  guard.begin(x, scratch.fixed);
  guard.potential(x, StepGuard::Friction::anew);
  guard.end(x);
  state.energy.contact_energy = guard.last_potential().parts(x).normal;
}

void Simulation::Impl::measure_energy() {
  StepContext context = step_context(model->scene.solver.integrator, state.motion, time().step());
  context.time_end = context.time_begin;  // numbers that change are those of now
  state.energy.measure(terms(), context, state.motion.positions);
}

void Simulation::Impl::advance() {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  int level = choose_level();
  StepReport report;
  if (time().steps_per_frame) {
    report = muslin::advance(*model, terms(), state, step_length(level), scratch);
  } else {
    // Motion that begins within a step is visible only at its end.
    const RunState before = state;
    for (;;) {
      report = muslin::advance(*model, terms(), state, step_length(level), scratch);
      const int wanted = report.made() ? choose_level() : level;
      if (wanted <= level + 1 || level == StepControl::deepest) break;
      state = before;
      scratch.forget();
      level = std::min(wanted, StepControl::deepest);
    }
  }
  if (!report.made()) fail(report);
  ++state.steps_done;
  if (!time().steps_per_frame) {
    state.control.note(level, report);
    state.control.ticks += StepControl::length(level);
  }
  state.motion.time = time_now();
  wall_ms += std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
  if (progress() < 1) return;
  ++state.frame;
  state.steps_done = 0;
  state.control.ticks = 0;
  finish_frame();
}

void Simulation::Impl::describe_state(Diagnostics& row) const {
  const EnergyLedger& energy = state.energy;
  row.kinetic = kinetic_energy(model->masses, state.motion.velocities);
  row.elastic = energy.sum(terms(), EnergyRole::elastic) + energy.sum(terms(), EnergyRole::joint) +
                energy.contact_energy;
  row.potential = energy.sum(terms(), EnergyRole::potential);
  row.work = energy.work;
  row.material_work = energy.material_work;
  row.dissipated = energy.dissipated;
  row.unbalanced = energy.unbalanced;
  row.momentum = total_momentum(model->masses, state.motion.velocities);
  row.max_stretch = max_stretch(*model, state.motion.positions);
}

void Simulation::Impl::finish_frame() {
  const FrameCounts counts = std::exchange(state.counts, {});
  Diagnostics row;
  row.frame = state.frame;
  row.time = state.motion.time;
  describe_state(row);
  row.newton_iterations = static_cast<int>(counts.newton);
  row.linear_iterations = static_cast<int>(counts.linear);
  row.residual = counts.residual;
  row.min_distance = counts.smallest_gap;
  row.held_back = counts.held_back;
  if (row.held_back > 0) row.behind = farthest_behind(state.motion.positions, scratch);
  row.steps = counts.steps;
  row.converged_steps = counts.converged_steps;
  row.error = counts.error;
  row.crossings = static_cast<int>(state.contact.tangled.size());
  row.penetration = std::max(0.0, -counts.smallest_gap);
  row.wall_ms = std::exchange(wall_ms, 0.0);
  state.diagnostics = row;
}

void Simulation::Impl::fail(const StepReport& report) const {
  std::string place;
  if (report.worst_vertex >= 0) {
    const Vec3& x = state.motion.positions[static_cast<std::size_t>(report.worst_vertex)];
    place =
        fmt::format(", worst in body \"{}\" near ({:.4g}, {:.4g}, {:.4g}) m",
                    model->body_of(static_cast<std::size_t>(report.worst_vertex)).name, x.x(), x.y(), x.z());
  }
  const bool explicit_steps = model->scene.solver.integrator == Integrator::symplectic_euler;
  throw Error(ErrorKind::solver,
              fmt::format("the solver failed in frame {} after {:.6g} s, even with steps halved {} "
                          "times{}: {}",
                          state.frame + 1, state.motion.time, max_halvings, place, report.failure),
              fmt::format("{}{}",
                          time().steps_per_frame
                              ? fmt::format("raise time.steps_per_frame (now {})", *time().steps_per_frame)
                              : std::string("look at what moves there"),
                          explicit_steps ? ", soften the material, or use solver.integrator = "
                                           "\"implicit_euler\", which has no limit on the step"
                                         : ", soften the material, or look at the pins and forces there"));
}

Simulation::Simulation(std::shared_ptr<const Model> model, const SimulationOptions& options,
                       const Progress& progress)
    : impl_(std::make_unique<Impl>(std::move(model), options, progress)) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

const Model& Simulation::model() const { return *impl_->model; }
std::shared_ptr<const Model> Simulation::shared_model() const { return impl_->model; }
const SimulationOptions& Simulation::options() const { return impl_->options; }
const State& Simulation::state() const { return impl_->state.motion; }
int Simulation::frame() const { return impl_->state.frame; }
int Simulation::steps_done() const { return impl_->state.steps_done; }
const Diagnostics& Simulation::diagnostics() const { return impl_->state.diagnostics; }
const Untangled& Simulation::untangled() const { return impl_->untangled; }
std::size_t Simulation::tangled() const { return impl_->state.contact.tangled.size(); }
RunCosts Simulation::costs() const { return impl_->scratch.costs(); }

void Simulation::step() { impl_->advance(); }

void Simulation::advance(const Progress& progress) {
  const int frame = impl_->state.frame;
  while (impl_->state.frame == frame) {
    progress.at(impl_->progress(), "simulation");
    impl_->advance();
  }
}

SimulatedBody Simulation::body(const std::string& name) { return {*this, model().body(name)}; }

Vec3 Simulation::probe(const std::string& name) const {
  const Probe& probe = model().probe(name);
  const Component& body = model().bodies[static_cast<std::size_t>(probe.body)];
  Vec3 point;
  probe.point.apply(model().of(body, state().positions), {&point, 1});
  return point;
}

PinForce Simulation::pin_force(const std::string& name) const {
  const auto p = static_cast<std::size_t>(&model().pin(name) - model().pins.data());
  return p < impl_->state.pin_forces.size() ? impl_->state.pin_forces[p] : PinForce{};
}

AttachmentForce Simulation::attachment_force(const std::string& name) const {
  return model().attachment(name).springs->force(state().time, state().positions, state().history);
}

void Simulation::add_load(LoadTerm load) {
  if (!load.load)
    throw Error(ErrorKind::usage, "the load \"" + load.name + "\" is null", "give one that exists");
  impl_->loads.push_back(std::move(load));
  impl_->state.energy.stored.push_back(0.0);
  impl_->state.energy.terms = impl_->terms().keys();
}

void Simulation::forget_scratch() { impl_->scratch.forget(); }

}  // namespace muslin
