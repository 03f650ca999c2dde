// Trust: scenes as a user writes them first, with default solver settings, checked against predictable
// results: energy never grows, bodies that can rest do rest, thrown bodies return no higher, and no run
// aborts.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "verify_case.hpp"
#include "verify_experiment.hpp"
#include "verify_watch.hpp"
#include <fmt/format.h>

namespace muslin::app {
namespace {

const std::string weight = R"(
[[force]]
type = "gravity"
)";

std::vector<Comparison> rubber_ball() {
  const Experiment experiment;
  experiment.ball("ball.obj", 0.1, 24, 12);
  Simulation simulation = experiment.start(R"(
[[collider]]
name = "floor"
shape = "plane"
[[body]]
name = "ball"
mesh = "ball.obj"
voxel_width = 0.02
material = "rubber"
bracing = "full"
translate = [0, 0.3, 0]
)" + weight);
  const Vec3 start = centre(simulation, "ball");
  Watch watch(simulation);
  double rise = 0;
  for (int frame = 0; frame < 18; ++frame) {
    watch.advance(simulation, 1);
    rise = std::max(rise, centre(simulation, "ball").y() - start.y());
  }
  const Vec3 end = centre(simulation, "ball");
  return {{"rise above the start [m]", 0, rise, 0, false},
          {"way along x after 0.75 s [m]", 0, end.x() - start.x(), 0.01, false},
          {"way along z after 0.75 s [m]", 0, end.z() - start.z(), 0.01, false},
          {"energy gained over energy of the fall", 0, watch.gained() / watch.fallen(), 1e-3, false}};
}

std::vector<Comparison> ball_on_held_cloth() {
  const Experiment experiment;
  Simulation simulation = experiment.start(experiment.held_cloth() + R"(
[[collider]]
name = "ball"
shape = "sphere"
radius = 0.11
center = [0.01, 0.4, 0.02]
density = 80
)" + weight);
  Watch watch(simulation);
  Rebound rebound(centre(simulation, "ball").y());
  for (int seen = 0; seen < 24;) {
    simulation.step();
    rebound.see(centre(simulation, "ball").y());
    if (simulation.frame() == seen) continue;
    seen = simulation.frame();
    watch.look(simulation);
  }
  return {
      {"lowest centre of the ball [m]", -0.20, rebound.lowest, 0.03, false},
      {"highest centre after that [m]", 0.25, rebound.highest, 0.06, false},
      {"energy gained over energy of the fall", 0, watch.gained() / watch.fallen(), 1e-3, false},
      {"balance gained over energy of the fall", 0, watch.balance_gained() / watch.fallen(), 1e-3, false}};
}

std::vector<Comparison> stiff_fabrics() {
  const Experiment experiment;
  experiment.level_sheet("cloth.obj", 0.8, 0.8, 60);
  std::vector<Comparison> numbers;
  for (const char* material : {"nylon", "silk", "canvas", "denim"}) {
    Simulation simulation = experiment.start(fmt::format(R"(
[contact]
friction = 0.4
[[body]]
name = "cloth"
mesh = "cloth.obj"
model = "shell"
material = "{}"
translate = [-0.4, 0.21, -0.4]
[[collider]]
name = "ball"
shape = "sphere"
radius = 0.2
)",
                                                         material) +
                                             weight);
    Watch watch(simulation);
    watch.advance(simulation, 24);
    numbers.push_back({fmt::format("energy gained over energy fallen so far, {}", material), 0,
                       watch.gained_share(), 1e-3, false});
    numbers.push_back({fmt::format("energy gained over largest kinetic, {}", material), 0,
                       watch.gained() / watch.largest_kinetic(), 1e-3, false});
  }
  return numbers;
}

