// Bodies that move as a whole: air drag, pendulum, hanging chain, vibration.
#include <cmath>
#include <numbers>

#include "verify_case.hpp"
#include "verify_experiment.hpp"
#include <fmt/format.h>

namespace muslin::app {
namespace {

std::vector<Comparison> falling_sheet() {
  const Experiment experiment;
  experiment.level_sheet("sheet.obj", 1, 1, 4);
  Simulation simulation = experiment.start(R"(
[time]
frame_rate = 100
steps_per_frame = 10
[[body]]
mesh = "sheet.obj"
thickness = 0.001
voxel_width = 0.25
material = { density = 150, edge_modulus = 1e6, face_diagonal_modulus = 1e5 }
[[force]]
type = "gravity"
[[force]]
type = "wind"
velocity = [0, 0, 0]
air_density = 1.2
drag = 1.17
)");
  const double terminal = std::sqrt(2 * 0.15 * 9.8 / (1.2 * 1.17));  // 0.15 kg/m2
  const auto speed = [&] {
    return -simulation.diagnostics().momentum.y() / simulation.model().bodies.front().statistics.mass;
  };
  std::vector<Comparison> numbers;
  for (const double t : {0.1, 0.2, 0.4}) {
    while (simulation.diagnostics().time < t - 1e-6) advance(simulation, 1);
    numbers.push_back(
        {fmt::format("speed at {} s [m/s]", t), terminal * std::tanh(9.8 * t / terminal), speed(), 1e-3});
  }
  advance(simulation, 110);
  numbers.push_back({"terminal speed [m/s]", terminal, speed(), 1e-5});
  return numbers;
}

/// A quarter of the period of a stiff bar that is let go at `degrees` from where it hangs [s].
double quarter_period(const Experiment& experiment, double degrees, double& small_swing_quarter) {
  const double angle = degrees * std::numbers::pi / 180;
  // The bar is fixed along −y and gravity is rotated, so that every angle has the same voxels.
  Simulation simulation = experiment.start(fmt::format(R"(
[time]
frame_rate = 1000
steps_per_frame = 1
[solver]
integrator = "bdf2"
tolerance = 1e-5
[[body]]
mesh = "bar.obj"
voxel_width = 0.25
bracing = "full"
material = {{ density = 100, youngs_modulus = 1e7 }}
[[pin]]
where = {{ line = {{ from = [0.25, 2, 0], to = [0.25, 2, 0.5], distance = 0.01 }} }}
[[force]]
type = "gravity"
acceleration = [{:.17g}, {:.17g}, 0]
)",
                                                       9.8 * std::sin(angle), -9.8 * std::cos(angle)));
  const Model& model = simulation.model();
  double inertia = 0;
  Vec3 centre = Vec3::Zero();
  const Vec3 axis(0.25, 2, 0);
  for (std::size_t v = 0; v < model.vertex_count(); ++v) {
    Vec3 arm = model.rest_positions[v] - axis;
    arm.z() = 0;
    centre += model.masses[v] * arm;
    inertia += model.masses[v] * arm.squaredNorm();
  }
  small_swing_quarter = std::numbers::pi / 2 * std::sqrt(inertia / (9.8 * centre.norm()));
  const std::size_t tip = vertex(simulation, 1, 0, 0);
  double before = angle, time = 0;
  for (;;) {
    advance(simulation, 1);
    const Vec3 arm = simulation.state().positions[tip] - Vec3(0.25, 2, 0);
    const double left = angle - std::atan2(arm.x(), -arm.y());
    if (left <= 0 || time > 10) return time + 1e-3 * before / (before - left);
    before = left;
    time = simulation.diagnostics().time;
  }
}

std::vector<Comparison> pendulum() {
  const Experiment experiment;
  experiment.box("bar.obj", {0.5, 2, 0.5});
  std::vector<Comparison> numbers;
  for (const auto& [degrees, ratio] : {std::pair{10.0, 1.001907}, {90.0, 1.180341}, {150.0, 1.762204}}) {
    double small = 0;
    const double quarter = quarter_period(experiment, degrees, small);
    numbers.push_back(
        {fmt::format("period from {} degrees over small swings", degrees), ratio, quarter / small, 1e-3});
  }
  return numbers;
}

std::vector<Comparison> catenary() {
  // Four equal chains side by side: springs along the edges only, so that nothing resists bending.
  const Experiment experiment;
  const int links = 40;
  const double length = 2, span = 1.2, width = length / links;
  experiment.box("chain.obj", {length, width, width});
  Simulation simulation =
      experiment.start(fmt::format(R"(
[time]
frame_rate = 10
steps_per_frame = 2
[solver]
tolerance = 1e-6
[[body]]
mesh = "chain.obj"
voxel_width = {}
material = {{ density = 100, edge_modulus = 1e7, mass_damping = 2 }}
[[pin]]
where = {{ plane = {{ point = [0, 0, 0], normal = [1, 0, 0], distance = 0.001 }} }}
keyframes = [{{ time = 0 }}, {{ time = 1, translate = [{}, 0, 0] }}]
[[pin]]
where = {{ plane = {{ point = [{}, 0, 0], normal = [1, 0, 0], distance = 0.001 }} }}
keyframes = [{{ time = 0 }}, {{ time = 1, translate = [{}, 0, 0] }}]
[[force]]
type = "gravity"
)",
                                   width, (length - span) / 2, length, -(length - span) / 2));
  advance(simulation, 100);
  // length = 2 a sinh(span / 2a): by bisection, the left side falls with a.
  double low = 0.05, high = 10;
  for (int i = 0; i < 100; ++i) {
    const double a = 0.5 * (low + high);
    (2 * a * std::sinh(span / (2 * a)) > length ? low : high) = a;
  }
  const double a = low, top = a * std::cosh(span / (2 * a));
  const auto middle = [&](int i) {
    return Vec3(0.25 * (position(simulation, i, 0, 0) + position(simulation, i, 1, 0) +
                        position(simulation, i, 0, 1) + position(simulation, i, 1, 1)));
  };
  const double height = middle(0).y();
  double worst = 0;
  for (int i = 0; i <= links; ++i) {
    const Vec3 x = middle(i);
    worst = std::max(worst, std::abs(x.y() - height - (a * std::cosh((x.x() - length / 2) / a) - top)));
  }
  return {{"sag [m]", top - a, height - middle(links / 2).y(), 2e-3},
          {"farthest from y = a cosh(x/a), in lengths", 0, worst / length, 1e-3, false}};
}

}  // namespace

std::vector<VerifyCase> motion_cases() {
  return {
      {"falling-sheet", "a sheet falls broadside as v_t tanh(g t / v_t)", "closed form", false,
       falling_sheet},
      {"pendulum", "a stiff bar swings with the period of a compound pendulum", "elliptic integral K", true,
       pendulum},
      {"catenary", "a chain hangs as y = a cosh(x/a)", "closed form", false, catenary},
  };
}

}  // namespace muslin::app
