#include "muslin/simulation/advance.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "muslin/simulation/jumping_colliders.hpp"

namespace muslin {
namespace {

void add(const ContactCounts& counts, RunCosts& costs) {
  costs.search += counts.search_seconds;
  costs.limit += counts.limit_seconds;
  costs.contact += counts.potential_seconds;
  costs.searches += static_cast<std::int64_t>(counts.searches);
  costs.limits += static_cast<std::int64_t>(counts.limits);
  costs.deflected += static_cast<std::int64_t>(counts.deflected);
  costs.shortened += static_cast<std::int64_t>(counts.shortened);
}

/// A step that missed its tolerance is halved at most this many times before it is accepted; it is not halved
/// in a frame in which halving has already failed.
constexpr int patient_halvings = 4;

class Advance {
 public:
  Advance(const Model& model, const Terms& terms, RunState& state, Scratch& scratch)
      : model_(model), terms_(terms), state_(state), scratch_(scratch), guard_(scratch.guard(model, state)) {}

  StepReport by(double length, int halvings = 0) {
    const ContactMemory contact = state_.contact;
    std::optional<State> standing;  // before colliders jump
    double jumped = 0;              // energy of contact that their jump makes [J]
    if (const auto jumping = guard_ != nullptr ? jumping_colliders(model_, state_.motion, length)
                                               : std::vector<const Prescribed*>();
        !jumping.empty()) {
      standing = state_.motion;
      jumped = jump(jumping, length);
    }
    const State before = state_.motion;
    StepContext context = step_context(model_.scene.solver.integrator, before, length);
    const SolverSettings settings = model_.scene.solver.at(context.time_end);
    const auto loads = terms_.potentials_of_loads(context);
    Holds next = hold(context, before);
    predict(settings.integrator, before, context);
    const std::unique_ptr<Potential> springs =
        scratch_.yielding.free(before, context, scratch_.fixed, scratch_.targets, scratch_.masses);
    if (guard_) guard_->follow_time(before.positions, context.time_begin, context.time_end);

    const std::vector<double> accelerations =
        driving_accelerations(model_, terms_, loads, before.positions, scratch_);
    StepProblem problem{scratch_.masses,
                        {},
                        scratch_.fixed,
                        scratch_.targets,
                        guard_,
                        model_.rest_positions,
                        scratch_.parts.of_vertex,
                        accelerations,
                        scratch_.parts.edges};
    problem.in_double = halvings >= patience();
    for (const PotentialTerm& term : terms_.potentials) problem.potentials.push_back(term.potential.get());
    for (std::size_t i = 0; i < loads.size(); ++i) {
      if (!loads[i]) continue;
      problem.potentials.push_back(loads[i].get());
      if (terms_.loads[i].role == EnergyRole::dissipation) problem.dampings.push_back(loads[i].get());
    }
    if (springs) {
      problem.potentials.push_back(springs.get());
      problem.yielding = {scratch_.yielding.vertices(), springs.get()};
    }
    StepReport report = scratch_.stepper.step(settings, context, problem, state_.motion);
    report.held_back +=
        scratch_.yielding.hold(state_.motion.positions, scratch_.fixed, scratch_.targets, scratch_.masses);
    const bool missed = report.made() && !report.converged && halvings < patience() &&
                        settings.integrator != Integrator::linearly_implicit_euler;
    if (missed || (standing && !report.made())) take_back(standing ? *standing : before, contact);
    count(report, report.made() && !missed);
    if (!report.made() || missed) {
      if (halvings == max_halvings) return report;
      report = by(length / 2, halvings + 1);
      return report.made() ? by(length / 2, halvings + 1) : report;
    }
    state_.holds = std::move(next);
    state_.energy.work += jumped;
    state_.energy.contact_energy += jumped;
    SolvedStep solved;
    solved.integrator = settings.integrator;
    solved.length = length;
    solved.context = &context;
    solved.before = &before;
    solved.after = &state_.motion;
    solved.masses = model_.masses;
    solved.fixed = scratch_.fixed;
    solved.wants_reactions = !model_.pins.empty();
    const std::vector<Vec3> reactions =
        state_.energy.enter(terms_, solved, loads, guard_ ? &guard_->last_potential() : nullptr);
    for (std::size_t i = 0; i < loads.size(); ++i)
      if (loads[i]) terms_.loads[i].load->end_step(*loads[i], state_.motion.positions, state_.motion.history);
    if (!model_.pins.empty())
      update_pin_forces(model_.pins, context.time_begin, context.time_end, reactions, state_.motion.history,
                        state_.pin_forces);
    return report;
  }

 private:
  int patience() const { return state_.counts.converged_steps < state_.counts.steps ? 0 : patient_halvings; }

  /// Puts colliders where they are at the end of a step, free of what they then cross. Returns the energy
  /// that contact gains [J].
  double jump(const std::vector<const Prescribed*>& jumping, double length) {
    std::vector<Vec3>& x = state_.motion.positions;
    for (const Prescribed* motion : jumping)
      motion->positions(state_.motion.time + length,
                        Vectors(x).subspan(static_cast<std::size_t>(motion->first), motion->start.size()));
    guard_->free_crossings(x);
    guard_->begin(x, scratch_.fixed);
    guard_->potential(x, StepGuard::Friction::anew);
    return guard_->last_potential().parts(x).normal - state_.energy.contact_energy;
  }