/// A slope that falls towards −x, and on it, 0.2 mm above, a cube named "cube" of this side [m].
std::string cube_on_slope(double degrees, double friction, double side, double voxel_width,
                          const std::string& material) {
  const double angle = degrees * std::numbers::pi / 180, height = side / 2 + 2e-4;
  return fmt::format(R"(
[contact]
friction = {}
[[body]]
name = "cube"
mesh = "cube.obj"
voxel_width = {}
bracing = "full"
material = {}
rotate = [0, 0, {}]
translate = [{:.17g}, {:.17g}, 0]
[[collider]]
name = "slope"
shape = "plane"
normal = [{:.17g}, {:.17g}, 0]
)",
                     friction, voxel_width, material, degrees, -height * std::sin(angle),
                     height * std::cos(angle), -std::sin(angle), std::cos(angle)) +
         weight;
}

std::vector<Comparison> jelly_on_slope() {
  const Experiment experiment;
  experiment.cube("cube.obj", 0.15, 5);
  Simulation simulation = experiment.start(cube_on_slope(
      15, 0.6, 0.15, 0.03,
      "{ density = 1000, youngs_modulus = 2e4, volume_modulus = 4e4, stiffness_damping = 0.004 }"));
  const Vec3 start = centre(simulation, "cube");
  advance(simulation, 48);
  const Vec3 way = centre(simulation, "cube") - start;
  return {{"way of the centre in 2 s [m]", 0, way.norm(), 0.01, false},
          {"to the side [m]", 0, way.z(), 1e-3, false}};
}

std::vector<Comparison> soft_bodies_slide() {
  const Experiment experiment;
  experiment.cube("cube.obj", 0.1, 5);
  Simulation simulation =
      experiment.start(cube_on_slope(45, 0, 0.1, 0.02, "{ density = 1000, youngs_modulus = 1e4 }"));
  const Vec3 start = centre(simulation, "cube");
  advance(simulation, 24);
  const double way = (centre(simulation, "cube") - start).dot(-Vec3(1, 1, 0).normalized());
  return {{"way down a smooth slope of 45 degrees in 1 s [m]", 0.5 * gravity * std::sqrt(0.5), way, 0.03}};
}

std::vector<Comparison> soft_ball_on_edge() {
  const Experiment experiment;
  experiment.ball("ball.obj", 0.1, 24, 12);
  Simulation simulation = experiment.start(R"(
[solver]
effort = "exact"
[contact]
friction = 0
[[body]]
name = "ball"
mesh = "ball.obj"
voxel_width = 0.02
material = { density = 1000, youngs_modulus = 2e4, volume_modulus = 4e4 }
bracing = "full"
translate = [0.15, 0.27, 0]
[[collider]]
name = "box"
shape = "box"
size = [0.3, 0.3, 0.3]
)" + weight);
  advance(simulation, 12);
  return {{"time it comes to [s]", 0.5, simulation.diagnostics().time, 1e-9, false}};
}

std::vector<Comparison> step_choice() {
  const Experiment experiment;
  experiment.level_sheet("cloth.obj", 0.5, 0.5, 50);
  Simulation simulation = experiment.start(R"(
[[body]]
name = "cloth"
mesh = "cloth.obj"
model = "shell"
material = "cotton"
stretch_limit = 1.05
translate = [-0.25, 0.13, -0.25]
[[collider]]
name = "ball"
shape = "sphere"
radius = 0.12
)" + weight);
  Watch watch(simulation);
  int fewest = std::numeric_limits<int>::max(), most = 0;
  for (int frame = 0; frame < 24; ++frame) {
    watch.advance(simulation, 1);
    fewest = std::min(fewest, simulation.diagnostics().steps);
    most = std::max(most, simulation.diagnostics().steps);
  }
  const Diagnostics& last = simulation.diagnostics();
  return {{"stretch beyond 1.06 [m/m]", 0, std::max(0.0, watch.largest_stretch() - 1.06), 0, false},
          {"steps unconverged in the last frame", 0, 1.0 * (last.steps - last.converged_steps), 0, false},
          {fmt::format("steps of a frame are chosen: {} to {}", fewest, most), 1,
           fewest >= 1 && most > fewest ? 1.0 : 0.0, 0, false}};
}

