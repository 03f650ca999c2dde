// Friction: bodies on a slope, a strip around a pole, a rolling ball.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "verify_case.hpp"
#include "verify_experiment.hpp"
#include <fmt/format.h>

namespace muslin::app {
namespace {

/// A slope that rises towards −x, modelled as a level floor under rotated gravity.
std::string slope(double degrees, double friction, int frame_rate) {
  const double angle = degrees * std::numbers::pi / 180;
  return fmt::format(R"(
[time]
frame_rate = {}
steps_per_frame = 4
duration = 1000
[contact]
friction = {}
distance = 0.002
[solver]
tolerance = 1e-5
[[collider]]
name = "slope"
shape = "plane"
[[force]]
type = "gravity"
acceleration = [{:.17g}, {:.17g}, 0]
)",
                     frame_rate, friction, gravity * std::sin(angle), -gravity * std::cos(angle));
}

const std::string block = R"(
[[collider]]
name = "body"
shape = "box"
size = [0.1, 0.06, 0.1]
center = [0, 0.0315, 0]
density = 1000
)";

const std::string lattice_block = R"(
[[body]]
name = "body"
mesh = "block.obj"
voxel_width = 0.05
bracing = "full"
translate = [0, 0.0015, 0]
[body.material]
density = 1000
youngs_modulus = 1e6
stiffness_damping = 0.002
)";

const std::string patch = R"(
[[body]]
name = "body"
mesh = "patch.obj"
model = "shell"
material = "denim"
translate = [0, 0.0015, 0]
)";

Simulation start_on_slope(const Experiment& experiment, const std::string& body, double degrees,
                          double friction, int frame_rate, const std::vector<std::string>& overrides = {}) {
  experiment.box("block.obj", {0.1, 0.05, 0.1});
  experiment.level_sheet("patch.obj", 0.2, 0.2, 10);
  return experiment.start(slope(degrees, friction, frame_rate) + body, overrides);
}

constexpr double angle = 20;  // degrees; tan = 0.364

std::vector<Comparison> holds_on_a_slope() {
  std::vector<Comparison> numbers;
  for (const auto& [name, body] : {std::pair{"a rigid block", block},
                                   std::pair{"a soft block", lattice_block}, std::pair{"cloth", patch}}) {
    const Experiment experiment;
    Simulation simulation = start_on_slope(experiment, body, angle, 0.40, 10);
    advance(simulation, 10);  // it settles
    const Vec3 settled = centre(simulation, "body");
    advance(simulation, 600);
    numbers.push_back({fmt::format("creep of {} in 60 s [m], mu = 1.1 tan", name), 0,
                       (centre(simulation, "body") - settled).norm(), 1e-6, false});
  }
  return numbers;
}

/// The slope as two hundred triangles, whose edges must not affect a body on it.
const std::string ramp = R"(
[[collider]]
name = "ramp"
shape = "mesh"
mesh = "ramp.obj"
translate = [-0.513, 0.001, -0.527]
)";

/// Between the block and the slope: cloth.
const std::string block_on_cloth = R"(
[[body]]
name = "cloth"
mesh = "patch.obj"
model = "shell"
material = "denim"
translate = [-0.1, 0.0015, -0.1]
[[collider]]
name = "body"
shape = "box"
size = [0.1, 0.06, 0.1]
center = [0, 0.035, 0]
density = 1000
)";

/// Default solver settings.
std::vector<Comparison> holds_by_default() {
  const std::vector<std::string> defaults = {"solver.tolerance=0.01", "time.steps_per_frame=auto"};
  std::vector<Comparison> numbers;
  for (const auto& [name, body] :
       {std::pair{"a rigid block", block}, std::pair{"a soft block", lattice_block},
        std::pair{"cloth", patch}, std::pair{"cloth on triangles", ramp + patch},
        std::pair{"a block on cloth", block_on_cloth}}) {
    const Experiment experiment;
    experiment.level_sheet("ramp.obj", 1, 1, 10);
    Simulation simulation = start_on_slope(experiment, body, angle, 0.40, 10, defaults);
    advance(simulation, 10);  // it settles
    const Vec3 settled = centre(simulation, "body");
    double farthest = 0;
    for (int second = 0; second < 60; ++second) {
      advance(simulation, 10);
      farthest = std::max(farthest, (centre(simulation, "body") - settled).norm());
    }
    numbers.push_back({fmt::format("creep of {} in 60 s [m], mu = 1.1 tan", name), 0, farthest, 1e-6, false});
  }
  return numbers;
}

std::vector<Comparison> slides_down_a_slope() {
  std::vector<Comparison> numbers;
  const double radians = angle * std::numbers::pi / 180, friction = 0.2;
  for (const auto& [name, body] : {std::pair{"a rigid block", block},
                                   std::pair{"a soft block", lattice_block}, std::pair{"cloth", patch}}) {
    const Experiment experiment;
    Simulation simulation = start_on_slope(experiment, body, angle, friction, 60);
    advance(simulation, 30);
    const double before = centre(simulation, "body", true).x();
    advance(simulation, 60);
    const double expected = gravity * (std::sin(radians) - friction * std::cos(radians));
    numbers.push_back({fmt::format("acceleration of {} [m/s2]", name), expected,
                       centre(simulation, "body", true).x() - before, 0.02});
  }
  return numbers;
}