  /// Undoes a step that was made but is rejected.
  void take_back(const State& before, const ContactMemory& contact) {
    state_.motion = before;
    state_.contact = contact;
    scratch_.forget_guard();
    guard_ = scratch_.guard(model_, state_);
  }

  /// Determines the held vertices and their targets at the end of the step.
  Holds hold(const StepContext& context, const State& before) {
    Holds next = state_.holds;
    next.step(model_.pins, context.time_begin, context.time_end, before.positions, scratch_.fixed,
              scratch_.targets);
    for (const Prescribed& motion : model_.prescribed)
      motion.hold(context.time_end, scratch_.fixed, scratch_.targets);
    return next;
  }

  void predict(Integrator integrator, const State& before, StepContext& context) const {
    for (const Component& body : model_.bodies) body.predict(integrator, before, scratch_.fixed, context);
  }

  void count(const StepReport& report, bool made) {
    FrameCounts& counts = state_.counts;
    counts.newton += report.newton_iterations;
    counts.linear += report.linear_iterations;
    scratch_.linearize_seconds += report.linearize_seconds;
    scratch_.solve_seconds += report.solve_seconds;
    if (!made) return;
    ++counts.steps;
    counts.converged_steps += report.converged ? 1 : 0;
    counts.error = std::max(counts.error, report.error);
    counts.residual = std::max(counts.residual, report.residual);
    counts.held_back = report.held_back;
    if (guard_) counts.smallest_gap = std::min(counts.smallest_gap, state_.contact.smallest_gap);
  }

  const Model& model_;
  const Terms& terms_;
  RunState& state_;
  Scratch& scratch_;
  ContactGuard* guard_;
};

}  // namespace

std::vector<double> driving_accelerations(const Model& model, const Terms& terms,
                                          std::span<const std::unique_ptr<Potential>> loads,
                                          ConstVectors positions, const Scratch& scratch) {
  std::vector<Vec3> force(positions.size(), Vec3::Zero());
  for (const PotentialTerm& term : terms.potentials)
    if (drives(term.role)) term.potential->add_gradient(positions, force);
  for (std::size_t i = 0; i < loads.size(); ++i)
    if (loads[i] && drives(terms.loads[i].role)) loads[i]->add_gradient(positions, force);
  std::vector<double> mass(scratch.parts.count(), 0.0), square = mass;
  for (std::size_t v = 0; v < force.size(); ++v) {
    const auto part = static_cast<std::size_t>(scratch.parts.of_vertex[v]);
    if (!(model.masses[v] > 0)) continue;
    mass[part] += model.masses[v];
    square[part] += force[v].squaredNorm() / model.masses[v];
  }
  for (std::size_t p = 0; p < mass.size(); ++p) square[p] = mass[p] > 0 ? std::sqrt(square[p] / mass[p]) : 0;
  return square;
}

int vertex_out_of_range(ConstVectors x) {
  for (std::size_t v = 0; v < x.size(); ++v)
    if (!(x[v].cwiseAbs().maxCoeff() <= farthest)) return static_cast<int>(v);
  return -1;
}

void Scratch::forget_guard() {
  if (guard_) add(guard_->counts(), earlier_);
  guard_.reset();
}

void Scratch::forget() {
  forget_guard();
  stepper = Stepper();
  fixed = {};
  targets = {};
  masses = {};
}

ContactGuard* Scratch::guard(const Model& model, RunState& state) {
  if (!model.contact) return nullptr;
  if (!guard_) guard_ = std::make_unique<ContactGuard>(model.contact, state.contact);
  return guard_.get();
}

void Scratch::prepare(const Model& model) {
  const std::size_t count = model.vertex_count();
  if (masses.size() == count) return;
  parts = find_parts(model);
  yielding = Yielding(model);
  fixed.assign(count, 0);
  targets.assign(count, Vec3::Zero());
  // Solvers divide by masses before they leave out prescribed vertices, which have none.
  masses = model.masses;
  for (const Prescribed& motion : model.prescribed)
    std::fill_n(masses.begin() + motion.first, motion.start.size(), mass_of_prescribed);
}

RunCosts Scratch::costs() const {
  RunCosts costs = earlier_;
  costs.linearize = linearize_seconds;
  costs.solve = solve_seconds;
  if (guard_) add(guard_->counts(), costs);
  return costs;
}

StepReport advance(const Model& model, const Terms& terms, RunState& state, double length, Scratch& scratch) {
  const RunState start = state;
  const auto go_back = [&] {
    state = start;
    scratch.forget();
  };
  try {
    scratch.prepare(model);
    StepReport report = Advance(model, terms, state, scratch).by(length);
    const int lost = report.made() ? vertex_out_of_range(state.motion.positions) : -1;
    if (lost >= 0) report = {.worst_vertex = lost, .failure = "it is farther than 1.5e11 m from the origin"};
    if (!report.made()) go_back();
    return report;
  } catch (...) {
    go_back();
    throw;
  }
}

}  // namespace muslin
