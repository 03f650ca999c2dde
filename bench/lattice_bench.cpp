// Time per step of muslin and of the textbook method to a given error, on the same problems in one run.
//
// muslin takes every step with a row of tolerances; the counters of each give the error against a tightly
// solved step, ‖x − x*‖ / ‖x* − x_n‖, residual and energy (both by the textbook's own formulas), and the
// least time of its repetitions. The textbook method is watched on its way: its counters give the time at
// which an iterate first was good enough, without the time of finding out. bench/run makes the tables of it.
#include <cmath>
#include <map>
#include <string>

#include "clock.hpp"
#include "parts.hpp"
#include "problems.hpp"
#include "systems.hpp"
#include "triad.hpp"
#include <benchmark/benchmark.h>

namespace muslin::bench {
namespace {

constexpr double gravity = 9.8;  // [m/s²]: residuals are told as multiples of it

double norm(ConstVectors a, ConstVectors b) {
  double sum = 0;
  for (std::size_t v = 0; v < a.size(); ++v) sum += (a[v] - b[v]).squaredNorm();
  return std::sqrt(sum);
}

/// The problem and its tight solution, made when first asked for; the last one only is kept.
struct Reference {
  Problem problem;
  std::unique_ptr<TextbookSolver> textbook;
  std::vector<Vec3> solution;
  double scale = 0;        ///< ‖x* − x_n‖
  double energy_drop = 0;  ///< of E from x_n to x*

  TextbookMeasure measure(ConstVectors x) const {
    return textbook->measure(problem.state.positions, problem.state.velocities, x);
  }
  double error(ConstVectors x) const { return norm(x, solution) / scale; }

  static const Reference& of(const ProblemSettings& settings) {
    static std::string name, failure;
    static Reference reference;
    if (name != settings.name) {
      name = settings.name;
      reference = {};
      failure = reference.make(settings);
    }
    if (!failure.empty()) throw std::runtime_error(failure);
    return reference;
  }

 private:
  /// Returns the error in words; empty if there was none.
  std::string make(const ProblemSettings& settings) try {
    problem = make_problem(settings);
    textbook = std::make_unique<TextbookSolver>(problem.textbook());
    State state = problem.state;
    SolverSettings tight;
    tight.tolerance = 1e-8;
    const StepContext context = step_context(tight.integrator, state, settings.dt);
    const StepReport report = solve_step(tight, context, problem.step_problem(), state);
    if (!report.converged) return "no reference: " + report.failure;
    solution = state.positions;
    scale = norm(solution, problem.state.positions);
    energy_drop = measure(problem.state.positions).energy - measure(solution).energy;
    return "";
  } catch (const std::exception& error) {
    return error.what();
  }
};

void describe(benchmark::State& state, const Reference& reference) {
  state.counters["vertices"] = static_cast<double>(reference.problem.masses.size());
  state.counters["voxels"] = static_cast<double>(reference.problem.lattice.voxel_count());
  state.counters["stiffness_number"] = reference.problem.stiffness_number();
  state.counters["compressed"] = reference.problem.compressed_share();
}

void describe(benchmark::State& state, const Reference& reference, const Least& time) {
  state.SetIterationTime(time.wall);
  state.counters["ms"] = 1e3 * time.seconds;
  state.counters["wall_ms"] = 1e3 * time.wall;
  describe(state, reference);
}

/// Adds the result of a step to the counters.
void describe(benchmark::State& state, const Reference& reference, ConstVectors result) {
  const TextbookMeasure measure = reference.measure(result);
  state.counters["error"] = reference.error(result);
  state.counters["residual"] = measure.residual / gravity;
  state.counters["energy"] =
      (measure.energy - reference.measure(reference.solution).energy) / reference.energy_drop;
}

void take_steps(benchmark::State& state, const ProblemSettings& settings, const SolverSettings& solver,
                int threads) {
  const Reference& reference = Reference::of(settings);
  const Problem& problem = reference.problem;
  set_thread_count(threads);
  for (auto _ : state) {
    Stepper stepper;
    State after;
    StepReport report;
    const Least time = Least::of([&] { after = problem.state; },
                                 [&] {
                                   const StepContext context =
                                       step_context(solver.integrator, after, problem.dt);
                                   report = stepper.step(solver, context, problem.step_problem(), after);
                                 });
    if (!report.converged) state.SkipWithError(report.failure.c_str());
    describe(state, reference, time);
    state.counters["newton"] = report.newton_iterations;
    state.counters["linear"] = report.linear_iterations;
    state.counters["bytes_per_vertex"] =
        static_cast<double>(stepper.bytes()) / static_cast<double>(problem.masses.size());
    describe(state, reference, after.positions);
  }
}

void muslin_step(benchmark::State& state, const ProblemSettings& settings, double tolerance, int threads) {
  SolverSettings solver;
  solver.tolerance = tolerance;
  take_steps(state, settings, solver, threads);
}

/// Vega's case: one linearly implicit step, conjugate gradients to 1e-6.
void muslin_linear(benchmark::State& state, const ProblemSettings& settings, int threads) {
  SolverSettings solver;
  solver.integrator = Integrator::linearly_implicit_euler;
  take_steps(state, settings, solver, threads);
}

/// When the textbook's iterates first were how good, as counters "error<e>_ms" and "residual<r>_ms" with
/// "…_newton" and "…_linear". Finding out is not counted.
class Milestones {
 public:
  explicit Milestones(const Reference& reference) : reference_(reference) {}

