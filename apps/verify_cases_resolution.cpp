// A fabric at several resolutions: cloth that hangs by two corners, cloth that drapes over a table.
#include <algorithm>
#include <limits>

#include "verify_case.hpp"
#include "verify_experiment.hpp"
#include <fmt/format.h>

namespace muslin::app {
namespace {

constexpr double side = 0.5;  // m

/// Damping that brings the cloth to rest sooner; the shape at rest does not depend on it.
constexpr const char* setting = R"(
[time]
frame_rate = 24
[solver]
tolerance = 0.05
[[body]]
mesh = "cloth.obj"
model = "shell"
material = { base = "cotton", mass_damping = 4 }
[[force]]
type = "gravity"
)";

/// Two corners are brought from 0.5 m to 0.42 m: a swag folds between them.
const std::string hang = std::string(setting) + R"(
[[pin]]
where = { nearest = [0, 0, 0] }
keyframes = [{ time = 0 }, { time = 0.5, translate = [0.04, 0, 0] }]
[[pin]]
where = { nearest = [0.5, 0, 0] }
keyframes = [{ time = 0 }, { time = 0.5, translate = [-0.04, 0, 0] }]
)";

/// A square of 0.1 m in the middle is held, as on a small table; 0.2 m hang over each side.
const std::string drape = std::string(setting) + R"(
[[pin]]
where = { box = [[0.2, -1, 0.2], [0.3, 1, 0.3]] }
)";

struct Heights {
  double lowest = 0, mean = 0;  ///< below where the cloth is held [m]
};

Heights heights_at_rest(const std::string& scene, int squares) {
  const Experiment experiment;
  experiment.level_sheet("cloth.obj", side, side, squares);
  Simulation simulation = experiment.start(scene);
  advance(simulation, 72);
  Heights heights;
  const auto& positions = simulation.state().positions;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    heights.lowest = std::max(heights.lowest, -positions[v].y());
    heights.mean -= positions[v].y() * simulation.model().masses[v];
  }
  double mass = 0;
  for (const double m : simulation.model().masses) mass += m;
  heights.mean /= mass;
  return heights;
}

/// Every resolution against the finest.
std::vector<Comparison> compare(const std::string& what, const std::string& scene, int finest_squares) {
  const Heights finest = heights_at_rest(scene, finest_squares);
  std::vector<Comparison> numbers;
  for (int squares = finest_squares / 2; squares >= 25; squares /= 2) {
    const Heights heights = heights_at_rest(scene, squares);
    const std::string where = fmt::format("{} of {}^2 over {}^2 [m]", what, squares, finest_squares);
    numbers.push_back({"lowest " + where, finest.lowest, heights.lowest, 0.02});
    numbers.push_back({"mean " + where, finest.mean, heights.mean, 0.02});
  }
  return numbers;
}

std::vector<Comparison> same_at_every_resolution() {
  std::vector<Comparison> numbers = compare("hang", hang, 100);
  const std::vector<Comparison> more = compare("drape", drape, 200);
  numbers.insert(numbers.end(), more.begin(), more.end());
  return numbers;
}

}  // namespace

std::vector<VerifyCase> resolution_cases() {
  return {{"resolution", "one fabric hangs and drapes to the same height at 25^2, 50^2, 100^2 and 200^2",
           "the finest", true, same_at_every_resolution}};
}

}  // namespace muslin::app
