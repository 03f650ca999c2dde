// Whole runs of cloth in contact: a drop onto a ball, a sheet that folds up on a floor, one that hangs from
// two corners, fifty sheets that fall on each other. Times are of frames at 60 Hz; nothing but the engine is
// timed.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "clock.hpp"
#include "memory.hpp"
#include "support/contact_scene.hpp"
#include <benchmark/benchmark.h>

#include "muslin/contact/crossings.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/scene/names.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

enum class Case { drop, fold, hang };

SolverSettings with(Effort effort) {
  SolverSettings settings;
  settings.effort = effort;
  return settings;
}

/// n × n vertices, 1 m × 1 m, shifted along x by `shift` [m].
std::shared_ptr<const Model> make_model(Case which, int n, const SolverSettings& solver, double shift = 0,
                                        std::optional<int> steps_per_frame = {}) {
  test::ContactScene scene;
  scene.model.scene.time.steps_per_frame = steps_per_frame;
  scene.model.scene.solver = solver;
  test::ClothGrid cloth(n, n, 1.0 / (n - 1));
  for (Vec3& p : cloth.positions) p.x() += shift;
  switch (which) {
    case Case::drop:
      for (Vec3& p : cloth.positions) p += Vec3(-0.5, 0.3, -0.5);
      scene.add_cloth(cloth);
      scene.add_ball(Vec3::Zero(), 0.25);
      break;
    case Case::fold:
      // Upright, a little bent so that it knows where to go.
      for (Vec3& p : cloth.positions)
        p = Vec3(p.x(), p.z() + 0.01, 0.02 * std::sin(3 * p.z()) + 0.005 * std::sin(7 * p.x()));
      scene.friction = 0.4;
      scene.add_cloth(cloth);
      scene.add_plane(Vec3::Zero(), Vec3(0, 1, 0));
      break;
    case Case::hang:
      scene.add_cloth(cloth);
      scene.hold({0, n - 1});
      break;
  }
  return scene.finish();
}

struct Settings {
  Case which;
  int n;
  Effort effort;
  int threads;
};

constexpr int frames = 90;

void run(benchmark::State& state, Settings settings) {
  set_thread_count(settings.threads);
  const auto model = make_model(settings.which, settings.n, with(settings.effort));
  double total = 0, worst = 0, stretch = 0, linear = 0, newton = 0, height = 0, gap = INFINITY, residual = 0;
  double steps = 0, missed = 0, error = 0;
  std::size_t crossings = 0;
  RunCosts costs;
  for (auto _ : state) {
    Simulation simulation(model);
    for (int f = 0; f < frames; ++f) {
      const bench::Clock clock;
      simulation.advance();
      const double ms = 1e3 * clock.seconds();
      total += ms;
      worst = std::max(worst, ms);
      const Diagnostics& row = simulation.diagnostics();
      stretch = std::max(stretch, row.max_stretch);
      newton += row.newton_iterations;
      linear += row.linear_iterations;
      gap = std::min(gap, row.min_distance);
      residual = std::max(residual, row.residual);
      steps += row.steps;
      missed += row.steps - row.converged_steps;
      error = std::max(error, row.error);
      crossings += find_crossings(*model->contact, simulation.state().positions).size();
    }
    costs = simulation.costs();
    state.SetIterationTime(1e-3 * total);
    for (int v = 0; v < settings.n * settings.n; ++v)
      height += simulation.state().positions[static_cast<std::size_t>(v)].y() / (settings.n * settings.n);
  }
  state.counters["ms"] = total / frames;
  state.counters["worst_ms"] = worst;
  state.counters["stretch"] = stretch;
  state.counters["newton"] = newton / frames;
  state.counters["linear"] = linear / frames;
  state.counters["crossings"] = static_cast<double>(crossings);
  state.counters["height"] = height;
  state.counters["min_gap"] = gap;
  state.counters["residual"] = residual;
  state.counters["steps"] = steps / frames;
  state.counters["missed"] = missed;
  state.counters["error"] = error;
  state.counters["search_ms"] = 1e3 * costs.search / frames;
  state.counters["limit_ms"] = 1e3 * costs.limit / frames;
  state.counters["contact_ms"] = 1e3 * costs.contact / frames;
  state.counters["assembly_ms"] = 1e3 * costs.linearize / frames;
  state.counters["solve_ms"] = 1e3 * costs.solve / frames;
  state.counters["searches"] = static_cast<double>(costs.searches) / frames;
  state.counters["shortened"] = static_cast<double>(costs.shortened) / frames;
  set_thread_count(0);
}

