// A square metre of cloth hangs by two corners that are 60 cm apart: the static test of Clyde, Teran,
// Tamstorf, Modeling and data-driven parameter estimation for woven fabrics, 2017.
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "verify_fabric.hpp"
#include <fmt/format.h>

namespace muslin::app {
namespace {

constexpr double apart = 0.6;
constexpr int until_rest = 12;  // [s], nearly

/// The angle of an arc of length 1 whose chord is `chord`, by bisection: chord = sin(a/2)/(a/2).
double angle_of_arc(double chord) {
  double low = 0.1, high = 2 * std::numbers::pi;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (std::sin(middle / 2) / (middle / 2) > chord ? low : high) = middle;
  }
  return low;
}

struct Hanging {
  double lowest;  ///< below the corners [m]
  double middle;  ///< the middle of the upper edge, below the corners [m]
  double pull;    ///< of both pins together, over the weight
  double uneven;  ///< difference of what the pins carry, over the weight
};

Hanging hang_by_corners(const std::string& material, int cells) {
  const Experiment experiment;
  const FabricMesh of{"crossed", cells};
  // y of the strip points down; the start is a part of a cylinder, without stretch.
  const double angle = angle_of_arc(apart);
  const Mesh mesh = bent_strip(of, 1, false, [&](const Vec3& p) {
    const double a = angle * (p.x() - 0.5);
    return Vec3(std::sin(a) / angle, -p.y(), (std::cos(a) - std::cos(angle / 2)) / angle);
  });
  experiment.mesh("sheet.obj", mesh);
  experiment.mesh("flat.obj", bent_strip(of, 1, false, [](const Vec3& p) { return p; }));
  const auto pin = [](const char* name, double x) {
    return fmt::format("[[pin]]\nname = \"{}\"\nwhere = {{ nearest = [{:.17g}, 0, 0] }}\n", name, x);
  };
  const std::string scene =
      fmt::format(
          "[[body]]\nmesh = \"sheet.obj\"\nrest_mesh = \"flat.obj\"\nmodel = \"shell\"\n"
          "warp = [1, 0, 0]\nmaterial = {{ base = \"{}\", mass_damping = 1.5 }}\n"
          "[[force]]\ntype = \"gravity\"\n",
          material) +
      pin("left", -apart / 2) + pin("right", apart / 2);
  Simulation simulation = experiment.start(scene);
  advance(simulation, 24 * until_rest);
  const auto& x = simulation.state().positions;
  Hanging result{0, 0, 0, 0};
  double weight = 0;
  for (std::size_t v = 0; v < x.size(); ++v) {
    weight += gravity * simulation.model().masses[v];
    result.lowest = std::max(result.lowest, -x[v].y());
    const Vec3& start = mesh.positions[v];
    if (start.y() == 0 && std::abs(start.x()) < 1e-9) result.middle = -x[v].y();
  }
  const double left = simulation.pin_force("left").sum.y(), right = simulation.pin_force("right").sum.y();
  result.pull = (left + right) / weight;
  result.uneven = (left - right) / weight;
  return result;
}

/// The folds between the corners are not symmetric, and a drop may fold either way.
std::vector<Comparison> two_corners() {
  const Hanging coarse = hang_by_corners("denim", 10), fine = hang_by_corners("denim", 20);
  std::vector<Comparison> numbers = {
      {"lowest point, squares of 10 cm, of 5 cm [m]", fine.lowest, coarse.lowest, 0.02},
      {"middle of the upper edge, likewise [m]", fine.middle, coarse.middle, 0.05}};
  for (const auto& [h, size] : {std::pair{coarse, 10}, {fine, 5}}) {
    numbers.push_back({fmt::format("pull of both pins over the weight, {} cm", size), 1, h.pull, 5e-3});
    numbers.push_back(
        {fmt::format("difference of both pins over it, {} cm", size), 0, h.uneven, 0.02, false});
  }
  return numbers;
}

}  // namespace

std::vector<VerifyCase> fabric_hanging_cases() {
  return {{"two-corners",
           "cloth hangs by two corners: the pins carry its weight, and it hangs alike at two resolutions",
           "statics; the finest mesh", true, two_corners}};
}

}  // namespace muslin::app
