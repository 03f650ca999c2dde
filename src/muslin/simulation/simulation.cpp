#include "muslin/simulation/simulation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "muslin/constraint/holds.hpp"
#include "muslin/contact/contact_guard.hpp"
#include "muslin/contact/crossings.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/simulation/energy_account.hpp"
#include "muslin/simulation/saved_run.hpp"
#include "muslin/solver/rigid_prediction.hpp"

namespace muslin {
namespace {

constexpr int max_halvings = 8;

/// A step that could not be solved even when halved as often as allowed.
struct StepFailure {
  StepReport report;
};

bool is_stored(EnergyRole role) { return role == EnergyRole::elastic || role == EnergyRole::potential; }

double max_stretch(const Body& body, ConstVectors x) {
  if (body.is_shell()) return max_stretch(body.shell, x);
  const Springs& springs = body.springs;
  if (springs.count == 0) return 1;
  struct Largest {
    double ratio = 0;
    Largest operator+(const Largest& other) const { return {std::max(ratio, other.ratio)}; }
  };
  constexpr std::size_t runs_per_block = 64;
  return parallel_sum(springs.runs.size(), runs_per_block, Largest{},
                      [&](std::size_t begin, std::size_t end) {
                        Largest largest;
                        for (std::size_t r = begin; r < end; ++r) {
                          const SpringRun& run = springs.runs[r];
                          const auto& direction = springs.directions[static_cast<std::size_t>(run.direction)];
                          const double rest = body.lattice.width * direction.offset.cast<double>().norm();
                          double squared = 0;
                          for (int i = 0; i < run.length; ++i) {
                            const auto a = static_cast<std::size_t>(run.a + i);
                            const auto b = static_cast<std::size_t>(run.b + i);
                            squared = std::max(squared, (x[b] - x[a]).squaredNorm());
                          }
                          largest.ratio = std::max(largest.ratio, std::sqrt(squared) / rest);
                        }
                        return largest;
                      })
      .ratio;
}

}  // namespace

struct Simulation::Parts {
  std::shared_ptr<const Model> model;
  SimulationOptions options;
  std::vector<LoadTerm> loads;  ///< those of the model, then those that were added
  State state;
  Stepper stepper;
  std::unique_ptr<ContactGuard> guard;  ///< null if nothing can touch
  Holds holds;
  Tally tally;
  int frame = 0;
  int steps_done = 0;
  double wall_ms = 0;  ///< spent on the frame in work
  double linearize_seconds = 0, solve_seconds = 0;
  Diagnostics diagnostics;
  std::vector<std::uint8_t> fixed;
  std::vector<Vec3> targets;
  std::vector<double> masses;  ///< as the solver wants them: none is 0