/// Counts the least, the median and the most of an even number of values.
void note_spread(benchmark::State& state, const std::string& name, std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  state.counters[name + "_least"] = values.front();
  state.counters[name + "_median"] = (values[half - 1] + values[half]) / 2;
  state.counters[name + "_most"] = values.back();
}

/// Contact goes other ways for other last bits. Eight drops that begin micrometres apart show how much that
/// changes stretch and worst frames.
void spread(benchmark::State& state, int n) {
  set_thread_count(1);
  constexpr int starts = 8;
  std::vector<double> stretch, worst, average;
  std::size_t crossings = 0;
  for (auto _ : state) {
    for (int k = 0; k < starts; ++k) {
      const auto model = make_model(Case::drop, n, with(Effort::normal), 1e-6 * k);
      Simulation simulation(model);
      stretch.push_back(0), worst.push_back(0), average.push_back(0);
      for (int f = 0; f < frames; ++f) {
        const bench::Clock clock;
        simulation.advance();
        const double ms = 1e3 * clock.seconds();
        average.back() += ms / frames;
        worst.back() = std::max(worst.back(), ms);
        stretch.back() = std::max(stretch.back(), simulation.diagnostics().max_stretch);
        crossings += find_crossings(*model->contact, simulation.state().positions).size();
      }
    }
  }
  note_spread(state, "stretch", stretch);
  note_spread(state, "worst", worst);
  note_spread(state, "average", average);
  state.counters["crossings"] = static_cast<double>(crossings);
  set_thread_count(0);
}

/// The sheet meets the ball in the sixth frame; two frames later the first folds show.
constexpr int first_folds = 8, compared = 10;

std::vector<std::vector<Vec3>> trajectory(const std::shared_ptr<const Model>& model) {
  std::vector<std::vector<Vec3>> positions;
  Simulation simulation(model);
  for (int f = 0; f < compared; ++f) {
    simulation.advance();
    positions.push_back(simulation.state().positions);
  }
  return positions;
}

/// Root mean square over all vertices, in the worst of the first frames [mm].
double distance(const std::vector<std::vector<Vec3>>& a, const std::vector<std::vector<Vec3>>& b,
                int frame_count) {
  double largest = 0;
  for (std::size_t f = 0; f < static_cast<std::size_t>(frame_count); ++f) {
    double sum = 0;
    for (std::size_t v = 0; v < a[f].size(); ++v) sum += (a[f][v] - b[f][v]).squaredNorm();
    largest = std::max(largest, 1e3 * std::sqrt(sum / static_cast<double>(a[f].size())));
  }
  return largest;
}

/// Measures the distance of drops to those with every step solved to 1e-5, four steps a frame: until the
/// first folds and until two frames later, when what differs grows by itself; of eight starts micrometres
/// apart.
void accuracy(benchmark::State& state, int n, Effort effort) {
  set_thread_count(1);
  constexpr int steps = 4, starts = 8;
  SolverSettings tight = with(Effort::exact);
  tight.tolerance = 1e-5;
  std::vector<double> before, after;
  double reference_seconds = 0;
  for (auto _ : state) {
    for (int k = 0; k < starts; ++k) {
      const auto a = trajectory(make_model(Case::drop, n, with(effort), 1e-6 * k, steps));
      const bench::Clock clock;
      const auto b = trajectory(make_model(Case::drop, n, tight, 1e-6 * k, steps));
      reference_seconds += clock.seconds() / starts;
      before.push_back(distance(a, b, first_folds));
      after.push_back(distance(a, b, compared));
    }
  }
  note_spread(state, "mm_until_folds", before);
  note_spread(state, "mm_after", after);
  state.counters["reference_s"] = reference_seconds;
  set_thread_count(0);
}

