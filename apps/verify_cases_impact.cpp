// Impacts on held cloth, with the effort `normal` against `exact`.
#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "verify_case.hpp"
#include "verify_experiment.hpp"
#include <fmt/format.h>

namespace muslin::app {
namespace {

struct Impact {
  double lowest, highest;  ///< heights of the centre, the second after the first [m]
};

/// A body falls into cotton held at two edges.
Impact fall(const std::string& body, const char* effort) {
  const Experiment experiment;
  experiment.level_sheet("cloth.obj", 1, 1, 16);
  Simulation simulation = experiment.start(fmt::format(R"(
[solver]
effort = "{}"
[[body]]
name = "cloth"
mesh = "cloth.obj"
model = "shell"
material = "cotton"
stretch_limit = 10
translate = [-0.5, 0, -0.5]
[[pin]]
body = "cloth"
where = {{ plane = {{ point = [-0.5, 0, 0], normal = [1, 0, 0] }} }}
[[pin]]
body = "cloth"
where = {{ plane = {{ point = [0.5, 0, 0], normal = [1, 0, 0] }} }}
[[force]]
type = "gravity"
[[collider]]
name = "falling"
center = [0.01, 0.4, 0.02]
density = 80
{}
)",
                                                       effort, body));
  Impact result{1, 0};
  while (simulation.frame() < 24) {
    simulation.step();
    const double height = centre(simulation, "falling").y();
    result.highest = height < result.lowest ? height : std::max(result.highest, height);
    result.lowest = std::min(result.lowest, height);
  }
  return result;
}

std::vector<Comparison> impacts() {
  std::vector<Comparison> numbers;
  for (const auto& [name, body] : {std::pair{"ball", "shape = \"sphere\"\nradius = 0.11"},
                                   {"block", "shape = \"box\"\nsize = [0.2, 0.12, 0.16]"}}) {
    const Impact exact = fall(body, "exact"), normal = fall(body, "normal");
    numbers.push_back(
        {fmt::format("lowest centre of the {} [m]", name), exact.lowest, normal.lowest, 1e-3, false});
    numbers.push_back({"highest centre after that [m]", exact.highest, normal.highest, 0.01, false});
  }
  return numbers;
}

}  // namespace

std::vector<VerifyCase> impact_cases() {
  return {{"impact", "a ball and a block sink into held cloth and rebound alike at efforts normal and exact",
           "effort exact", true, impacts}};
}

}  // namespace muslin::app