/// The bodies that stick and slip.
const std::array bodies = {std::pair{"a rigid block", block}, std::pair{"cloth", patch}};

/// A block of friction 0.8 on a slope of 0.05: together 0.2.
std::vector<Comparison> friction_of_a_pair() {
  const double radians = angle * std::numbers::pi / 180;
  const Experiment experiment;
  Simulation simulation = start_on_slope(experiment, block + "friction = 0.8\n", angle, 0.7, 60,
                                         {"collider.slope.friction=0.05"});
  advance(simulation, 30);
  const double before = centre(simulation, "body", true).x();
  advance(simulation, 60);
  return {{"acceleration of a block [m/s2]", gravity * (std::sin(radians) - 0.2 * std::cos(radians)),
           centre(simulation, "body", true).x() - before, 0.01}};
}

/// On a level floor, pulled sideways by a(t) of its weight per mass, a = μ g t for two seconds and then none:
/// it stays until a reaches μ g at 1 s, slides by μ g (t − 1)³/6, is let go at v = μ g/2, slows down by μ g,
/// and stops v²/(2 μ g) farther.
std::vector<Comparison> sticks_slips_and_sticks() {
  constexpr double friction = 0.3, most = friction * gravity;
  std::vector<Comparison> numbers;
  for (const auto& [name, body] : bodies) {
    const Experiment experiment;
    Simulation simulation =
        start_on_slope(experiment, body, 0, friction, 60,
                       {fmt::format("force.0={{type=\"gravity\",keyframes=[{{time=0,value=[0,{0},0]}},"
                                    "{{time=2,value=[{1},{0},0]}},{{time=2.0001,value=[0,{0},0]}}]}}",
                                    -gravity, 2 * most)});
    const auto at = [&](double time) {
      advance(simulation, static_cast<int>(std::lround(60 * time)) - simulation.frame());
      return centre(simulation, "body").x();
    };
    const double settled = at(0.25), held = at(0.95), slid = at(2), stopped = at(3), later = at(6);
    numbers.push_back(
        {fmt::format("slip of {} at 0.95 of the limit [m]", name), 0, held - settled, 1e-5, false});
    numbers.push_back({fmt::format("way of {} while pulled [m]", name), most / 6, slid - settled, 0.02});
    numbers.push_back({fmt::format("and until it stops [m]"), most / 8, stopped - slid, 0.02});
    numbers.push_back({"and then [m]", 0, later - stopped, 1e-6, false});
  }
  return numbers;
}

/// A level plane that turns by w: a body on it sticks until it has turned by atan μ, and has then slid g/(w²
/// cos) (φ − sin φ) when it has turned by φ more; farther by about the share μφ/2, since the plane recedes
/// beneath the moving body (normal force less by 2 m w v). Before, the body shifts with the contact gap, by
/// gap × angle.
std::vector<Comparison> slides_off_a_turning_plane() {
  constexpr double friction = 0.3, degrees_per_second = 3;
  const double speed = degrees_per_second * std::numbers::pi / 180, limit = std::atan(friction);
  std::vector<Comparison> numbers;
  for (const auto& [name, body] : bodies) {
    const Experiment experiment;
    Simulation simulation =
        start_on_slope(experiment, body, 0, friction, 60,
                       {fmt::format("collider.slope.keyframes=[{{time=0}},{{time=10,rotate=[0,0,{}]}}]",
                                    -10 * degrees_per_second)});
    const auto slid = [&](double turned) {
      advance(simulation, static_cast<int>(std::lround(60 * turned / speed)) - simulation.frame());
      const double now = speed * simulation.diagnostics().time;
      return centre(simulation, "body").dot(Vec3(std::cos(now), -std::sin(now), 0));
    };
    const double settled = slid(0.05), held = slid(0.97 * limit), late = slid(limit + 0.1);
    const double beyond = speed * simulation.diagnostics().time - limit;
    numbers.push_back({fmt::format("slip of {} before atan mu [m]", name), 0, held - settled, 1e-3, false});
    numbers.push_back({fmt::format("slip of {} beyond [m]", name),
                       gravity / (speed * speed * std::cos(limit)) * (beyond - std::sin(beyond)) *
                           (1 + friction * beyond / 2),
                       late - settled, 0.02});
  }
  return numbers;
}

