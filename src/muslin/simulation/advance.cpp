#include "muslin/simulation/advance.hpp"

#include <algorithm>
#include <utility>

#include "muslin/solver/rigid_prediction.hpp"

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

class Advance {
 public:
  Advance(const Model& model, const Terms& terms, RunState& state, Scratch& scratch)
      : model_(model),
        terms_(terms),
        state_(state),
        scratch_(scratch),
        guard_(scratch.guard(model, state)),
        fast_contact_(guard_ && model.contact->mode == ContactMode::fast) {}

  StepReport by(double length, int halvings = 0) {
    const State before = state_.motion;
    SolverSettings settings = model_.scene.solver;
    if (fast_contact_) settings.effort = Effort::fast;
    StepContext context = step_context(settings.integrator, before, length);
    const auto loads = terms_.potentials_of_loads(context);
    Holds next = hold(context, before);
    predict(settings.integrator, before, context);

    StepProblem problem{scratch_.masses, {}, scratch_.fixed, scratch_.targets, guard_, model_.rest_positions};
    for (const PotentialTerm& term : terms_.potentials) problem.potentials.push_back(term.potential.get());
    for (const auto& load : loads)
      if (load) problem.potentials.push_back(load.get());
    StepReport report = scratch_.stepper.step(settings, context, problem, state_.motion);
    count(report);
    if (!report.made()) {
      if (halvings == max_halvings) return report;
      report = by(length / 2, halvings + 1);
      return report.made() ? by(length / 2, halvings + 1) : report;
    }
    state_.holds = std::move(next);
    SolvedStep solved;
    solved.integrator = settings.integrator;
    solved.length = length;
    solved.context = &context;
    solved.before = &before;
    solved.after = &state_.motion;
    solved.masses = model_.masses;
    solved.fixed = scratch_.fixed;
    // Fast steps do not obey their equation closely enough for a balance to be a check: what is stored is
    // known by its values, which saves most of the work.
    const bool by_values = fast_contact_;
    state_.energy.enter(terms_, solved, loads, guard_ ? &guard_->last_potential() : nullptr, by_values);
    return report;
  }

 private:
  /// Decides what is held, and where, at the end of the step.
  Holds hold(const StepContext& context, const State& before) {
    Holds next = state_.holds;
    next.step(model_.pins, context.time_begin, context.time_end, before.positions, scratch_.fixed,
              scratch_.targets);
    for (const Prescribed& motion : model_.prescribed)
      motion.hold(context.time_end, scratch_.fixed, scratch_.targets);
    return next;
  }

  void predict(Integrator integrator, const State& before, StepContext& context) const {
    for (const Body& body : model_.bodies) {
      const auto first = static_cast<std::size_t>(body.first_vertex);
      if (body.is_rigid() && scratch_.fixed[first] == 0) predict_rigid(integrator, before, first, context);
    }
  }

  void count(const StepReport& report) {
    FrameCounts& counts = state_.counts;
    counts.newton += report.newton_iterations;
    counts.linear += report.linear_iterations;
    scratch_.linearize_seconds += report.linearize_seconds;
    scratch_.solve_seconds += report.solve_seconds;
    if (!report.made()) return;
    counts.residual = std::max(counts.residual, report.residual);
    counts.held_back = report.held_back;
    if (guard_) counts.smallest_gap = std::min(counts.smallest_gap, state_.contact.smallest_gap);
  }

  const Model& model_;
  const Terms& terms_;
  RunState& state_;
  Scratch& scratch_;
  ContactGuard* guard_;
  bool fast_contact_;
};

}  // namespace

int vertex_out_of_range(ConstVectors x) {
  for (std::size_t v = 0; v < x.size(); ++v)
    if (!(x[v].cwiseAbs().maxCoeff() <= farthest)) return static_cast<int>(v);
  return -1;
}

void Scratch::forget() {
  if (guard_) add(guard_->counts(), earlier_);
  guard_.reset();
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
  fixed.assign(count, 0);
  targets.assign(count, Vec3::Zero());
  // Vertices that move as they are told have no mass, but solvers divide by masses before they leave it out.
  masses = model.masses;
  for (const Prescribed& motion : model.prescribed)
    std::fill_n(masses.begin() + motion.first, motion.start.size(), 1.0);
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
    if (lost >= 0) report = {.worst_vertex = lost, .failure = "it flew farther than 1.5e11 m"};
    if (!report.made()) go_back();
    return report;
  } catch (...) {
    go_back();
    throw;
  }
}

}  // namespace muslin