/// Fifty sheets of 1 m, each turned a little more than the one below and 1 cm above it, fall on each other
/// and on a floor: `side`² vertices each.
void layers(benchmark::State& state, int side, int threads) {
  set_thread_count(threads);
  constexpr int sheets = 50, shown = 12;
  test::ContactScene scene;
  scene.model.scene.time.steps_per_frame = {};
  scene.model.scene.solver = with(Effort::normal);
  scene.add_plane(Vec3::Zero(), Vec3(0, 1, 0));
  for (int k = 0; k < sheets; ++k) {
    test::ClothGrid cloth(side, side, 1.0 / (side - 1));
    const double angle = 0.12 * k;
    for (Vec3& p : cloth.positions) {
      const double x = p.x() - 0.5, z = p.z() - 0.5;
      p = Vec3(std::cos(angle) * x - std::sin(angle) * z, 0.01 * (k + 1),
               std::sin(angle) * x + std::cos(angle) * z);
    }
    scene.add_cloth(cloth);
  }
  const auto model = scene.finish();
  double total = 0, steps = 0, missed = 0, newton = 0, linear = 0;
  std::size_t crossings = 0;
  for (auto _ : state) {
    Simulation simulation(model);
    for (int f = 0; f < shown; ++f) {
      const bench::Clock clock;
      simulation.advance();
      total += clock.seconds();
      const Diagnostics& row = simulation.diagnostics();
      steps += row.steps;
      missed += row.steps - row.converged_steps;
      newton += row.newton_iterations;
      linear += row.linear_iterations;
    }
    crossings = find_crossings(*model->contact, simulation.state().positions).size();
    state.SetIterationTime(total);
  }
  state.counters["vertices"] = sheets * side * side;
  state.counters["s_a_step"] = total / steps;
  state.counters["steps"] = steps;
  state.counters["missed"] = missed;
  state.counters["newton"] = newton / steps;
  state.counters["linear"] = linear / steps;
  state.counters["crossings"] = static_cast<double>(crossings);
  state.counters["peak_GB"] = 1e-9 * bench::peak_memory();
  set_thread_count(0);
}

void add(const std::string& name, Settings settings) {
  const std::string& effort = name_of(effort_names(), settings.effort);
  benchmark::RegisterBenchmark((name + "_" + std::to_string(settings.n) + "/" + effort +
                                "/threads:" + std::to_string(settings.threads))
                                   .c_str(),
                               [settings](benchmark::State& state) { run(state, settings); })
      ->Iterations(1)
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond);
}

}  // namespace
}  // namespace muslin

int main(int argc, char** argv) {
  using namespace muslin;
  const std::map<std::string, Case> cases = {
      {"drop", Case::drop}, {"fold", Case::fold}, {"hang", Case::hang}};
  for (const auto& [name, which] : cases) {
    for (const int n : {50, 100, 200}) {
      for (const int threads : {1, 2}) add(name, {which, n, Effort::normal, threads});
    }
  }
  for (const int threads : {1, 2}) add("hang", {Case::hang, 400, Effort::normal, threads});
  for (const int n : {50, 100, 200}) add("drop", {Case::drop, n, Effort::draft, 1});
  for (const int side : {22, 45}) {
    for (const int threads : {1, 2}) {
      benchmark::RegisterBenchmark(
          ("layers_" + std::to_string(side) + "/normal/threads:" + std::to_string(threads)).c_str(),
          [side, threads](benchmark::State& state) { layers(state, side, threads); })
          ->Iterations(1)
          ->UseManualTime()
          ->Unit(benchmark::kMillisecond);
    }
  }
  // The other efforts are measured against this one.
  add("drop", {Case::drop, 50, Effort::exact, 1});
  for (const Effort effort : {Effort::draft, Effort::normal, Effort::exact}) {
    benchmark::RegisterBenchmark(("drop_50/" + name_of(effort_names(), effort) + "/accuracy").c_str(),
                                 [effort](benchmark::State& state) { accuracy(state, 50, effort); })
        ->Iterations(1)
        ->Unit(benchmark::kMillisecond);
  }
  for (const int n : {50, 100}) {
    benchmark::RegisterBenchmark(("drop_" + std::to_string(n) + "/normal/spread").c_str(),
                                 [n](benchmark::State& state) { spread(state, n); })
        ->Iterations(1)
        ->Unit(benchmark::kMillisecond);
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