/// The ratio of the loads of a strip around half a pole at which it slides. One load grows to 0.9 of the
/// closed form, and from there slowly: it grows on until the strip has slid a millimetre, which tells.
double ratio_that_slides(int cells, double friction) {
  const Experiment experiment;
  const int rows = cells / 30;
  experiment.level_sheet("strip.obj", 0.8, 0.02, cells, rows);
  constexpr int frame_rate = 60, quick = 3, slow = 8;  // frames per second, and seconds
  const double limit = std::exp(friction * std::numbers::pi), load = 1.0 / (rows + 1);  // per vertex of an end
  Simulation simulation = experiment.start(fmt::format(
      R"(
[time]
frame_rate = {0}
steps_per_frame = 2
duration = 100
[solver]
effort = "exact"
[contact]
friction = {1}
distance = 0.001
[[body]]
name = "strip"
mesh = "strip.obj"
model = "shell"
material = {{ areal_density = 0.2, membrane_warp = 10000, poisson = 0, bending_warp = 1e-5, mass_damping = 5, stiffness_damping = 0.002 }}
translate = [-0.4, 0.1025, 0]
[[collider]]
name = "pole"
shape = "capsule"
points = [[0, 0, -0.1], [0, 0, 0.12]]
radius = 0.1
[[force]]
type = "point"
name = "still"
where = {{ plane = {{ point = [-0.4, 0, 0], normal = [1, 0, 0] }} }}
force = [0, {2:.17g}, 0]
[[force]]
type = "point"
name = "growing"
where = {{ plane = {{ point = [0.4, 0, 0], normal = [1, 0, 0] }} }}
keyframes = [{{ time = 0, value = [0, {2:.17g}, 0] }}, {{ time = 1, value = [0, {2:.17g}, 0] }},
  {{ time = {3}, value = [0, {4:.17g}, 0] }}, {{ time = {5}, value = [0, {6:.17g}, 0] }}]
)",
      frame_rate, friction, -load, quick, -0.9 * limit * load, quick + slow, -1.1 * limit * load));
  advance(simulation, frame_rate);
  const double settled = simulation.state().positions[0].y();
  for (int frame = frame_rate; frame <= frame_rate * (quick + slow); ++frame) {
    if (simulation.state().positions[0].y() - settled > 1e-3) {
      const double time = static_cast<double>(frame) / frame_rate;
      return time < quick ? 1 + (0.9 * limit - 1) * (time - 1) / (quick - 1)
                          : limit * (0.9 + 0.2 * (time - quick) / slow);
    }
    advance(simulation, 1);
  }
  return 0;
}

std::vector<Comparison> capstan() {
  std::vector<Comparison> numbers;
  for (const double friction : {0.15, 0.3})
    for (const int cells : {30, 60, 120})
      numbers.push_back({fmt::format("ratio that slides, mu = {}, {} cells", friction, cells),
                         std::exp(friction * std::numbers::pi), ratio_that_slides(cells, friction), 0.02});
  return numbers;
}

/// By bdf2: implicit Euler takes from a spin of w a share of about w2 dt in a second.
std::vector<Comparison> rolling_ball() {
  std::vector<Comparison> numbers;
  const double radians = angle * std::numbers::pi / 180, radius = 0.2;
  for (const double friction : {0.3, 0.05}) {
    const Experiment experiment;
    Simulation simulation = experiment.start(slope(angle, friction, 60) + fmt::format(R"(
[[collider]]
name = "ball"
shape = "sphere"
center = [0, {}, 0]
radius = {}
density = 1000
)",
                                                                                      radius + 1e-3, radius),
                                             {"solver.integrator=bdf2"});
    advance(simulation, 30);
    const double before = centre(simulation, "ball", true).x();
    advance(simulation, 60);
    const bool rolls = friction > std::tan(radians) * 2 / 7;
    const double sine = gravity * std::sin(radians), cosine = gravity * std::cos(radians);
    numbers.push_back({fmt::format("acceleration of a ball [m/s2], mu = {}", friction),
                       rolls ? sine * 5 / 7 : sine - friction * cosine,
                       centre(simulation, "ball", true).x() - before, 0.02});
  }
  return numbers;
}

}  // namespace

std::vector<VerifyCase> friction_cases() {
  return {
      {"slope-holds", "bodies on a slope stay where they are for mu > tan, for a minute", "Coulomb's law",
       false, holds_on_a_slope},
      {"slope-holds-normal", "so they do with normal effort and automatic steps", "Coulomb's law", false,
       holds_by_default},
      {"slope-slides", "and slide with g (sin - mu cos) otherwise", "closed form", false,
       slides_down_a_slope},
      {"friction-pairs", "friction of two bodies is the geometric mean of theirs", "closed form", false,
       friction_of_a_pair},
      {"stick-slip", "what is pulled ever harder stays, slips, and stops again when it is let go",
       "closed form", false, sticks_slips_and_sticks},
      {"turning-plane", "what lies on a plane that turns slides from atan mu on", "closed form", false,
       slides_off_a_turning_plane},
      {"capstan", "a strip around half a pole slides when its loads differ by exp(mu pi)", "Euler, Eytelwein",
       true, capstan},
      {"rolling", "a ball rolls down a slope with 5/7 g sin, or slides", "closed form", false, rolling_ball},
  };
}

}  // namespace muslin::app
