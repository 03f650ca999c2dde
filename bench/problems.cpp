#include "problems.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>
#include <stdexcept>

#include "muslin/force/gravity.hpp"

namespace muslin::bench {
namespace {

constexpr std::array<double, 3> moduli = {20000, 100, 100};  // [N/m²]
constexpr double density = 10;                               // [kg/m³]

/// To be raised whenever a state would come out differently but for rounding.
constexpr int state_version = 1;

Problem body(const ProblemSettings& settings) {
  Problem problem;
  problem.name = settings.name;
  problem.dt = settings.dt;
  problem.lattice = test::box_lattice(settings.extent, settings.width);
  problem.lattice_springs = build_springs(problem.lattice, Bracing::kuhn);
  problem.springs = std::make_shared<SpringEnergy>(problem.lattice_springs, settings.width, moduli);
  const std::size_t count = problem.lattice.vertex_count();
  problem.masses.assign(count, 0);
  const double corner = density * std::pow(settings.width, 3) / 8;
  for (const auto& corners : problem.lattice.voxel_vertices)
    for (const int v : corners) problem.masses[static_cast<std::size_t>(v)] += corner;
  StepContext always;
  always.time_end = 1;
  problem.gravity = Gravity(problem.masses, {{{0, Vec3(0, -9.8, 0)}}}, {0, INFINITY}).potential(always);
  problem.rest_positions = test::rest_positions(problem.lattice);
  problem.fixed.assign(count, 0);
  const Vec3i& e = problem.lattice.extent;
  for (std::size_t v = 0; v < count; ++v) {
    const Vec3i& at = problem.lattice.vertices[v];
    problem.fixed[v] = at.y() == e.y() && (at.x() == 0 || at.x() == e.x()) ? 1 : 0;
  }
  return problem;
}

State starting_state(const ProblemSettings& settings, const Problem& problem) {
  State state;
  state.positions = test::rest_positions(problem.lattice);
  state.velocities.assign(state.positions.size(), Vec3::Zero());
  if (settings.start == Start::rest) return state;
  // A sheet that is pressed exactly in its plane has no side to buckle to.
  std::mt19937 random(7);
  const Vec3 size = settings.width * settings.extent.cast<double>();
  const Vec3 middle(size.x() / 2, size.y(), size.z() / 2);
  for (std::size_t v = 0; v < state.positions.size(); ++v) {
    if (problem.fixed[v]) continue;
    state.velocities[v] = 10 * (middle - state.positions[v]);
    state.positions[v].z() += 0.02 * settings.width * (static_cast<double>(random()) / 2147483648.0 - 1);
  }
  return state;
}

/// Values at the vertices of `coarse`, trilinearly at those of `fine`. A sheet of one voxel gets thinner with
/// the voxels: its two layers keep the middle surface.
std::vector<Vec3> interpolated(const Lattice& coarse, const std::vector<Vec3>& values, const Lattice& fine) {
  const Vec3i size = coarse.extent + Vec3i::Ones();
  const bool thinner = coarse.extent.z() == 1 && fine.extent.z() == 1;
  std::vector<Vec3> result;
  for (const Vec3i& vertex : fine.vertices) {
    Vec3 at = vertex.cast<double>()
                  .cwiseProduct(coarse.extent.cast<double>())
                  .cwiseQuotient(fine.extent.cast<double>());
    if (thinner) at.z() = 0.5 + (at.z() - 0.5) * fine.width / coarse.width;
    Vec3 sum = Vec3::Zero();
    const Vec3i cell = at.cast<int>().cwiseMin(coarse.extent - Vec3i::Ones());
    const Vec3 t = at - cell.cast<double>();
    for (int c = 0; c < 8; ++c) {
      const Vec3i corner = cell + Vec3i(c & 1, c >> 1 & 1, c >> 2 & 1);
      const double weight =
          (c & 1 ? t.x() : 1 - t.x()) * (c & 2 ? t.y() : 1 - t.y()) * (c & 4 ? t.z() : 1 - t.z());
      const int index = (corner.y() * size.z() + corner.z()) * size.x() + corner.x();
      sum += weight * values[static_cast<std::size_t>(index)];
    }
    result.push_back(sum);
  }
  return result;
}

std::filesystem::path kept_at(const ProblemSettings& settings) {
  return std::filesystem::path(MUSLIN_BENCH_STATES) /
         (settings.name + "-v" + std::to_string(state_version) + ".bin");
}

bool load(const std::filesystem::path& path, std::size_t count, double dt, State& state) {
  std::ifstream file(path, std::ios::binary);
  const std::size_t bytes = count * sizeof(Vec3);
  for (auto* vectors :
       {&state.positions, &state.velocities, &state.previous_positions, &state.previous_velocities}) {
    vectors->resize(count);
    file.read(reinterpret_cast<char*>(vectors->data()), static_cast<std::streamsize>(bytes));
  }
  state.previous_dt = dt;
  return file.good() && file.peek() == std::ifstream::traits_type::eof();
}

void save(const std::filesystem::path& path, const State& state) {
  std::filesystem::create_directories(path.parent_path());
  const std::filesystem::path part = path.string() + ".part";
  {
    std::ofstream file(part, std::ios::binary);
    for (const auto* vectors :
         {&state.positions, &state.velocities, &state.previous_positions, &state.previous_velocities})
      file.write(reinterpret_cast<const char*>(vectors->data()),
                 static_cast<std::streamsize>(vectors->size() * sizeof(Vec3)));
    if (!file) throw std::runtime_error("cannot write " + part.string());
  }
  std::filesystem::rename(part, path);
}

}  // namespace

const std::vector<ProblemSettings>& cases() {
  constexpr double brief = 1.0 / 240, lengthy = 1.0 / 24;
  static const std::vector<ProblemSettings> all = {
      {"flag_10x6", {10, 6, 1}, 1, brief, Start::rest, 120},
      {"flag_100x60", {100, 60, 1}, 0.1, brief, Start::rest, 120},
      {"crumpled_100x60", {100, 60, 1}, 0.1, brief, Start::flung, 40},
      {"flag_200x120", {200, 120, 1}, 0.05, brief, Start::rest, 120},
      {"flag_400x240", {400, 240, 1}, 0.025, brief, Start::rest, 10, "flag_200x120"},
      {"crumpled_400x240", {400, 240, 1}, 0.025, brief, Start::rest, 10, "crumpled_100x60"},
      {"flag_1000x600", {1000, 600, 1}, 0.01, brief, Start::rest, 2, "flag_400x240", true},
      {"falling_200x120", {200, 120, 1}, 0.05, brief, Start::rest, 8},
      {"falling_1000x600", {1000, 600, 1}, 0.01, brief, Start::rest, 8},
      {"cube_20", {20, 20, 20}, 0.2, brief, Start::rest, 24},
      {"cube_40", {40, 40, 40}, 0.1, brief, Start::rest, 24},
      {"crumpled_cube_40", {40, 40, 40}, 0.1, brief, Start::flung, 40},
      {"cube_80", {80, 80, 80}, 0.05, brief, Start::rest, 4, "cube_40"},
      {"long_100x60", {100, 60, 1}, 0.1, lengthy, Start::rest, 2, "flag_100x60"},
      {"long_crumpled_100x60", {100, 60, 1}, 0.1, lengthy, Start::rest, 1, "crumpled_100x60"},
      {"long_400x240", {400, 240, 1}, 0.025, lengthy, Start::rest, 2, "flag_400x240"},
      {"long_crumpled_400x240", {400, 240, 1}, 0.025, lengthy, Start::rest, 1, "crumpled_400x240"},
  };
  return all;
}

const ProblemSettings& case_named(const std::string& name) {
  const auto& all = cases();
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& c) { return c.name == name; });
  if (found == all.end()) throw std::invalid_argument("no case " + name);
  return *found;
}

