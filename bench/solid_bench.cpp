// Solids of tetrahedra against springs of the same Young's modulus: a cube of n³ voxels and 1 m, held at one
// face, sags under its weight in steps of 1/96 s. Springs and solid advance alternately, frame by frame, so
// that the ratio of their times is from one run; both solve every step to the tolerance of `effort =
// "normal"`. The first frame, which allocates memory, is not timed.
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "clock.hpp"
#include "support/lattice_box.hpp"
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <unistd.h>

#include "muslin/energy/neo_hookean_energy.hpp"
#include "muslin/energy/spring_energy.hpp"
#include "muslin/hosts.hpp"
#include "muslin/lattice/lattice_moduli.hpp"
#include "muslin/solver/eisenstat_pcg.hpp"

namespace muslin {
namespace {

constexpr int frames = 4, steps_per_frame = 4;

struct Settings {
  int voxels;   ///< along an edge of the cube
  bool damped;  ///< β = 1 ms
  int threads;
  std::string more;  ///< lines of the scene
};

/// The path of a cube of 1 m at the origin.
std::string cube() {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("muslin_solid_bench_" + std::to_string(getpid()) + ".obj");
  std::ofstream out(path);
  for (int c = 0; c < 8; ++c) out << "v " << (c & 1) << " " << (c >> 1 & 1) << " " << (c >> 2 & 1) << "\n";
  out << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  return path.string();
}

std::unique_ptr<Simulation> make(const Settings& settings, bool solid) {
  const std::string mesh = cube();
  const std::string text = fmt::format(
      "[time]\nframe_rate = 24\nsteps_per_frame = {}\n"
      "[[body]]\nname = 'cube'\nmesh = '{}'\ncontact = false\nvoxel_width = {}\n"
      "material = {{ density = 1000, youngs_modulus = 1e5{}{} }}\n"
      "[[pin]]\nbody = 'cube'\nwhere = {{ plane = {{ point = [0, 0, 0], normal = [1, 0, 0], distance = 1e-3 "
      "}} "
      "}}\n"
      "[[force]]\ntype = 'gravity'\n{}",
      steps_per_frame, mesh, 1.0 / settings.voxels, solid ? ", law = 'neo_hookean', poisson = 0.25" : "",
      settings.damped ? ", stiffness_damping = 1e-3" : "", settings.more);
  auto made = std::make_unique<Simulation>(
      std::make_shared<const Model>(build_model(parse_scene(text, "solid_bench.toml"))));
  std::filesystem::remove(mesh);
  return made;
}

struct Totals {
  double seconds = 0, linearize = 0, solve = 0, newton = 0, linear = 0, steps = 0, missed = 0;
};

void run(benchmark::State& state, const Settings& settings) {
  set_thread_count(settings.threads);
  std::array<Totals, 2> totals;
  for (auto _ : state) {
    const std::array bodies = {make(settings, false), make(settings, true)};
    std::array<RunCosts, 2> before;
    for (std::size_t b = 0; b < 2; ++b) {
      bodies[b]->advance();
      before[b] = bodies[b]->costs();
    }
    for (int f = 0; f < frames; ++f) {
      for (std::size_t b = 0; b < 2; ++b) {
        const bench::Clock clock;
        bodies[b]->advance();
        Totals& total = totals[b];
        total.seconds += clock.seconds();
        const Diagnostics& row = bodies[b]->diagnostics();
        total.newton += row.newton_iterations, total.linear += row.linear_iterations;
        total.steps += row.steps, total.missed += row.steps - row.converged_steps;
      }
    }
    for (std::size_t b = 0; b < 2; ++b) {
      totals[b].linearize = bodies[b]->costs().linearize - before[b].linearize;
      totals[b].solve = bodies[b]->costs().solve - before[b].solve;
    }
    state.SetIterationTime(totals[1].seconds);
    state.counters["vertices"] = static_cast<double>(bodies[1]->state().positions.size());
  }
  for (std::size_t b = 0; b < 2; ++b) {
    const std::string name = b == 0 ? "springs_" : "solid_";
    const Totals& total = totals[b];
    state.counters[name + "ms"] = 1e3 * total.seconds / total.steps;
    state.counters[name + "assembly_ms"] = 1e3 * total.linearize / total.steps;
    state.counters[name + "solve_ms"] = 1e3 * total.solve / total.steps;
    state.counters[name + "newton"] = total.newton / total.steps;
    state.counters[name + "linear"] = total.linear / total.steps;
    state.counters[name + "missed"] = total.missed;
  }
  state.counters["ratio"] = totals[1].seconds / totals[0].seconds;
  set_thread_count(0);
}

/// Measures the distance of each, after `frames`, from a run whose steps are solved to 1e-5, as a share of
/// the distance moved.
void accuracy(benchmark::State& state, Settings settings) {
  set_thread_count(1);
  for (auto _ : state) {
    for (const bool solid : {false, true}) {
      Settings tight = settings;
      tight.more += "[solver]\neffort = 'exact'\ntolerance = 1e-5\n";
      const std::array bodies = {make(settings, solid), make(tight, solid)};
      const std::vector<Vec3> start = bodies[0]->state().positions;
      for (const auto& body : bodies)
        for (int f = 0; f < frames; ++f) body->advance();
      double off = 0, moved = 0;
      for (std::size_t v = 0; v < start.size(); ++v) {
        const Vec3& end = bodies[1]->state().positions[v];
        off += (bodies[0]->state().positions[v] - end).squaredNorm();
        moved += (end - start[v]).squaredNorm();
      }
      state.counters[solid ? "solid_error" : "springs_error"] = std::sqrt(off / moved);
    }
  }
  set_thread_count(0);
}

/// Measures nanoseconds per vertex and call of the parts of a step, on one thread, for a bent cube.
void parts(benchmark::State& state, int voxels) {
  set_thread_count(1);
  const Lattice lattice = test::box_lattice({voxels, voxels, voxels}, 1.0 / voxels);
  std::vector<Vec3> x = test::rest_positions(lattice), g(x.size(), Vec3::Zero());
  for (Vec3& p : x) p.y() -= 0.1 * p.x() * p.x();
  const std::vector<double> masses(x.size(), 1000 * std::pow(lattice.width, 3));
  std::vector<std::uint8_t> fixed(x.size(), 0);
  for (std::size_t v = 0; v < fixed.size(); ++v) fixed[v] = lattice.vertices[v].x() == 0 ? 1 : 0;
  constexpr double dt = 1.0 / 96;
  const SpringModuli moduli = springs_for(1e5, {}, Bracing::kuhn);
  const SpringEnergy springs(build_springs(lattice, Bracing::kuhn), lattice.width,
                             {moduli.edge, moduli.face_diagonal, moduli.body_diagonal});
  const NeoHookeanEnergy solid(lattice, {1e5, 0.25}, tetrahedron_pattern(lattice));
  for (auto _ : state) {
    const bench::Clock whole;
    const auto note = [&](const std::string& name, const auto& body) {
      state.counters[name] = 1e9 * bench::Least::of(body).seconds / static_cast<double>(x.size());
    };
    for (const bool of_solid : {false, true}) {
      const Potential& energy = of_solid ? static_cast<const Potential&>(solid) : springs;
      const std::string name = of_solid ? "solid_" : "springs_";
      note(name + "value", [&] { benchmark::DoNotOptimize(energy.value(x)); });
      note(name + "gradient", [&] { energy.add_gradient_and_value(x, g); });
      note(name + "product", [&] { energy.add_hessian_product(x, x, g); });
      Linearization h;
      note(name + "linearize", [&] {
        h.reset(masses, fixed, dt * dt);
        energy.linearize(x, h, 0);
        h.finish();
      });
      EisenstatPcg system;
      note(name + "factor", [&] { system.factor(h); });
      system.start(x, 1);
      note(name + "iteration", [&] {
        system.direction(0, 1e-3);
        system.residual(1e-3);
      });
    }
    state.SetIterationTime(whole.wall());
  }
  set_thread_count(0);
}

}  // namespace
}  // namespace muslin

int main(int argc, char** argv) {
  using namespace muslin;
  for (const int voxels : {27, 46}) {
    for (const bool damped : {false, true}) {
      const std::string name = "cube_" + std::to_string(voxels) + (damped ? "/damped" : "/undamped");
      for (const int threads : {1, 2}) {
        benchmark::RegisterBenchmark((name + "/threads:" + std::to_string(threads)).c_str(),
                                     [=](benchmark::State& s) { run(s, {voxels, damped, threads, ""}); })
            ->Iterations(1)
            ->UseManualTime()
            ->Unit(benchmark::kMillisecond);
      }
      if (voxels == 27) {
        benchmark::RegisterBenchmark((name + "/accuracy").c_str(),
                                     [=](benchmark::State& s) { accuracy(s, {voxels, damped, 1, ""}); })
            ->Iterations(1)
            ->Unit(benchmark::kMillisecond);
      }
    }
  }
  for (const int voxels : {27, 46}) {
    benchmark::RegisterBenchmark(("cube_" + std::to_string(voxels) + "/parts").c_str(),
                                 [=](benchmark::State& s) { parts(s, voxels); })
        ->Iterations(1)
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
