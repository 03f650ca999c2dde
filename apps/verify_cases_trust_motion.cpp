// Trust, where the answer is exact: momentum and fall of free bodies; distant bodies have no effect.
#include <algorithm>
#include <cmath>
#include <vector>

#include "verify_case.hpp"
#include "verify_experiment.hpp"
#include "verify_watch.hpp"
#include <fmt/format.h>

namespace muslin::app {
namespace {

/// Largest change of the body's velocity as a whole over `frames`, by its size at the start. `axes` says
/// which components count.
double momentum_lost(Simulation& simulation, const std::string& body, const Vec3& axes, int frames) {
  const Vec3 before = centre(simulation, body, true).cwiseProduct(axes);
  double worst = 0;
  for (int frame = 0; frame < frames; ++frame) {
    simulation.advance();
    worst = std::max(worst, (centre(simulation, body, true).cwiseProduct(axes) - before).norm());
  }
  return worst / before.norm();
}

/// Sets the body off: moving, turning and being pulled apart at once.
void throw_spinning(Simulation& simulation) {
  const Vec3 middle = centre(simulation, "body");
  const Vec3 velocity(0.5, 0.3, -0.2), spin(3, 12, 6), stretching(1.5, -0.5, 1);
  std::vector<Vec3> velocities;
  for (const Vec3& x : simulation.state().positions) {
    const Vec3 arm = x - middle;
    velocities.push_back(velocity + spin.cross(arm) + stretching.cwiseProduct(arm));
  }
  simulation.set_velocities(velocities);
}

/// Presses a level sheet together along x, in waves.
void crumple(Simulation& simulation) {
  std::vector<Vec3> positions = simulation.state().positions;
  for (Vec3& x : positions)
    x = Vec3(0.8 * x.x(), 0.02 * std::sin(60 * x.x()) + 0.01 * std::cos(35 * x.z()), 0.95 * x.z());
  simulation.set_positions(positions);
}

const std::string free_shell = R"(
[contact]
[[body]]
name = "body"
mesh = "sheet.obj"
model = "shell"
material = "cotton"
)";

const std::string free_lattice = R"(
[contact]
[[body]]
name = "body"
mesh = "cube.obj"
voxel_width = 0.05
bracing = "full"
material = { density = 300, youngs_modulus = 5e4 }
)";

const std::string sheet_on_ice = R"(
[contact]
friction = 0
[[body]]
name = "body"
mesh = "ice.obj"
voxel_width = 0.1
material = "thesis_flag"
velocity = [0.3, 0, 0.1]
translate = [-0.5, 0.06, -0.5]
[[collider]]
name = "floor"
shape = "plane"
[[force]]
type = "gravity"
)";

std::vector<Comparison> lattice_on_ice() {
  const Experiment experiment;
  experiment.level_sheet("ice.obj", 1, 1, 10);
  experiment.level_sheet("sheet.obj", 0.3, 0.3, 15);
  experiment.cube("cube.obj", 0.2, 4);
  Simulation on_ice = experiment.start(sheet_on_ice);
  std::vector<Comparison> numbers = {
      {"level momentum lost on ice", 0, momentum_lost(on_ice, "body", {1, 0, 1}, 24), 1e-9, false}};
  for (const char* effort : {"draft", "normal", "exact"}) {
    const std::vector<std::string> overrides = {fmt::format("solver.effort={}", effort)};
    Simulation shell = experiment.start(free_shell, overrides);
    crumple(shell);
    throw_spinning(shell);
    numbers.push_back({fmt::format("momentum lost by a crumpled shell, {}", effort), 0,
                       momentum_lost(shell, "body", {1, 1, 1}, 12), 1e-9, false});
    Simulation lattice = experiment.start(free_lattice, overrides);
    throw_spinning(lattice);
    numbers.push_back({fmt::format("momentum lost by a lattice, {}", effort), 0,
                       momentum_lost(lattice, "body", {1, 1, 1}, 12), 1e-9, false});
  }
  return numbers;
}

std::vector<Comparison> heavy_far() {
  const Experiment experiment;
  experiment.level_sheet("sheet.obj", 0.6, 0.6, 16);
  Simulation simulation = experiment.start(R"(
[[body]]
name = "cloth"
mesh = "sheet.obj"
model = "shell"
material = "cotton"
translate = [-0.3, 3, -0.3]
[[collider]]
name = "ball"
shape = "sphere"
radius = 0.5
center = [50, 3, 0]
density = 1000
[[force]]
type = "gravity"
)");
  advance(simulation, 12);
  const auto cloth = simulation.model().of(simulation.model().bodies.front(), simulation.state().positions);
  const auto [low, high] = std::minmax_element(cloth.begin(), cloth.end(),
                                               [](const Vec3& a, const Vec3& b) { return a.y() < b.y(); });
  return {{"highest point over the lowest after 0.5 s [m]", 0, high->y() - low->y(), 2e-5, false}};
}

const std::string hung_cloth = R"(
[[body]]
name = "cloth"
mesh = "sheet.obj"
model = "shell"
material = "cotton"
rotate = [90, 0, 0]
translate = [-0.5, 0.5, 0]
[[pin]]
body = "cloth"
where = { nearest = [[-0.5, 0.5, 0], [0.5, 0.5, 0]] }
[[force]]
type = "gravity"
)";