TextbookProblem Problem::textbook() const {
  TextbookProblem problem;
  problem.masses = masses;
  problem.fixed = fixed;
  problem.gravity = Vec3(0, -9.8, 0);
  problem.dt = dt;
  for (const SpringRun& run : lattice_springs.runs) {
    for (int i = 0; i < run.length; ++i) {
      problem.springs.push_back({run.a + i, run.b + i, springs->stiffness(run.direction, run.first + i),
                                 springs->rest_length(run.direction)});
    }
  }
  return problem;
}

double Problem::stiffness_number() const {
  return moduli[0] * lattice.width * dt * dt / *std::max_element(masses.begin(), masses.end());
}

double Problem::compressed_share() const {
  std::int64_t edges = 0, shorter = 0;
  for (const SpringRun& run : lattice_springs.runs) {
    if (lattice_springs.directions[static_cast<std::size_t>(run.direction)].kind != SpringKind::edge)
      continue;
    for (int i = 0; i < run.length; ++i) {
      const Vec3 d = state.positions[static_cast<std::size_t>(run.b + i)] -
                     state.positions[static_cast<std::size_t>(run.a + i)];
      ++edges;
      if (d.norm() < lattice.width) ++shorter;
    }
  }
  return static_cast<double>(shorter) / static_cast<double>(edges);
}

Problem make_problem(const ProblemSettings& settings) {
  Problem problem = body(settings);
  const std::filesystem::path path = kept_at(settings);
  if (load(path, problem.masses.size(), settings.dt, problem.state)) return problem;
  std::fprintf(stderr, "making the state of %s\n", settings.name.c_str());
  if (settings.from.empty()) {
    problem.state = starting_state(settings, problem);
  } else {
    const Problem source = make_problem(case_named(settings.from));
    problem.state = State{};
    problem.state.positions = interpolated(source.lattice, source.state.positions, problem.lattice);
    problem.state.velocities = interpolated(source.lattice, source.state.velocities, problem.lattice);
  }
  SolverSettings solver;
  Stepper stepper;
  for (int n = 0; n < settings.steps; ++n) {
    const StepContext context = step_context(solver.integrator, problem.state, problem.dt);
    const StepReport report = stepper.step(solver, context, problem.step_problem(), problem.state);
    if (!report.converged) throw std::runtime_error(settings.name + ": " + report.failure);
  }
  save(path, problem.state);
  return problem;
}

}  // namespace muslin::bench
