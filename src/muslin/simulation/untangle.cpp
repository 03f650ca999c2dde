#include "muslin/simulation/untangle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "muslin/contact/contact_model.hpp"
#include "muslin/contact/crossings.hpp"
#include "muslin/core/index.hpp"
#include "muslin/simulation/energy_account.hpp"
#include "muslin/untangle/tangle.hpp"

namespace muslin {
namespace {

constexpr double step_length = 1.0 / 240;  // [s]
constexpr int most_steps = 120;            // half a second
/// A repair ends if this many steps in a row do not make the tangle smaller.
constexpr int patience = 30;
constexpr std::size_t listed = 4;

class Repair {
 public:
  Repair(const Model& model, const Terms& terms, RunState& state, Scratch& scratch)
      : model_(model), terms_(terms), state_(state), scratch_(scratch), finder_(model.contact) {
    scratch.prepare(model);
    for (std::size_t p = 0; p < model.contact->surface->point_count(); ++p)
      parts_.push_back(finder_.pieces().of_point(static_cast<int>(p)));
  }

  Untangled run(const Progress& progress) {
    Untangled report;
    const std::vector<Vec3> begin = state_.motion.positions;
    Tangle tangle = find();
    report.crossings = tangle.crossing.size();
    report.lost = tangle.lost_count;
    report.close = tangle.close_count;
    report.depth = tangle.depth;
    std::size_t least = std::numeric_limits<std::size_t>::max();
    for (int since = 0; !tangle.empty() && report.steps < most_steps && since < patience; ++since) {
      if (tangle.size() < least) {
        least = tangle.size();
        since = 0;
      }
      const std::string stage = fmt::format("untangling, {} places left", tangle.size());
      progress.at(static_cast<double>(report.steps) / most_steps, stage);
      if (!step(tangle)) break;
      ++report.steps;
      tangle = find();
    }
    report.left = tangle.crossing.size();
    name_places(report);
    for (std::size_t v = 0; v < begin.size(); ++v)
      report.moved = std::max(report.moved, (state_.motion.positions[v] - begin[v]).norm());
    return report;
  }

 private:
  Tangle find() { return finder_.find(state_.motion.positions, step_length); }

  void name_places(Untangled& report) const {
    if (report.left == 0) return;
    const std::vector<Crossing> all =
        one_of_each_pair(*model_.contact, find_crossings(*model_.contact, state_.motion.positions));
    for (std::size_t i = 0; i < std::min(all.size(), listed); ++i)
      report.places.push_back(describe(*model_.contact, all[i]));
    if (all.size() > listed) report.places.push_back(fmt::format("and {} more", all.size() - listed));
  }

  bool step(const Tangle& tangle) {
    State& motion = state_.motion;
    const double now = motion.time;
    std::fill(motion.velocities.begin(), motion.velocities.end(), Vec3::Zero());
    StepContext context = step_context(Integrator::implicit_euler, motion, step_length);
    context.time_end = context.velocity_time = now;
    const SeparationPotential separation(model_.contact->map, tangle.separations);
    // Only what holds bodies together acts besides.
    std::vector<std::unique_ptr<Potential>> loads;
    std::vector<const Potential*> potentials = {&separation};
    for (const PotentialTerm& term : terms_.potentials)
      if (!drives(term.role)) potentials.push_back(term.potential.get());
    for (const LoadTerm& term : terms_.loads) {
      if (term.role != EnergyRole::joint && term.role != EnergyRole::support) continue;
      if (std::unique_ptr<Potential> load = term.load->potential(context)) loads.push_back(std::move(load));
    }
    for (const std::unique_ptr<Potential>& load : loads) potentials.push_back(load.get());

    Holds holds = state_.holds;
    holds.step(model_.pins, now, now, motion.positions, scratch_.fixed, scratch_.targets);
    for (const Prescribed& prescribed : model_.prescribed)
      prescribed.hold(now, scratch_.fixed, scratch_.targets);

    ContactGuard* guard = scratch_.guard(model_, state_);
    guard->leave_free(tangle.crossing, {parts_, tangle.lost});
    const std::vector<double> accelerations = accelerations_of(separation);
    StepProblem problem{scratch_.masses,
                        std::move(potentials),
                        scratch_.fixed,
                        scratch_.targets,
                        guard,
                        model_.rest_positions,
                        scratch_.parts.of_vertex,
                        accelerations,
                        scratch_.parts.edges};
    SolverSettings settings = model_.scene.solver;
    settings.integrator = Integrator::implicit_euler;
    settings.effort = Effort::draft;
    settings.tolerance.reset();
    const StepReport report = stepper_.step(settings, context, problem, motion);
    std::fill(motion.velocities.begin(), motion.velocities.end(), Vec3::Zero());
    motion.time = now;
    return report.made();
  }

  /// Returns the root mean square of the accelerations by separations, by part [m/s²].
  std::vector<double> accelerations_of(const Potential& separation) const {
    std::vector<Vec3> force(state_.motion.positions.size(), Vec3::Zero());
    separation.add_gradient(state_.motion.positions, force);
    std::vector<double> mass(scratch_.parts.count(), 0.0), square = mass;
    for (std::size_t v = 0; v < force.size(); ++v) {
      if (!(model_.masses[v] > 0)) continue;
      const std::size_t part = at(scratch_.parts.of_vertex[v]);
      mass[part] += model_.masses[v];
      square[part] += force[v].squaredNorm() / model_.masses[v];
    }
    for (std::size_t p = 0; p < mass.size(); ++p) square[p] = mass[p] > 0 ? std::sqrt(square[p] / mass[p]) : 0;
    return square;
  }

  const Model& model_;
  const Terms& terms_;
  RunState& state_;
  Scratch& scratch_;
  TangleFinder finder_;
  Stepper stepper_;
  std::vector<int> parts_;  // #P, pieces
};

}  // namespace

Untangled untangle(const Model& model, const Terms& terms, RunState& state, Scratch& scratch,
                   const Progress& progress) {
  return Repair(model, terms, state, scratch).run(progress);
}

}  // namespace muslin
