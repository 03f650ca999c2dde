// Time stepping: known trajectories, decay, orders, balances.
#include <array>
#include <cmath>

#include "verify_case.hpp"
#include "verify_experiment.hpp"
#include <fmt/format.h>

namespace muslin::app {
namespace {

constexpr std::array<const char*, 4> integrators{"implicit_euler", "bdf2", "linearly_implicit_euler",
                                                 "symplectic_euler"};

std::vector<Comparison> vega() {
  const Experiment experiment;
  experiment.upright_sheet("flag.obj", 10, 6);
  Simulation simulation = experiment.start(R"(
[time]
duration = 2
frame_rate = 24
steps_per_frame = 10
[solver]
integrator = "linearly_implicit_euler"
linear_tolerance = 1e-10
[[body]]
name = "flag"
mesh = "flag.obj"
thickness = 1.0
voxel_width = 1.0
mass = "cells"
material = "thesis_flag"
[[pin]]
where = { line = { from = [0, 6, -1], to = [0, 6, 1] } }
[[pin]]
where = { line = { from = [10, 6, -1], to = [10, 6, 1] } }
[[force]]
type = "gravity"
)");
  struct Row {
    int i, j;
    Vec3 after_1s, after_2s;
  };
  const std::array<Row, 4> table{{
      {0, 0, {.857912, .261207, -.683342}, {-.448517, .053167, -.006557}},
      {5, 0, {4.790433, -2.549471, .026327}, {4.233198, -1.277245, .032178}},
      {10, 0, {8.430875, .518936, -.032401}, {8.958825, .097822, .318744}},
      {5, 3, {4.991938, .483287, .092711}, {4.687770, 1.630930, .216927}},
  }};
  std::vector<Comparison> numbers;
  for (const int second : {1, 2}) {
    advance(simulation, 24);
    for (const Row& row : table) {
      // The table counts z from the back of the flag, the scene from its middle.
      const Vec3 x = position(simulation, row.i, row.j, 0) + Vec3(0, 0, 0.5);
      const Vec3& reference = second == 1 ? row.after_1s : row.after_2s;
      numbers.push_back({fmt::format("vertex ({}, {}) off at {} s [m]", row.i, row.j, second), 0,
                         (x - reference).norm(), second == 1 ? 1e-5 : 1e-4, false});
    }
  }
  return numbers;
}

std::vector<Comparison> free_fall() {
  const Experiment experiment;
  experiment.box("box.obj", {1, 1, 1});
  Simulation simulation = experiment.start(R"(
[time]
frame_rate = 100
steps_per_frame = 1
[solver]
tolerance = 1e-9
[[body]]
mesh = "box.obj"
voxel_width = 0.5
material = { density = 1000, edge_modulus = 1e5, face_diagonal_modulus = 1e4, stiffness_damping = 1e-3 }
[[force]]
type = "gravity"
)");
  const double dt = 0.01;
  const int steps = 100;
  advance(simulation, steps);
  const double drop = simulation.model().rest_positions[0].y() - simulation.state().positions[0].y();
  return {{"drop after 100 steps [m]", 9.8 * dt * dt * steps * (steps + 1) / 2, drop, 1e-9}};
}

std::vector<Comparison> oscillator() {
  // One voxel with springs along its edges only: four equal oscillators between the held and the free face.
  const Experiment experiment;
  experiment.box("box.obj", {1, 1, 1});
  Simulation simulation = experiment.start(R"(
[time]
frame_rate = 50
steps_per_frame = 1
[solver]
tolerance = 1e-9
[[body]]
mesh = "box.obj"
voxel_width = 1
velocity = [1e-3, 0, 0]
[body.material]
density = 8
edge_modulus = 400
[[pin]]
where = { plane = { point = [0, 0, 0], normal = [1, 0, 0] } }
)");
  const double omega = 20, dt = 0.02;  // a corner of 1 kg on a spring of 400 N/m
  const auto amplitude = [&] {
    const std::size_t v = vertex(simulation, 1, 0, 0);
    return std::hypot(omega * (simulation.state().positions[v].x() - 1),
                      simulation.state().velocities[v].x());
  };
  double before = 1e-3, least = 1, greatest = 0;
  for (int step = 0; step < 20; ++step) {
    advance(simulation, 1);
    const double after = amplitude();
    least = std::min(least, after / before);
    greatest = std::max(greatest, after / before);
    before = after;
  }
  const double factor = 1 / std::sqrt(1 + omega * omega * dt * dt);
  return {{"least factor of a step", factor, least, 1e-8},
          {"greatest factor of a step", factor, greatest, 1e-8}};
}

std::vector<Comparison> orders() {
  const Experiment experiment;
  experiment.upright_sheet("flag.obj", 5, 3);
  const std::string scene = R"(
[time]
frame_rate = 10
[solver]
tolerance = 1e-8
linear_tolerance = 1e-9
[[body]]
name = "flag"
mesh = "flag.obj"
thickness = 1.0
voxel_width = 1.0
mass = "cells"
material = { density = 10, edge_modulus = 400, face_diagonal_modulus = 100, body_diagonal_modulus = 100 }
[[pin]]
where = { plane = { point = [0, 0, 0], normal = [1, 0, 0] } }
[[force]]
type = "gravity"
)";
  const std::array<double, 4> expected{1, 2, 1, 1};
  std::vector<Comparison> numbers;
  for (std::size_t i = 0; i < integrators.size(); ++i) {
    std::vector<std::vector<Vec3>> ends;
    for (const int steps : {32, 64, 128}) {
      Simulation simulation = experiment.start(scene, {fmt::format("solver.integrator={}", integrators[i]),
                                                       fmt::format("time.steps_per_frame={}", steps)});
      advance(simulation, 5);
      ends.push_back(simulation.state().positions);
    }
    const double order = std::log2(largest_distance(ends[0], ends[1]) / largest_distance(ends[1], ends[2]));
    numbers.push_back({fmt::format("order of {}", integrators[i]), expected[i], order, 0.1, false});
  }
  return numbers;
}

/// A strip of cloth, clamped at one end, swings down from the horizontal.
std::vector<Comparison> orders_of_shells() {
  const Experiment experiment;
  experiment.level_sheet("strip.obj", 1, 0.25, 12, 3);
  const std::string scene = R"(
[time]
frame_rate = 10
[solver]
tolerance = 1e-8
[[body]]
mesh = "strip.obj"
model = "shell"
compression = "elastic"
material = { areal_density = 0.2, membrane_warp = 20, bending_warp = 1e-3 }
[[pin]]
where = { box = [[-1, -1, -1], [0.09, 1, 1]] }
[[force]]
type = "gravity"
acceleration = [0, -2, 0]
)";
  std::vector<Comparison> numbers;
  for (const auto& [integrator, expected] : {std::pair{"implicit_euler", 1.0}, {"bdf2", 2.0}}) {
    std::vector<std::vector<Vec3>> ends;
    for (const int steps : {64, 128, 256}) {
      Simulation simulation = experiment.start(scene, {fmt::format("solver.integrator={}", integrator),
                                                       fmt::format("time.steps_per_frame={}", steps)});
      advance(simulation, 5);
      ends.push_back(simulation.state().positions);
    }
    const double order = std::log2(largest_distance(ends[0], ends[1]) / largest_distance(ends[1], ends[2]));
    numbers.push_back({fmt::format("order of {}", integrator), expected, order, 0.05, false});
  }
  return numbers;
}