  void begin() {
    clock_ = Clock();
    paused_ = 0;
  }
  double seconds() const { return clock_.seconds() - paused_; }

  /// True when all there is to reach is reached. Where the error stays, because the method is on its way to
  /// another minimum, that is when the residual is out of the question.
  bool note(ConstVectors x, const TextbookReport& report) {
    const double now = seconds();
    const Clock pause;
    const double error = reference_.error(x), residual = report.residual / gravity;
    mark("error1e-3", error <= 1e-3, now, report);
    mark("error1e-6", error <= 1e-6, now, report);
    mark("residual1e-0", residual <= 1, now, report);
    mark("residual1e-3", residual <= 1e-3, now, report);
    paused_ += pause.seconds();
    return (error <= 1e-6 && residual <= 1e-3) || residual <= 1e-6;
  }

  const std::map<std::string, double>& counters() const { return counters_; }

 private:
  void mark(const std::string& goal, bool good, double now, const TextbookReport& report) {
    if (!good) return;
    const auto [newton, first] = counters_.try_emplace(goal + "_newton", report.newton_iterations);
    if (!first && newton->second < report.newton_iterations) return;
    counters_[goal + "_linear"] = report.linear_iterations;
    const auto [time, added] = counters_.try_emplace(goal + "_ms", 1e3 * now);
    time->second = std::min(time->second, 1e3 * now);
  }

