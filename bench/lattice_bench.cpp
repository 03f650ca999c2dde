// Time per step of muslin and of the textbook method to a given error, on the same problems in one run.
//
// Every case takes one step from the same state with one tolerance; its counters give the error against a
// tightly solved step, ‖x − x*‖ / ‖x* − x_n‖, and the least time of its repetitions. bench/run picks, for
// either method, the least time whose error is at most 1e-3 and 1e-6. Run with --benchmark_filter=… to
// choose.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <map>
#include <string>

#include "problems.hpp"
#include "triad.hpp"
#include <benchmark/benchmark.h>

#include "muslin/core/parallel.hpp"

namespace muslin::bench {
namespace {

constexpr double gravity = 9.8;  // [m/s²]: tolerances are multiples of it

const std::vector<ProblemSettings> cases = {
    {"flag_10x6", {10, 6, 1}, 1, 1.0 / 240, false, 240},
    {"flag_100x60", {100, 60, 1}, 0.1, 1.0 / 240, false, 200},
    {"crumpled_100x60", {100, 60, 1}, 0.1, 1.0 / 240, true, 2},
    {"flag_400x240", {400, 240, 1}, 0.025, 1.0 / 240, false, 60},
    {"flag_1000x600", {1000, 600, 1}, 0.01, 1.0 / 240, false, 6},
    {"cube_20", {20, 20, 20}, 0.2, 1.0 / 240, false, 20},
    {"cube_40", {40, 40, 40}, 0.1, 1.0 / 240, false, 10},
    {"cube_80", {80, 80, 80}, 0.05, 1.0 / 240, false, 4},
    {"long_100x60", {100, 60, 1}, 0.1, 1.0 / 24, false, 6},
    {"long_400x240", {400, 240, 1}, 0.025, 1.0 / 24, false, 3},
};

double norm(ConstVectors a, ConstVectors b) {
  double sum = 0;
  for (std::size_t v = 0; v < a.size(); ++v) sum += (a[v] - b[v]).squaredNorm();
  return std::sqrt(sum);
}

/// The problem and its tight solution, made when first asked for; the last one only is kept.
struct Reference {
  Problem problem;
  std::vector<Vec3> solution;
  double scale = 0;  ///< ‖x* − x_n‖

