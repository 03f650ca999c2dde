// The roof of Scordelis and Lo, a thin shell whose supports leave a coordinate free: a rod to a point far
// away holds one coordinate.
#include <cmath>
#include <numbers>

#include "verify_fabric.hpp"
#include <fmt/format.h>

namespace muslin::app {
namespace {

constexpr double far = 1e3;  // length of a rod; a vertex that moves by u across it moves by u²/(2 far) along

/// The place that rods hang from.
const std::string frame =
    "[[collider]]\nname = \"frame\"\nshape = \"box\"\nsize = [1, 1, 1]\ncenter = [0, 0, 900]\n";

/// Holds the vertices of a box in one direction by rods of this stiffness [N/m].
std::string roller(const Vec3& low, const Vec3& high, const Vec3& direction, double stiffness) {
  const Vec3 at = (low + high) / 2 + far * direction;
  return fmt::format(
      "[[attachment]]\nwhere = {{ box = [[{:.17g}, {:.17g}, {:.17g}], [{:.17g}, {:.17g}, {:.17g}]] }}\n"
      "to = \"frame\"\nat = [{:.17g}, {:.17g}, {:.17g}]\nrest = \"distance\"\nstiffness = {:.17g}\n",
      low.x(), low.y(), low.z(), high.x(), high.y(), high.z(), at.x(), at.y(), at.z(), stiffness);
}

/// A cylinder of 80°, R/t = 100, whose curved ends stand on diaphragms, under its weight: the middle of its
/// straight edges sinks by 0.3024. The load is a thousandth, so that the deflection is small.
double sunken_roof(const FabricMesh& of) {
  const double radius = 25, length = 50, thickness = 0.25, load = 90e-4, small = 1e-3;
  const double arc = 80 * std::numbers::pi / 180;
  const Experiment experiment;
  // x of the strip goes along the axis.
  const double width = radius * arc / length;
  const auto shape = [&](const Vec3& p) {
    const double angle = arc * (p.y() / width - 0.5);
    return Vec3(length * p.x(), radius * std::cos(angle), radius * std::sin(angle));
  };
  experiment.mesh("sheet.obj", bent_strip(of, width, false, shape));
  const double stiff = 1e5;
  std::string rollers;
  for (const double x : {0.0, length})
    for (const Vec3& direction : {Vec3(0, 1, 0), Vec3(0, 0, 1)})
      rollers += roller({x - 1e-6, -100, -100}, {x + 1e-6, 100, 100}, direction, stiff);
  const Vec3 corner = shape({0, 0, 0}), tiny(1e-6, 1e-6, 1e-6);
  rollers += roller(corner - tiny, corner + tiny, Vec3::UnitX(), stiff);
  const Vec3 middle = shape({0.5, 0, 0});
  Simulation simulation = experiment.start(
      slow_steps(100) + frame + shell_body(4.32e4, 0, thickness) + rollers + probe("middle", middle) +
      fmt::format("[[force]]\ntype = \"gravity\"\nacceleration = [0, {:.17g}, 0]\n",
                  -small * load / fabric_density));
  advance(simulation, 1);
  return (middle.y() - simulation.probe("middle").y()) / small;
}

/// Membrane forces carry a roof: strain is constant in a triangle, and the error large on coarse meshes.
std::vector<Comparison> roof(std::initializer_list<int> cells) {
  std::vector<Comparison> numbers;
  for (const FabricMesh& of : fabric_meshes(cells))
    numbers.push_back({of.label("sinking of the middle of an edge"), 0.3024, sunken_roof(of),
                       0.04 * std::pow(40.0 / of.cells, 2)});
  return numbers;
}

}  // namespace

std::vector<VerifyCase> fabric_roof_cases() {
  return {
      {"fabric-roof", "a roof on diaphragms sinks under its weight as a thin shell",
       "Scordelis & Lo 1964; MacNeal & Harder 1985", true, [] { return roof({20, 40}); }},
  };
}

}  // namespace muslin::app