  const Reference& reference_;
  Clock clock_;
  double paused_ = 0;
  std::map<std::string, double> counters_;
};

/// One step with linear systems solved to the relative residual `forcing`, given up after `limit` seconds.
void textbook_step(benchmark::State& state, const ProblemSettings& settings, double forcing, double limit) {
  const Reference& reference = Reference::of(settings);
  const State& start = reference.problem.state;
  set_thread_count(1);
  for (auto _ : state) {
    Milestones milestones(reference);
    std::vector<Vec3> x;
    const auto watch = [&](ConstVectors now, const TextbookReport& report) {
      return milestones.note(now, report);
    };
    const auto give_up = [&] { return milestones.seconds() > limit; };
    const Least time = Least::of([&] {
      std::vector<Vec3> v = start.velocities;
      x = start.positions;
      milestones.begin();
      reference.textbook->implicit_euler(forcing, watch, give_up, x, v);
      state.counters["spent_ms"] = 1e3 * milestones.seconds();
    });
    describe(state, reference, time);
    for (const auto& [name, value] : milestones.counters()) state.counters[name] = value;
    state.counters["bytes_per_vertex"] =
        static_cast<double>(reference.textbook->bytes()) / static_cast<double>(start.positions.size());
    describe(state, reference, x);
  }
}

void textbook_linear(benchmark::State& state, const ProblemSettings& settings) {
  const Reference& reference = Reference::of(settings);
  set_thread_count(1);
  for (auto _ : state) {
    TextbookReport report;
    const Least time = Least::of([&] {
      std::vector<Vec3> x = reference.problem.state.positions, v = reference.problem.state.velocities;
      report = reference.textbook->linearly_implicit_euler(1e-6, x, v);
    });
    describe(state, reference, time);
    state.counters["linear"] = report.linear_iterations;
  }
}

/// Nanoseconds per vertex and call of what a step is made of, on one thread.
void parts(benchmark::State& state, const ProblemSettings& settings) {
  const Problem problem = make_problem(settings);
  set_thread_count(1);
  for (auto _ : state) {
    const Clock clock;
    for (const auto& [name, value] : parts_of_a_step(problem)) state.counters[name] = value;
    state.SetIterationTime(clock.wall());
  }
  state.counters["vertices"] = static_cast<double>(problem.masses.size());
}

/// The first linear system of a step, with the coarse space or without.
void system(benchmark::State& state, const ProblemSettings& settings, double dt, bool coarse_space) {
  Problem problem = make_problem(settings);
  problem.coarse_space = coarse_space;
  set_thread_count(1);
  for (auto _ : state) {
    const Clock clock;
    for (const auto& [name, value] : lattice_system(problem, dt)) state.counters[name] = value;
    state.SetIterationTime(clock.wall());
  }
  state.counters["voxels"] = static_cast<double>(problem.lattice.voxel_count());
}

void cloth(benchmark::State& state, int n, bool coarse_space) {
  set_thread_count(1);
  for (auto _ : state) {
    const Clock clock;
    for (const auto& [name, value] : cloth_steps(n, coarse_space)) state.counters[name] = value;
    state.SetIterationTime(clock.wall());
  }
}

void triad(benchmark::State& state, int threads) {
  set_thread_count(threads);
  for (auto _ : state) {
    const double rate = stream_triad();
    state.SetIterationTime(24.0 / rate);
    state.counters["bytes_per_second"] = rate;
  }
}

template <class Run>
void add(const std::string& name, const Run& run) {
  const auto reporting = [run](benchmark::State& state) {
    try {
      run(state);
    } catch (const std::exception& error) {
      state.SkipWithError(error.what());
    }
    set_thread_count(0);
  };
  benchmark::RegisterBenchmark(name.c_str(), reporting)
      ->UseManualTime()
      ->Iterations(1)
      ->Unit(benchmark::kMillisecond);
}

void add_benchmarks() {
  using benchmark::State;
  for (const int threads : {1, 2})
    add("triad/threads:" + std::to_string(threads), [=](State& s) { triad(s, threads); });
  for (const char* name : {"flag_100x60", "flag_400x240", "falling_1000x600", "cube_40"})
    add(std::string(name) + "/parts", [settings = case_named(name)](State& s) { parts(s, settings); });
  for (const bool coarse : {true, false}) {
    const std::string way = coarse ? "/with" : "/without";
    for (const char* name : {"flag_10x6", "flag_100x60", "flag_400x240", "flag_1000x600", "falling_1000x600",
                             "cube_20", "cube_40", "cube_80"}) {
      for (const bool lengthy : {false, true}) {
        add(std::string("system/") + name + (lengthy ? "/long" : "/brief") + way,
            [=, settings = case_named(name)](State& s) {
              system(s, settings, lengthy ? 1.0 / 24 : 1.0 / 240, coarse);
            });
      }
    }
    for (const int n : {50, 100, 200})
      add("cloth/" + std::to_string(n) + way, [=](State& s) { cloth(s, n, coarse); });
  }
  for (const ProblemSettings& settings : cases()) {
    if (settings.only_system) continue;
    // Long steps have several minima and are compared by residual alone. On two threads only what is needed
    // for an error of 1e-6.
    const bool lengthy = settings.dt > 0.01;
    const auto sweep = [&](int threads, const std::vector<const char*>& tolerances) {
      for (const std::string tolerance : tolerances) {
        add(settings.name + "/muslin/threads:" + std::to_string(threads) + "/tolerance:" + tolerance,
            [=](State& s) { muslin_step(s, settings, std::stod(tolerance), threads); });
      }
    };
    sweep(1,
          lengthy ? std::vector{"1e-2", "1e-4"} : std::vector{"1", "1e-1", "1e-2", "1e-3", "1e-4", "1e-5"});
    sweep(2, lengthy ? std::vector{"1e-4"} : std::vector{"1e-3", "1e-4", "1e-5"});
    // As books have it, every linear system solved to 1e-6; and with the quickest forcing term.
    const double limit = lengthy ? 15 : 60;  // [s]
    add(settings.name + "/textbook_inexact", [=](State& s) { textbook_step(s, settings, 0.1, limit); });
    if (!lengthy)
      add(settings.name + "/textbook", [=](State& s) { textbook_step(s, settings, 1e-6, limit); });
    if (settings.name == "flag_10x6" || settings.name == "flag_100x60" || settings.name == "flag_400x240") {
      for (const int threads : {1, 2}) {
        add(settings.name + "/muslin_linear/threads:" + std::to_string(threads),
            [=](State& s) { muslin_linear(s, settings, threads); });
      }
      add(settings.name + "/textbook_linear", [=](State& s) { textbook_linear(s, settings); });
    }
  }
}

}  // namespace
}  // namespace muslin::bench

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  muslin::bench::add_benchmarks();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