std::vector<Comparison> energy() {
  const Experiment experiment;
  experiment.upright_sheet("flag.obj", 5, 3);
  const std::string scene = R"(
[time]
frame_rate = 24
steps_per_frame = 20
[solver]
tolerance = 1e-6
linear_tolerance = 1e-10
[[body]]
mesh = "flag.obj"
thickness = 1.0
voxel_width = 1.0
mass = "cells"
material = { density = 10, edge_modulus = 2000, face_diagonal_modulus = 100, body_diagonal_modulus = 100, stiffness_damping = 1e-3, mass_damping = 0.1 }
[[pin]]
where = { line = { from = [0, 3, -1], to = [0, 3, 1] } }
keyframes = [{ time = 0, translate = [0, 0, 0] }, { time = 1, translate = [1, 0, 0] }]
[[force]]
type = "gravity"
[[force]]
type = "point"
where = { plane = { point = [5, 0, 0], normal = [1, 0, 0] } }
force = [0, 0, 20]
)";
  std::vector<Comparison> numbers;
  for (const char* integrator : integrators) {
    Simulation simulation = experiment.start(scene, {fmt::format("solver.integrator={}", integrator)});
    const double start = simulation.diagnostics().balance();
    double drift = 0, moved = 0;
    for (int frame = 0; frame < 24; ++frame) {
      advance(simulation, 1);
      drift = std::max(drift, std::abs(simulation.diagnostics().balance() - start));
      moved = std::max(moved, simulation.diagnostics().kinetic + simulation.diagnostics().elastic);
    }
    numbers.push_back({fmt::format("balance off, {}", integrator), 0, drift / moved, 1e-7, false});
  }
  return numbers;
}

std::vector<Comparison> momentum() {
  const Experiment experiment;
  experiment.box("box.obj", {1, 1, 1});
  const std::string scene = R"(
[time]
frame_rate = 24
steps_per_frame = 20
[solver]
tolerance = 1e-8
linear_tolerance = 1e-10
[[body]]
mesh = "box.obj"
voxel_width = 0.5
velocity = [1, 2, 3]
material = { density = 1000, edge_modulus = 1e5, face_diagonal_modulus = 1e4, body_diagonal_modulus = 1e4, volume_modulus = 1e4, stiffness_damping = 1e-3 }
[[pin]]
where = { nearest = [0, 0, 0] }
until = 0.1
)";
  std::vector<Comparison> numbers;
  for (const char* integrator : integrators) {
    Simulation simulation = experiment.start(scene, {fmt::format("solver.integrator={}", integrator)});
    advance(simulation, 4);  // a held corner has set the body spinning and shaking; now nothing acts on it
    const Vec3 start = simulation.diagnostics().momentum;
    advance(simulation, 20);
    numbers.push_back({fmt::format("momentum lost, {}", integrator), 0,
                       (simulation.diagnostics().momentum - start).norm() / start.norm(), 1e-9, false});
  }
  return numbers;
}

}  // namespace

std::vector<VerifyCase> stepping_cases() {
  return {
      {"vega", "the flag held at its top corners moves as in the thesis's engine", "Vega FEM 4.0, measured",
       false, vega},
      {"free-fall", "implicit Euler falls by g dt^2 n(n+1)/2", "closed form", false, free_fall},
      {"oscillator", "implicit Euler damps an oscillator by 1/sqrt(1+w^2 dt^2) a step", "closed form", false,
       oscillator},
      {"orders", "halving the step divides the error by 2^order", "theory of the methods", false, orders},
      {"orders-shell", "halving the step divides the error by 2^order on a strip of cloth that swings",
       "theory of the methods", false, orders_of_shells},
      {"energy", "what is stored, done and lost adds up, as a share of the energy moved", "conservation",
       false, energy},
      {"momentum", "without forces from outside momentum stays", "conservation", false, momentum},
  };
}

}  // namespace muslin::app