const std::string far_floor = R"(
[[collider]]
name = "floor"
shape = "plane"
center = [0, -50, 0]
)";

std::vector<Comparison> floor_far() {
  const Experiment experiment;
  experiment.level_sheet("sheet.obj", 1, 1, 16);
  Simulation with = experiment.start(hung_cloth + far_floor), without = experiment.start(hung_cloth);
  Watch watch_with(with), watch_without(without);
  watch_with.advance(with, 24);
  watch_without.advance(without, 24);
  const auto cloth_with = with.model().of(with.model().bodies.front(), with.state().positions);
  double squares = 0;
  for (std::size_t v = 0; v < cloth_with.size(); ++v)
    squares += (cloth_with[v] - without.state().positions[v]).squaredNorm();
  return {{"difference after 1 s, root mean square [m]", 0,
           std::sqrt(squares / static_cast<double>(cloth_with.size())), 1e-3, false},
          {"steps unconverged with the floor", 0, 1.0 * watch_with.unconverged_steps(), 0, false},
          {"steps unconverged without it", 0, 1.0 * watch_without.unconverged_steps(), 0, false}};
}

std::vector<Comparison> stretched_strip() {
  const Experiment experiment;
  experiment.level_sheet("strip.obj", 3, 0.2, 20, 4);
  experiment.level_sheet("rest.obj", 1, 0.2, 20, 4);
  Simulation simulation = experiment.start(R"(
[contact]
[[body]]
name = "strip"
mesh = "strip.obj"
rest_mesh = "rest.obj"
model = "shell"
material = "cotton"
stretch_limit = 10
)");
  const Vec3 start = centre(simulation, "strip");
  double farthest = 0;
  for (int frame = 0; frame < 24; ++frame) {
    simulation.advance();
    farthest = std::max(farthest, (centre(simulation, "strip") - start).norm());
  }
  return {{"drift of the centre of mass in 1 s [m]", 0, farthest, 1e-9, false}};
}

std::vector<Comparison> weak_gravity() {
  const Experiment experiment;
  experiment.level_sheet("sheet.obj", 0.6, 0.6, 16);
  Simulation simulation = experiment.start(R"(
[[body]]
name = "sheet"
mesh = "sheet.obj"
model = "shell"
material = "cotton"
[[force]]
type = "gravity"
acceleration = [0, -0.005, 0]
)");
  advance(simulation, 96);
  return {{"fall in 4 s under 0.005 m/s2 [m]", 0.5 * 0.005 * 4 * 4, -centre(simulation, "sheet").y(), 0.03}};
}

std::string pinched_napkin(const std::string& material) {
  return fmt::format(R"(
[contact]
[[body]]
name = "napkin"
mesh = "napkin.obj"
model = "shell"
material = "{}"
translate = [-0.2, 0, -0.2]
[[pin]]
body = "napkin"
where = {{ plane = {{ point = [-0.2, 0, 0], normal = [1, 0, 0] }} }}
until = 0.6
keyframes = [{{ time = 0 }}, {{ time = 0.5, translate = [0.13, 0, 0] }}]
[[pin]]
body = "napkin"
where = {{ plane = {{ point = [0.2, 0, 0], normal = [1, 0, 0] }} }}
until = 0.6
keyframes = [{{ time = 0 }}, {{ time = 0.5, translate = [-0.13, 0, 0] }}]
[[force]]
type = "gravity"
)",
                     material);
}

std::vector<Comparison> crumpled_free_fall() {
  const Experiment experiment;
  experiment.level_sheet("napkin.obj", 0.4, 0.4, 40);
  std::vector<Comparison> numbers;
  for (const char* material : {"silk", "nylon"}) {
    Simulation simulation = experiment.start(pinched_napkin(material));
    advance(simulation, 15);  // the first frame after the pins have let go
    const Vec3 velocity = centre(simulation, "napkin", true);
    const double time = simulation.diagnostics().time;
    advance(simulation, 7);
    const Vec3 acceleration =
        (centre(simulation, "napkin", true) - velocity) / (simulation.diagnostics().time - time);
    numbers.push_back(
        {fmt::format("acceleration of {} as a whole [m/s2]", material), gravity, -acceleration.y(), 1e-3});
    numbers.push_back({fmt::format("of {} to the side [m/s2]", material), 0,
                       std::hypot(acceleration.x(), acceleration.z()), 1e-3 * gravity, false});
  }
  return numbers;
}

}  // namespace

std::vector<VerifyCase> trust_motion_cases() {
  return {
      {"trust-lattice-on-ice", "what slides without friction or flies freely keeps its momentum",
       "conservation", false, lattice_on_ice},
      {"trust-heavy-far", "a heavy ball 50 m away does not bend cloth that falls flat", "symmetry", false,
       heavy_far},
      {"trust-floor-far", "a floor 50 m below does not change how cloth hangs", "symmetry", false, floor_far},
      {"trust-stretched-strip", "a strip that snaps back from three times its length stays where it is",
       "conservation", false, stretched_strip},
      {"trust-weak-gravity", "cloth falls as g t^2 / 2 when g is small", "closed form", false, weak_gravity},
      {"trust-crumpled-free-fall", "crumpled cloth that is let go falls as a whole with g", "closed form",
       true, crumpled_free_fall},
  };
}

}  // namespace muslin::app