std::vector<Comparison> held_back() {
  const Experiment experiment;
  experiment.level_sheet("cloth.obj", 0.4, 0.8, 8, 16);
  // The edge of the cloth at z = 0 moves half a metre, into a wall a tenth of a metre away.
  Simulation simulation = experiment.start(R"(
[[body]]
name = "cloth"
mesh = "cloth.obj"
model = "shell"
material = "cotton"
translate = [-0.2, 0, -0.8]
[[pin]]
body = "cloth"
where = { plane = { point = [0, 0, 0], normal = [0, 0, 1] } }
keyframes = [{ time = 0 }, { time = 0.5, translate = [0, 0, 0.5] }]
[[collider]]
name = "wall"
shape = "box"
size = [0.8, 2, 0.1]
center = [0, 0, 0.15]
)" + weight);
  Watch watch(simulation);
  watch.advance(simulation, 24);
  const auto cloth = simulation.model().of(simulation.model().bodies.front(), simulation.state().positions);
  double deepest = 0;
  for (const Vec3& x : cloth) deepest = std::max(deepest, x.z() - 0.1);
  return {{"time it comes to [s]", 1, simulation.diagnostics().time, 1e-9, false},
          {fmt::format("something is held back: {} vertices", watch.max_held_back()), 1,
           watch.max_held_back() > 0 ? 1.0 : 0.0, 0, false},
          {"way of any vertex into the wall [m]", 0, deepest, 0, false}};
}

/// Runs `frames` frames, or until the solver fails. Returns the largest kinetic + elastic energy as a
/// multiple of `moved` [J]; NaN once the state is not finite.
double energy_over(Simulation& simulation, int frames, double moved) {
  double largest = 0;
  try {
    for (int frame = 0; frame < frames; ++frame) {
      simulation.advance();
      const double now = simulation.diagnostics().kinetic + simulation.diagnostics().elastic;
      if (!std::isfinite(now)) return now;
      largest = std::max(largest, now);
    }
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::solver) throw;
  }
  for (const Vec3& x : simulation.state().positions)
    if (!x.allFinite()) return x.sum();
  return largest / moved;
}

std::vector<Comparison> absurd() {
  const Experiment experiment;
  experiment.cube("cube.obj", 0.2, 4);
  experiment.level_sheet("cloth.obj", 0.6, 0.6, 16);
  Simulation rough = experiment.start(R"(
[contact]
friction = 100
[[body]]
name = "cube"
mesh = "cube.obj"
voxel_width = 0.05
bracing = "full"
material = { density = 300, youngs_modulus = 5e4 }
velocity = [2, 0, 0]
translate = [0, 0.11, 0]
[[collider]]
name = "floor"
shape = "plane"
)" + weight);
  const double thrown = rough.diagnostics().kinetic;
  Simulation struck = experiment.start(R"(
[[body]]
name = "cloth"
mesh = "cloth.obj"
model = "shell"
material = "cotton"
translate = [-0.3, 0, -0.3]
[[collider]]
name = "bullet"
shape = "sphere"
radius = 0.1
center = [0, 0.5, 0]
keyframes = [{ time = 0 }, { time = 0.1, translate = [0, -1000, 0] }]
)" + weight);
  const double carried = 0.5 * struck.model().bodies.front().statistics.mass * 1e4 * 1e4;
  return {{"energy over that of the throw, friction 100", 0, energy_over(rough, 24, thrown), 10, false},
          {"energy over that of cloth as fast as the ball", 0, energy_over(struck, 6, carried), 10, false}};
}

