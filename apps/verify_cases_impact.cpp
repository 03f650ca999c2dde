// Impacts on held cloth, with the effort `normal` against `exact`.
#include <array>
#include <string>
#include <vector>

#include "verify_case.hpp"
#include "verify_experiment.hpp"
#include <fmt/format.h>

namespace muslin::app {
namespace {

/// A body falls into held cloth.
Rebound fall(const std::string& body, const char* effort) {
  const Experiment experiment;
  Simulation simulation = experiment.start(experiment.held_cloth() + fmt::format(R"(
[solver]
effort = "{}"
[[force]]
type = "gravity"
[[collider]]
name = "falling"
center = [0.01, 0.4, 0.02]
density = 80
{}
)",
                                                                                 effort, body));
  Rebound rebound(centre(simulation, "falling").y());
  while (simulation.frame() < 24) {
    simulation.step();
    rebound.see(centre(simulation, "falling").y());
  }
  return rebound;
}

std::vector<Comparison> impacts() {
  std::vector<Comparison> numbers;
  for (const auto& [name, body] : {std::pair{"ball", "shape = \"sphere\"\nradius = 0.11"},
                                   {"block", "shape = \"box\"\nsize = [0.2, 0.12, 0.16]"}}) {
    const Rebound exact = fall(body, "exact"), normal = fall(body, "normal");
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
