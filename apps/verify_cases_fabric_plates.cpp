// Benchmarks of plates and thin shells with known small deflections: a square plate under pressure, a pinched
// cylinder, a twisted strip.
#include <array>
#include <cmath>
#include <numbers>

#include "verify_fabric.hpp"
#include <fmt/format.h>

namespace muslin::app {
namespace {

/// A square plate on four hinges under a small pressure: w = 0.00406235 q a⁴/D in its middle.
std::vector<Comparison> plate(std::initializer_list<int> cells) {
  const double rigidity = 1, pressure = 0.1, thickness = 0.05;  // deflects by 4e-4 sides
  std::vector<Comparison> numbers;
  for (const FabricMesh& of : fabric_meshes(cells)) {
    const Experiment experiment;
    const FabricSheet sheet(experiment, of, 1, false);
    Simulation simulation =
        experiment.start(static_solve(1e-7) + fabric_body(rigidity, 0.3, thickness) + fabric_pin(0, 0, 1, 0) +
                         fabric_pin(0, 1, 1, 1) + fabric_pin(0, 0, 0, 1) + fabric_pin(1, 0, 1, 1) +
                         fmt::format("[[force]]\ntype = \"gravity\"\nacceleration = [0, 0, {:.17g}]\n",
                                     pressure / fabric_density) +
                         probe("middle", {0.5, 0.5, 0}));
    advance(simulation, 1);
    numbers.push_back(of.compare("w D / (q a^4) in the middle", 0.00406235,
                                 simulation.probe("middle").z() * rigidity / pressure));
  }
  return numbers;
}

/// Moves the vertex nearest to a point.
std::string push(const Vec3& at, const Vec3& by) {
  return fmt::format(
      "[[pin]]\nwhere = {{ nearest = [{:.17g}, {:.17g}, {:.17g}] }}\n"
      "keyframes = [{{ time = 0 }}, {{ time = 1e4, translate = [{:.17g}, {:.17g}, {:.17g}] }}]\n",
      at.x(), at.y(), at.z(), by.x(), by.y(), by.z());
}

/// A cylinder with free ends, pinched in its middle between two points: 0.1139 under a load of 100. Cells
/// around are such that their rows along are even in number: a vertex of the mesh lies at each of the two
/// points.
double pinched_cylinder(const FabricMesh& of) {
  const double radius = 4.953, length = 10.35, circle = 2 * std::numbers::pi * radius, small = 1e-3;
  const Experiment experiment;
  experiment.mesh("sheet.obj", bent_strip(of, length / circle, false, [&](const Vec3& p) {
                    const double angle = 2 * std::numbers::pi * p.x();
                    return Vec3(radius * std::cos(angle), circle * p.y(), radius * std::sin(angle));
                  }));
  const Vec3 inwards(small, 0, 0);
  Simulation simulation =
      experiment.start(static_solve(1e-8) + shell_body(10.5e6, 0.3125, 0.094) +
                       push({radius, length / 2, 0}, -inwards) + push({-radius, length / 2, 0}, inwards));
  advance(simulation, 1);
  return 100 * small / (simulation.diagnostics().elastic / small);
}

/// A strip twisted by 90°, clamped, loaded at its end along its width or across: deflections along the load.
std::array<double, 2> twisted_strip(const FabricMesh& of) {
  const double length = 12, width = 1.1, thickness = 0.0032, load = 1e-6;
  const Experiment experiment;
  const auto shape = [&](const Vec3& p) {
    const double angle = std::numbers::pi / 2 * p.x(), off = p.y() * length - width / 2;
    return Vec3(length * p.x(), off * std::cos(angle), off * std::sin(angle));
  };
  experiment.mesh("sheet.obj", bent_strip(of, width / length, true, shape));
  const Vec3 a = shape({1, 0, 0}), b = shape({1, width / length, 0});
  std::array<double, 2> moved{};
  for (const int across : {0, 1}) {
    Vec3 force = Vec3::Zero();
    force[across == 0 ? 2 : 1] = load / 2;  // the end stands along z
    Simulation simulation =
        experiment.start(static_solve(1e-8) + shell_body(29e6, 0.22, thickness) +
                         "[[pin]]\nwhere = { box = [[-10, -10, -10], [1e-6, 10, 10]] }\n" +
                         point_force(a, force) + point_force(b, force) + probe("a", a) + probe("b", b));
    advance(simulation, 1);
    const Vec3 mean = (simulation.probe("a") + simulation.probe("b") - a - b) / 2;
    moved[static_cast<std::size_t>(across)] = mean[across == 0 ? 2 : 1];
  }
  return moved;
}

std::vector<Comparison> cylinder(std::initializer_list<int> cells) {
  std::vector<Comparison> numbers;
  for (const FabricMesh& of : fabric_meshes(cells))
    numbers.push_back({of.label("deflection"), 0.1139, pinched_cylinder(of), tolerance_around(of)});
  return numbers;
}

std::vector<Comparison> twisted(std::initializer_list<int> cells) {
  std::vector<Comparison> numbers;
  for (const FabricMesh& of : fabric_meshes(cells)) {
    const auto [along, across] = twisted_strip(of);
    numbers.push_back(of.compare("deflection along its width", 0.005256, along));
    numbers.push_back(of.compare("deflection across", 0.001294, across));
  }
  return numbers;
}

}  // namespace

std::vector<VerifyCase> fabric_plate_cases() {
  return {
      {"fabric-plate", "a square plate on hinges deflects under pressure as plate theory says, on any mesh",
       "Navier's series; Timoshenko 1959", false, [] { return plate({8}); }},
      {"fabric-plate-fine", "a square plate deflects as plate theory says, on finer meshes",
       "Navier's series; Timoshenko 1959", true, [] { return plate({16, 32}); }},
      {"fabric-cylinder", "a cylinder pinched in its middle deflects as a thin shell", "Takemoto & Cook 1973",
       true, [] { return cylinder({24, 48, 96}); }},
      {"fabric-twisted", "a twisted strip deflects as a thin shell", "MacNeal & Harder 1985", true,
       [] { return twisted({10, 20, 40}); }},
  };
}

}  // namespace muslin::app