  static const Reference& of(const ProblemSettings& settings) {
    static std::string name;
    static Reference reference;
    if (name == settings.name) return reference;
    reference.problem = make_problem(settings);
    name = settings.name;
    State state = reference.problem.state;
    SolverSettings tight;
    tight.tolerance = 1e-6 * gravity;
    tight.max_iterations = 1000;
    const StepReport report = solve_step(tight, step_context(tight.integrator, state, settings.dt),
                                         reference.problem.step_problem(), state);
    if (!report.converged) throw std::runtime_error(settings.name + ": no reference, " + report.failure);
    reference.solution = state.positions;
    reference.scale = norm(reference.solution, reference.problem.state.positions);
    return reference;
  }
};

template <class Step>
void measure(benchmark::State& state, const ProblemSettings& settings, const Step& step) {
  const Reference& reference = Reference::of(settings);
  double best = INFINITY, error = 0;
  for (auto _ : state) {
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t used = std::clock();
    const auto [x, newton, linear] = step(reference.problem);
    const double busy = static_cast<double>(std::clock() - used) / CLOCKS_PER_SEC;
    const double passed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    // On a machine that is shared, the processor time of one thread is the better clock.
    const double seconds = thread_count() == 1 && passed > 1e-3 ? std::min(busy, passed) : passed;
    best = std::min(best, seconds);
    state.SetIterationTime(seconds);
    error = reference.scale > 0 ? norm(x, reference.solution) / reference.scale : 0;
    state.counters["newton"] = newton;
    state.counters["linear"] = linear;
  }
  state.counters["best_ms"] = 1e3 * best;
  state.counters["error"] = error;
  state.counters["vertices"] = static_cast<double>(reference.problem.masses.size());
  state.counters["voxels"] = static_cast<double>(reference.problem.lattice.voxel_count());
  state.counters["stiffness_number"] = reference.problem.stiffness_number();
}

struct Outcome {
  std::vector<Vec3> x;
  int newton, linear;
};

void muslin_step(benchmark::State& state, const ProblemSettings& settings, double tolerance, int threads) {
  set_thread_count(threads);
  Stepper stepper;
  measure(state, settings, [&](const Problem& problem) {
    State s = problem.state;
    SolverSettings solver;
    solver.tolerance = tolerance * gravity;
    solver.max_iterations = 1000;
    const StepContext context = step_context(solver.integrator, s, problem.dt);
    const StepReport report = stepper.step(solver, context, problem.step_problem(), s);
    if (!report.converged) state.SkipWithError(report.failure.c_str());
    return Outcome{std::move(s.positions), report.newton_iterations, report.linear_iterations};
  });
  state.counters["bytes_per_vertex"] =
      static_cast<double>(stepper.bytes()) / state.counters["vertices"].value;
  set_thread_count(0);
}

void textbook_step(benchmark::State& state, const ProblemSettings& settings, double tolerance) {
  TextbookSolver solver(Reference::of(settings).problem.textbook());
  set_thread_count(1);
  measure(state, settings, [&](const Problem& problem) {
    std::vector<Vec3> x = problem.state.positions, v = problem.state.velocities;
    const TextbookReport report = solver.implicit_euler(tolerance * gravity, 0.1, x, v);
    if (!report.converged) state.SkipWithError("not converged");
    return Outcome{std::move(x), report.newton_iterations, report.linear_iterations};
  });
  state.counters["bytes_per_vertex"] = static_cast<double>(solver.bytes()) / state.counters["vertices"].value;
}

/// Vega's case: one linearly implicit step, conjugate gradients to 1e-6.
void muslin_linear(benchmark::State& state, const ProblemSettings& settings, int threads) {
  set_thread_count(threads);
  Stepper stepper;
  measure(state, settings, [&](const Problem& problem) {
    State s = problem.state;
    SolverSettings solver;
    solver.integrator = Integrator::linearly_implicit_euler;
    const StepContext context = step_context(solver.integrator, s, problem.dt);
    const StepReport report = stepper.step(solver, context, problem.step_problem(), s);
    if (!report.converged) state.SkipWithError(report.failure.c_str());
    return Outcome{std::move(s.positions), report.newton_iterations, report.linear_iterations};
  });
  set_thread_count(0);
}

void textbook_linear(benchmark::State& state, const ProblemSettings& settings) {
  TextbookSolver solver(Reference::of(settings).problem.textbook());
  set_thread_count(1);
  measure(state, settings, [&](const Problem& problem) {
    std::vector<Vec3> x = problem.state.positions, v = problem.state.velocities;
    const TextbookReport report = solver.linearly_implicit_euler(1e-6, x, v);
    return Outcome{std::move(x), report.newton_iterations, report.linear_iterations};
  });
}

void triad(benchmark::State& state, int threads) {
  set_thread_count(threads);
  for (auto _ : state) {
    const double rate = stream_triad();
    state.SetIterationTime(24.0 / rate);
    state.counters["bytes_per_second"] = rate;
  }
  set_thread_count(0);
}

void add_cases() {
  for (const int threads : {1, 2}) {
    benchmark::RegisterBenchmark(("triad/threads:" + std::to_string(threads)).c_str(),
                                 [=](benchmark::State& s) { triad(s, threads); })
        ->UseManualTime()
        ->Iterations(1);
  }
  for (const ProblemSettings& settings : cases) {
    const std::size_t vertices =
        static_cast<std::size_t>(settings.extent.x() + 1) *
        static_cast<std::size_t>((settings.extent.y() + 1) * (settings.extent.z() + 1));
    const int repeats = vertices < 1000 ? 200 : vertices < 30000 ? 8 : vertices < 300000 ? 3 : 2;
    const bool large_steps = settings.dt > 0.01;
    const auto add = [&](const std::string& name, int iterations, auto run) {
      benchmark::RegisterBenchmark((settings.name + "/" + name).c_str(), run)
          ->UseManualTime()
          ->Iterations(iterations)
          ->Unit(benchmark::kMillisecond);
    };
    for (const double tolerance : {30.0, 1.0, 0.1, 1e-2, 1e-3, 1e-4}) {
      for (const int threads : {1, 2}) {
        add("muslin/threads:" + std::to_string(threads) + "/tolerance:" + std::to_string(tolerance), repeats,
            [=](benchmark::State& s) { muslin_step(s, settings, tolerance, threads); });
      }
      // The textbook method needs seconds here, and at large steps minutes.
      if (vertices < 500000 && !large_steps && tolerance >= 1e-3) {
        add("textbook/threads:1/tolerance:" + std::to_string(tolerance), vertices < 1000 ? 50 : 1,
            [=](benchmark::State& s) { textbook_step(s, settings, tolerance); });
      }
    }
    if (settings.name == "flag_10x6" || settings.name == "flag_100x60" || settings.name == "flag_400x240") {
      for (const int threads : {1, 2}) {
        add("muslin_linear/threads:" + std::to_string(threads), repeats,
            [=](benchmark::State& s) { muslin_linear(s, settings, threads); });
      }
      add("textbook_linear/threads:1", repeats, [=](benchmark::State& s) { textbook_linear(s, settings); });
    }
  }
}

}  // namespace
}  // namespace muslin::bench

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  muslin::bench::add_cases();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