std::vector<Comparison> high_friction() {
  const Experiment experiment;
  experiment.cube("cube.obj", 0.2, 4);
  experiment.level_sheet("cloth.obj", 0.3, 0.3, 8);
  const std::string floor = "[contact]\nfriction = 100\n[[collider]]\nname = \"floor\"\nshape = \"plane\"\n";
  const std::vector<std::pair<const char*, const char*>> thrown = {{"soft cube", R"(
[[body]]
name = "cube"
mesh = "cube.obj"
voxel_width = 0.05
bracing = "full"
material = { density = 300, youngs_modulus = 5e4 }
velocity = [2, 0, 0]
rotate = [30, 20, 10]
translate = [0, 0.3, 0]
)"},
                                                                   {"rigid cube", R"(
[[collider]]
name = "cube"
shape = "mesh"
mesh = "cube.obj"
density = 300
velocity = [2, 0, 0]
rotate = [30, 20, 10]
translate = [0, 0.3, 0]
)"},
                                                                   {"denim", R"(
[[body]]
name = "cloth"
mesh = "cloth.obj"
model = "shell"
material = "denim"
velocity = [2, 0, 0]
rotate = [80, 10, 0]
translate = [0, 0.33, 0]
)"}};
  std::vector<Comparison> numbers;
  for (const auto& [name, body] : thrown) {
    std::string scene = floor;
    scene.append(body).append(weight);
    Simulation simulation = experiment.start(scene);
    Watch watch(simulation);
    watch.advance(simulation, 12);
    numbers.push_back({fmt::format("energy gained over energy of the fall, {}", name), 0,
                       watch.gained() / watch.fallen(), 1e-3, false});
  }
  return numbers;
}

std::vector<Comparison> rigid_impact() {
  const Experiment experiment;
  std::vector<Comparison> numbers;
  for (const char* integrator : {"implicit_euler", "bdf2"}) {
    Simulation simulation = experiment.start(fmt::format(R"(
[solver]
integrator = "{}"
[[collider]]
name = "box"
shape = "box"
size = [0.2, 0.2, 0.2]
center = [0, 0.3, 0]
rotate = [10, 20, 30]
density = 20
[[collider]]
name = "ball"
shape = "sphere"
radius = 0.1
center = [0.03, 0.7, 0]
density = 11000
[[collider]]
name = "floor"
shape = "plane"
)",
                                                         integrator) +
                                             weight);
    Watch watch(simulation);
    watch.advance(simulation, 24);
    numbers.push_back({fmt::format("energy gained over energy of the fall, {}", integrator), 0,
                       watch.gained() / watch.fallen(), 1e-3, false});
    numbers.push_back({fmt::format("work from outside [J], {}", integrator), 0, simulation.diagnostics().work,
                       1e-9, false});
  }
  return numbers;
}

}  // namespace

std::vector<VerifyCase> trust_cases() {
  std::vector<VerifyCase> cases = {
      {"trust-rubber-ball", "a rubber ball bounces no higher than it was dropped from, and straight",
       "second law", false, rubber_ball},
      {"trust-ball-on-held-cloth", "a light ball sinks into held cloth and rebounds", "measurement", false,
       ball_on_held_cloth},
      {"trust-stiff-fabrics", "stiff fabrics that fall on a ball gain no energy", "second law", true,
       stiff_fabrics},
      {"trust-jelly-on-slope", "a soft cube below the limit of friction stays where it was put", "Coulomb",
       false, jelly_on_slope},
      {"trust-soft-bodies-slide", "a soft cube slides down a smooth slope as fast as a hard one",
       "closed form", false, soft_bodies_slide},
      {"trust-soft-ball-on-edge", "a soft ball that falls on an edge does not stop the run", "promise", true,
       soft_ball_on_edge},
      {"trust-step-choice", "steps are as many as a drop on a ball needs, and all converge in the end",
       "promise", true, step_choice},
      {"trust-held-back", "a pin that pulls cloth through a wall is held back and reported", "promise", false,
       held_back},
      {"trust-rigid-impact", "a ball of lead that falls on a box of foam brings no energy", "second law",
       false, rigid_impact},
      {"trust-high-friction", "what is thrown on a floor of friction 100 gains no energy", "second law", true,
       high_friction},
      {"trust-absurd", "what no one means ends in an error or in a finite result", "promise", true, absurd},
  };
  const std::vector<VerifyCase> motion = trust_motion_cases();
  cases.insert(cases.end(), motion.begin(), motion.end());
  return cases;
}

}  // namespace muslin::app