  Parts(std::shared_ptr<const Model> the_model, const SimulationOptions& the_options);
  const TimeSettings& time() const { return model->scene.time; }
  double time_of(int at_frame, int steps) const {
    // One division of whole numbers, so that second 1 is exactly 1 however many steps lead there.
    return (static_cast<double>(at_frame) * time().steps_per_frame + steps) /
           (time().frame_rate * time().steps_per_frame);
  }
  void start_contact();
  void touch();
  void advance();
  void step();
  void advance_by(double length, int halvings);
  void account(const StepContext& context, double length, const State& before,
               const std::vector<std::unique_ptr<Potential>>& acting_loads);
  void restore_stored(const std::vector<std::uint64_t>& terms, const std::vector<double>& saved);
  std::vector<std::unique_ptr<Potential>> potentials_of_loads(const StepContext& context) const;
  std::vector<std::uint64_t> term_keys() const;
  EnergyRole role_of(std::size_t slot) const {
    return slot < model->potentials.size() ? model->potentials[slot].role
                                           : loads[slot - model->potentials.size()].role;
  }
  void store_energies();
  void put(State changed);
  void keep_prescribed(ConstVectors from, Vectors to) const;
  void describe_state(Diagnostics& row) const;
  void finish_frame();
  [[noreturn]] void fail(const StepReport& report) const;
};

/// Farther from the origin than the distance to the sun is no place for cloth: it was shot there by a force
/// or a speed that nobody meant. Caches hold floats, which end at 3e38 m.
constexpr double farthest = 1.5e11;  // [m]

void require_count(ConstVectors vectors, std::size_t count, const char* what) {
  if (vectors.size() == count) return;
  throw Error(ErrorKind::usage, fmt::format("{} {} for {} vertices", vectors.size(), what, count),
              "give one for each vertex of all bodies, in the order of the state");
}

int vertex_out_of_range(ConstVectors x) {
  for (std::size_t v = 0; v < x.size(); ++v)
    if (!(x[v].cwiseAbs().maxCoeff() <= farthest)) return static_cast<int>(v);
  return -1;
}

Simulation::Parts::Parts(std::shared_ptr<const Model> the_model, const SimulationOptions& the_options)
    : model(std::move(the_model)), options(the_options), loads(model->loads) {
  const std::size_t count = model->vertex_count();
  state.positions = model->rest_positions;
  state.velocities = model->velocities;
  state.velocities.resize(count, Vec3::Zero());
  // What moves as it is told has no mass, but solvers divide by masses before they leave it out.
  masses = model->masses;
  for (const Prescribed& motion : model->prescribed)
    std::fill_n(masses.begin() + motion.first, motion.start.size(), 1.0);
  fixed.resize(count);
  targets.resize(count);
  if (model->contact) start_contact();

  store_energies();
  finish_frame();
}

void Simulation::Parts::start_contact() {
  if (model->scene.solver.integrator == Integrator::symplectic_euler)
    throw Error(ErrorKind::usage, "symplectic_euler does not work with contact",
                "use implicit_euler, bdf2 or linearly_implicit_euler");
  if (!options.allow_tangled)
    refuse_crossings(*model->contact, state.positions, {model->scene.file.string()});
  touch();
  tally.smallest_gap = guard->memory().smallest_gap;
}

/// Contact without a past, at positions where nothing crosses.
void Simulation::Parts::touch() {
  guard = std::make_unique<ContactGuard>(model->contact);
  if (options.allow_tangled) guard->leave_tangled(state.positions);
  guard->begin(state.positions, time().step(), fixed);
  guard->potential(state.positions);
  guard->end(state.positions);
  tally.pressed = guard->last_potential().parts(state.positions).normal;
}

void Simulation::Parts::store_energies() {
  const StepContext context = step_context(model->scene.solver.integrator, state, time().step());
  tally.stored.clear();
  for (const PotentialTerm& term : model->potentials)
    tally.stored.push_back(is_stored(term.role) ? term.potential->value(state.positions) : 0.0);
  for (const LoadTerm& term : loads) {
    const auto acting = is_stored(term.role) ? term.load->potential(context) : nullptr;
    tally.stored.push_back(acting ? acting->value(state.positions) : 0.0);
  }
}

std::vector<std::uint64_t> Simulation::Parts::term_keys() const {
  std::vector<std::uint64_t> keys;
  for (const PotentialTerm& term : model->potentials)
    keys.push_back(hash_bytes(term.name.data(), term.name.size()));
  for (const LoadTerm& term : loads) keys.push_back(hash_bytes(term.name.data(), term.name.size()));
  return keys;
}

std::vector<std::unique_ptr<Potential>> Simulation::Parts::potentials_of_loads(
    const StepContext& context) const {
  std::vector<std::unique_ptr<Potential>> potentials;
  for (const LoadTerm& term : loads) potentials.push_back(term.load->potential(context));
  return potentials;
}

void Simulation::Parts::advance() {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  step();
  wall_ms += std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
  if (steps_done < time().steps_per_frame) return;
  ++frame;
  steps_done = 0;
  finish_frame();
}

void Simulation::Parts::step() {
  const State start = state;
  const Holds start_holds = holds;
  const Tally start_tally = tally;
  const std::vector<PairSlip> start_slips = guard ? guard->memory().slips : std::vector<PairSlip>();
  const auto go_back = [&] {
    state = start;
    holds = start_holds;
    tally = start_tally;
    if (guard) guard->restore_slips(start_slips);
  };
  try {
    advance_by(time().step(), 0);
    const int lost = vertex_out_of_range(state.positions);
    if (lost >= 0) throw StepFailure{{.worst_vertex = lost, .failure = "it flew farther than 1.5e11 m"}};
  } catch (const StepFailure& failure) {
    go_back();
    fail(failure.report);
  } catch (...) {
    go_back();
    throw;
  }
  ++steps_done;
  state.time = time_of(frame, steps_done);
}

void Simulation::Parts::advance_by(double length, int halvings) {
  SolverSettings settings = model->scene.solver;
  if (guard && model->contact->mode == ContactMode::fast) settings.effort = Effort::fast;
  const State before = state;
  StepContext context = step_context(settings.integrator, before, length);
  const auto acting_loads = potentials_of_loads(context);
  Holds next = holds;
  next.step(model->pins, context.time_begin, context.time_end, before.positions, fixed, targets);
  for (const Prescribed& motion : model->prescribed) motion.hold(context.time_end, fixed, targets);
  for (const Body& body : model->bodies) {
    const auto first = static_cast<std::size_t>(body.first_vertex);
    if (body.is_rigid() && fixed[first] == 0) predict_rigid(settings.integrator, before, first, context);
  }

  StepProblem problem{masses, {}, fixed, targets, guard.get(), model->rest_positions};
  for (const PotentialTerm& term : model->potentials) problem.potentials.push_back(term.potential.get());
  for (const auto& load : acting_loads)
    if (load) problem.potentials.push_back(load.get());
  const StepReport report = stepper.step(settings, context, problem, state);
  tally.newton += report.newton_iterations;
  tally.linear += report.linear_iterations;
  linearize_seconds += report.linearize_seconds;
  solve_seconds += report.solve_seconds;
  if (!report.made()) {
    if (halvings == max_halvings) throw StepFailure{report};
    advance_by(length / 2, halvings + 1);
    advance_by(length / 2, halvings + 1);
    return;
  }
  tally.residual = std::max(tally.residual, report.residual);
  tally.held_back = report.held_back;
  if (guard) tally.smallest_gap = std::min(tally.smallest_gap, guard->memory().smallest_gap);
  holds = std::move(next);
  account(context, length, before, acting_loads);
}

void Simulation::Parts::account(const StepContext& context, double length, const State& before,
                                const std::vector<std::unique_ptr<Potential>>& acting_loads) {
  std::vector<ActingPotential> acts;
  std::size_t slot = 0;
  // Fast steps do not obey their equation closely enough for a balance to be a check: what is stored is known
  // by its values, which saves most of the work.
  const bool by_values = guard && model->contact->mode == ContactMode::fast;
  for (const PotentialTerm& term : model->potentials) {
    ActingPotential act{term.role, term.potential.get()};
    if (is_stored(term.role)) {
      const double stored = term.potential->value(state.positions);
      if (by_values) act.gain = stored - tally.stored[slot];
      tally.stored[slot] = stored;
    }
    acts.push_back(act);
    ++slot;
  }
  for (std::size_t i = 0; i < acting_loads.size(); ++i, ++slot) {
    const EnergyRole role = role_of(slot);
    if (acting_loads[i]) acts.push_back({role, acting_loads[i].get()});
    if (!is_stored(role)) continue;
    // A field that is switched or turned while a body is in it does work on the body.
    const double begin = acting_loads[i] ? acting_loads[i]->value(before.positions) : 0.0;
    tally.work += begin - tally.stored[slot];
    tally.stored[slot] = acting_loads[i] ? acting_loads[i]->value(state.positions) : 0.0;
  }
  if (guard) {
    const ContactPotential& contact = guard->last_potential();
    const double pressed = contact.parts(state.positions).normal;
    acts.push_back({EnergyRole::elastic, &contact, pressed - tally.pressed});
    tally.pressed = pressed;
  }
  const EnergyFlow flow = energy_flow(
      {model->scene.solver.integrator, length, &context, &before, &state, model->masses, fixed, acts});
  tally.work += flow.work;
  tally.dissipated += flow.dissipated;
  tally.unbalanced += flow.unbalanced;
}

void Simulation::Parts::describe_state(Diagnostics& row) const {
  row.kinetic = kinetic_energy(model->masses, state.velocities);
  row.elastic = row.potential = 0;
  for (std::size_t slot = 0; slot < tally.stored.size(); ++slot) {
    if (role_of(slot) == EnergyRole::elastic) row.elastic += tally.stored[slot];
    if (role_of(slot) == EnergyRole::potential) row.potential += tally.stored[slot];
  }
  row.elastic += tally.pressed;
  row.work = tally.work;
  row.dissipated = tally.dissipated;
  row.unbalanced = tally.unbalanced;
  row.momentum = total_momentum(model->masses, state.velocities);
  row.max_stretch = model->bodies.empty() ? 1 : 0;
  for (const Body& body : model->bodies)
    row.max_stretch = std::max(row.max_stretch, max_stretch(body, model->of(body, state.positions)));
}

void Simulation::Parts::finish_frame() {
  Diagnostics row;
  row.frame = frame;
  row.time = state.time;
  describe_state(row);
  row.newton_iterations = static_cast<int>(tally.newton);
  row.linear_iterations = static_cast<int>(tally.linear);
  row.residual = tally.residual;
  row.min_distance = tally.smallest_gap;
  row.held_back = tally.held_back;
  row.wall_ms = wall_ms;
  diagnostics = row;
  tally.newton = tally.linear = 0;
  tally.residual = 0;
  tally.smallest_gap = std::numeric_limits<double>::infinity();
  wall_ms = 0;
}

/// What moves as it is told does not move otherwise.
void Simulation::Parts::keep_prescribed(ConstVectors from, Vectors to) const {
  for (const Prescribed& motion : model->prescribed) {
    const auto first = static_cast<std::size_t>(motion.first), count = motion.start.size();
    std::copy_n(from.subspan(first, count).begin(), count, to.subspan(first, count).begin());
  }
}

void Simulation::Parts::put(State changed) {
  const auto energy = [&] {
    double sum = kinetic_energy(model->masses, state.velocities) + tally.pressed;
    for (const double stored : tally.stored) sum += stored;
    return sum;
  };
  const double before = energy();
  const bool moved = changed.positions != state.positions;
  state = std::move(changed);
  state.previous_positions.clear();
  state.previous_velocities.clear();
  state.previous_dt = 0;
  if (moved) {
    holds.take_anew(model->pins, state.time, state.positions);
    if (guard) touch();
  }
  store_energies();
  tally.work += energy() - before;
  if (steps_done > 0) return;
  describe_state(diagnostics);
  if (guard && moved) diagnostics.min_distance = guard->memory().smallest_gap;
}

void Simulation::Parts::fail(const StepReport& report) const {
  std::string place;
  if (report.worst_vertex >= 0) {
    const Vec3& x = state.positions[static_cast<std::size_t>(report.worst_vertex)];
    for (const Body& body : model->bodies) {
      const int local = report.worst_vertex - body.first_vertex;
      if (local >= 0 && local < body.vertex_count)
        place = fmt::format(", worst in body \"{}\" near ({:.4g}, {:.4g}, {:.4g}) m", body.name, x.x(), x.y(),
                            x.z());
    }
    if (place.empty()) place = fmt::format(", worst near ({:.4g}, {:.4g}, {:.4g}) m", x.x(), x.y(), x.z());
  }
  const bool explicit_steps = model->scene.solver.integrator == Integrator::symplectic_euler;
  throw Error(ErrorKind::solver,
              fmt::format("the solver could not go on in frame {} after {:.6g} s, even with steps halved {} "
                          "times{}: {}",
                          frame + 1, state.time, max_halvings, place, report.failure),
              fmt::format("raise time.steps_per_frame (now {}){}", time().steps_per_frame,
                          explicit_steps ? ", soften the material, or use solver.integrator = "
                                           "\"implicit_euler\", which has no limit on the step"
                                         : ", soften the material, or look at the pins and forces there"));
}

Simulation::Simulation(std::shared_ptr<const Model> model, const SimulationOptions& options)
    : parts_(std::make_unique<Parts>(std::move(model), options)) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

const Model& Simulation::model() const { return *parts_->model; }
const SimulationOptions& Simulation::options() const { return parts_->options; }
const State& Simulation::state() const { return parts_->state; }
int Simulation::frame() const { return parts_->frame; }
int Simulation::steps_done() const { return parts_->steps_done; }
const Diagnostics& Simulation::diagnostics() const { return parts_->diagnostics; }

std::size_t Simulation::tangled() const { return parts_->guard ? parts_->guard->tangled() : 0; }

RunCosts Simulation::costs() const {
  RunCosts costs;
  costs.linearize = parts_->linearize_seconds;
  costs.solve = parts_->solve_seconds;
  if (!parts_->guard) return costs;
  const ContactCounts& counts = parts_->guard->counts();
  costs.search = counts.search_seconds;
  costs.limit = counts.limit_seconds;
  costs.contact = counts.potential_seconds;
  costs.searches = static_cast<std::int64_t>(counts.searches);
  costs.limits = static_cast<std::int64_t>(counts.limits);
  costs.deflected = static_cast<std::int64_t>(counts.deflected);
  costs.shortened = static_cast<std::int64_t>(counts.shortened);
  return costs;
}

void Simulation::step() { parts_->advance(); }

void Simulation::advance(const Progress& progress) {
  Parts& parts = *parts_;
  const int frame = parts.frame;
  while (parts.frame == frame) {
    progress.at(static_cast<double>(parts.steps_done) / parts.time().steps_per_frame, "simulation");
    parts.advance();
  }
}

void Simulation::add_load(LoadTerm load) {
  parts_->loads.push_back(std::move(load));
  parts_->tally.stored.push_back(0.0);
}

void Simulation::set_positions(ConstVectors positions) {
  Parts& parts = *parts_;
  require_count(positions, parts.state.positions.size(), "positions");
  const int lost = vertex_out_of_range(positions);
  if (lost >= 0) {
    throw Error(ErrorKind::usage,
                fmt::format("the position of vertex {} is not finite or beyond {:.2g} m", lost, farthest),
                "give finite positions in metres");
  }
  State changed = parts.state;
  changed.positions.assign(positions.begin(), positions.end());
  parts.keep_prescribed(parts.state.positions, changed.positions);
  if (parts.guard && !parts.options.allow_tangled) refuse_crossings(*parts.model->contact, changed.positions);
  parts.put(std::move(changed));
}

void Simulation::set_velocities(ConstVectors velocities) {
  Parts& parts = *parts_;
  require_count(velocities, parts.state.velocities.size(), "velocities");
  for (std::size_t v = 0; v < velocities.size(); ++v) {
    if (velocities[v].allFinite()) continue;
    throw Error(ErrorKind::usage, fmt::format("the velocity of vertex {} is not finite", v),
                "give finite velocities in metres per second");
  }
  State changed = parts.state;
  changed.velocities.assign(velocities.begin(), velocities.end());
  parts.keep_prescribed(parts.state.velocities, changed.velocities);
  parts.put(std::move(changed));
}

std::vector<std::uint8_t> Simulation::checkpoint() const {
  const Parts& parts = *parts_;
  SavedRun saved;
  saved.header = {model_fingerprint(*parts.model), parts.frame, parts.steps_done,
                  parts.time().steps_per_frame};
  saved.state = parts.state;
  saved.pins = pin_keys(parts.model->pins);
  saved.holds = parts.holds;
  saved.terms = parts.term_keys();
  saved.tally = parts.tally;
  if (parts.guard) saved.contact = parts.guard->memory();
  saved.diagnostics = parts.diagnostics;
  return to_bytes(saved);
}

void Simulation::restore(const std::vector<std::uint8_t>& bytes) {
  Parts& parts = *parts_;
  const CheckpointHeader header = read_checkpoint_header(bytes);
  if (header.fingerprint != model_fingerprint(*parts.model)) {
    throw Error(ErrorKind::input,
                "the checkpoint belongs to other bodies: a mesh, a lattice or a material changed",
                "undo the change, or start the run anew");
  }
  if (header.steps != 0 && header.steps_per_frame != parts.time().steps_per_frame) {
    throw Error(ErrorKind::input,
                fmt::format("the checkpoint lies inside a frame of {} steps, the scene now has {}",
                            header.steps_per_frame, parts.time().steps_per_frame),
                "resume from the checkpoint before it");
  }
  SavedRun saved = saved_run(bytes, parts.model->vertex_count());
  if (parts.guard) {
    if (!parts.options.allow_tangled)
      refuse_crossings(*parts.model->contact, saved.state.positions, {parts.model->scene.file.string()});
    parts.guard->restore(std::move(saved.contact));
    if (parts.options.allow_tangled) parts.guard->leave_tangled(saved.state.positions);
  } else {
    saved.tally.work -= saved.tally.pressed;
    saved.tally.pressed = 0;
  }
  parts.holds = holds_of(parts.model->pins, saved);
  parts.state = std::move(saved.state);
  parts.tally = std::move(saved.tally);
  parts.frame = saved.diagnostics.frame;
  parts.steps_done = static_cast<int>(header.steps);
  parts.wall_ms = 0;
  parts.diagnostics = saved.diagnostics;
  const std::vector<double> stored = std::move(parts.tally.stored);
  parts.restore_stored(saved.terms, stored);
}

void Simulation::Parts::restore_stored(const std::vector<std::uint64_t>& terms,
                                       const std::vector<double>& saved) {
  const std::vector<std::uint64_t> keys = term_keys();
  std::vector<bool> used(saved.size(), false);
  tally.stored.assign(keys.size(), 0.0);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    for (std::size_t j = 0; j < saved.size(); ++j) {
      if (used[j] || terms[j] != keys[i]) continue;
      used[j] = true;
      tally.stored[i] = saved[j];
      break;
    }
  }
  // Energy that came or went because the scene was changed in between was put in or taken out from outside.
  for (std::size_t j = 0; j < saved.size(); ++j)
    if (!used[j]) tally.work -= saved[j];
  for (std::size_t i = 0; i < model->potentials.size(); ++i) {
    if (!is_stored(model->potentials[i].role)) continue;
    const double now = model->potentials[i].potential->value(state.positions);
    tally.work += now - tally.stored[i];
    tally.stored[i] = now;
  }
}

}  // namespace muslin
