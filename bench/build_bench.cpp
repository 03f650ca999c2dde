// From a mesh to a lattice that is ready to step: a ball of about 131 000 triangles and one million voxels,
// on one thread. Time and peak memory after each stage, and what the surfaces that only the output needs, the
// skin and the contour, take on top.
#include <cmath>
#include <functional>
#include <optional>
#include <string>

#include "clock.hpp"
#include "geometry/shapes.hpp"
#include "memory.hpp"
#include "support/simple_potentials.hpp"
#include <benchmark/benchmark.h>

#include "muslin/core/parallel.hpp"
#include "muslin/energy/spring_energy.hpp"
#include "muslin/geometry/inspect.hpp"
#include "muslin/io/mesh_file.hpp"
#include "muslin/io/mesh_writers.hpp"
#include "muslin/lattice/embedding.hpp"
#include "muslin/solver/solver.hpp"
#include "muslin/surface/contour.hpp"

namespace muslin::bench {
namespace {

void build(benchmark::State& state, double width) {
  set_thread_count(1);
  for (auto _ : state) {
    double total = 0;
    int number = 0;
    const auto stage = [&](const std::string& name, const std::function<void()>& body) {
      const Clock clock;
      body();
      const double seconds = clock.seconds();
      total += seconds;
      const std::string key = std::to_string(number++) + " " + name;
      state.counters[key + "_s"] = seconds;
      state.counters[key + "_GB"] = 1e-9 * peak_memory();
    };
    Mesh mesh = shapes::sphere(1, 7);
    const std::string file = to_obj(mesh, mesh.positions);
    std::optional<SignedDistance> distance;
    Lattice lattice;
    Springs springs;
    std::shared_ptr<const SpringEnergy> energy;
    std::vector<double> masses;
    State start;
    stage("mesh file", [&] { mesh = read_mesh_from(file, ".obj", "ball.obj").mesh; });
    stage("check of the mesh", [&] {
      require_usable(mesh, "ball");
      inspect(mesh);
    });
    stage("distance field", [&] { distance.emplace(mesh); });
    stage("voxels", [&] { lattice = build_lattice(mesh, *distance, {.width = width}); });
    stage("springs", [&] { springs = build_springs(lattice, Bracing::kuhn); });
    stage("energy and couplings", [&] {
      energy = std::make_shared<SpringEnergy>(springs, width, std::array<double, 3>{20000, 100, 100},
                                              springs.share);
    });
    stage("masses and state", [&] {
      masses.assign(lattice.vertex_count(), 0);
      const double corner = 10 * std::pow(width, 3) / 8;
      for (std::size_t c = 0; c < lattice.voxel_count(); ++c)
        for (const int v : lattice.voxel_vertices[c])
          masses[static_cast<std::size_t>(v)] += corner * lattice.fill[c];
      start.positions.resize(masses.size());
      for (std::size_t v = 0; v < masses.size(); ++v) start.positions[v] = lattice.rest_position(v);
      start.velocities.assign(masses.size(), Vec3::Zero());
    });
    state.counters["ready_s"] = total;
    state.counters["ready_GB"] = 1e-9 * peak_memory();
    stage("skin", [&] { embed(lattice, mesh.positions); });
    stage("contour", [&] { build_contour(lattice, mesh, *distance, ContourMethod::cubes); });
    stage("first step", [&] {
      const test::UniformGravity gravity(masses, Vec3(0, -9.8, 0));
      const std::vector<std::uint8_t> fixed(masses.size(), 0);
      const StepContext context = step_context(Integrator::implicit_euler, start, 1.0 / 240);
      const StepReport report =
          solve_step({}, context, {masses, {energy.get(), &gravity}, fixed, start.positions}, start);
      if (!report.converged) state.SkipWithError(report.failure.c_str());
    });
    state.SetIterationTime(total);
    state.counters["triangles"] = static_cast<double>(mesh.face_count());
    state.counters["voxels"] = static_cast<double>(lattice.voxel_count());
  }
  set_thread_count(0);
}

}  // namespace
}  // namespace muslin::bench

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  benchmark::RegisterBenchmark("build/ball", [](benchmark::State& s) { muslin::bench::build(s, 1.0 / 62); })
      ->UseManualTime()
      ->Iterations(1)
      ->Unit(benchmark::kSecond);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
