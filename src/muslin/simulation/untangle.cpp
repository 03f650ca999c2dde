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

constexpr double step_length = 1.0 / 60;  // [s]
constexpr int most_steps = 240;           // four seconds
/// A repair ends if this many steps in a row do not make the tangle smaller, or shallower by this factor.
constexpr int patience = 30, stuck_after = 3;
constexpr double shallower = 0.98;
/// Tight cloth presses against separations: they are made firmer by a factor of 2 after each step that does
/// not leave less than this share of the tangle.
constexpr double good_share = 0.9, firmest = 64;
/// If nothing crosses and only gaps are small, it ends after fewer: contact can go on from there.
constexpr int patience_if_close = 12;
constexpr double accuracy = 0.05;  // of a step, over the separations
constexpr std::size_t listed = 4;

class Repair {
 public:
  Repair(const Model& model, const Terms& terms, RunState& state, Scratch& scratch)
      : model_(model), terms_(terms), state_(state), scratch_(scratch), finder_(model.contact) {
    scratch.prepare(model);
  }

  Untangled run(const Progress& progress) {
    Untangled report;
    const std::vector<Vec3> begin = state_.motion.positions;
    Persistence persistence;
    Tangle tangle = find(persistence);
    report.crossings = tangle.crossing.size();
    report.lost = tangle.wrong.size();
    report.close = tangle.close_count;
    report.depth = tangle.depth;
    std::size_t least = std::numeric_limits<std::size_t>::max();
    double least_depth = std::numeric_limits<double>::infinity();
    const auto patience_for = [](const Tangle& t) {
      return t.crossing.empty() && t.wrong.empty() ? patience_if_close : patience;
    };
    for (int since = 0; !tangle.empty() && report.steps < most_steps && since < patience_for(tangle);
         ++since) {
      if (tangle.size() < least || tangle.depth < shallower * least_depth) since = 0;
      least = std::min(least, tangle.size());
      least_depth = std::min(least_depth, tangle.depth);
      const std::string stage = fmt::format("untangling, {} places left", tangle.size());
      progress.at(static_cast<double>(report.steps) / most_steps, stage);
      if (!step(tangle)) break;
      ++report.steps;
      const auto before = static_cast<double>(tangle.size());
      persistence.flattens = since >= stuck_after;
      tangle = find(persistence);
      if (static_cast<double>(tangle.size()) > good_share * before)
        persistence.firmness = std::min(2 * persistence.firmness, firmest);
    }
    report.left = tangle.crossing.size();
    report.lost_left = tangle.wrong.size();
    name_places(report);
    for (std::size_t v = 0; v < begin.size(); ++v)
      report.moved = std::max(report.moved, (state_.motion.positions[v] - begin[v]).norm());
    return report;
  }

 private:
  Tangle find(const Persistence& persistence) {
    return finder_.find(state_.motion.positions, step_length, persistence);
  }

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
    guard->follow_time(motion.positions, now, now);
    guard->leave_free(tangle.crossing, tangle.free);
    // Steps are solved to a share of the separations, whatever the stiffness.
    const std::vector<double> accelerations(
        scratch_.parts.count(), separation.mean_missing(motion.positions) / (step_length * step_length));
    StepProblem problem{
        scratch_.masses,       std::move(potentials),    scratch_.fixed, scratch_.targets,    guard,
        model_.rest_positions, scratch_.parts.of_vertex, accelerations,  scratch_.parts.edges};
    SolverSettings settings = model_.scene.solver;
    settings.integrator = Integrator::implicit_euler;
    settings.tolerance = accuracy;
    const StepReport report = stepper_.step(settings, context, problem, motion);
    std::fill(motion.velocities.begin(), motion.velocities.end(), Vec3::Zero());
    motion.time = now;
    return report.made();
  }

  const Model& model_;
  const Terms& terms_;
  RunState& state_;
  Scratch& scratch_;
  TangleFinder finder_;
  Stepper stepper_;
};

}  // namespace

Untangled untangle(const Model& model, const Terms& terms, RunState& state, Scratch& scratch,
                   const Progress& progress) {
  return Repair(model, terms, state, scratch).run(progress);
}

}  // namespace muslin
