// A clamped strip of 7 by 3 squares that is rolled up, and its curvatures.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "support/sheet.hpp"

#include "muslin/component/shell/shell_body.hpp"
#include "muslin/energy/hinge_angles.hpp"
#include "muslin/energy/hinge_coupling.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin::test {

constexpr double strip_edge = 0.01;  // of a square [m]

/// The mesh of the strip, of which x < strip_edge is clamped.
inline std::shared_ptr<Mesh> strip_mesh() {
  return std::make_shared<Mesh>(flat_sheet(7, 3, 7 * strip_edge, 3 * strip_edge));
}

/// The strip in a roll, flat where it is clamped.
inline std::vector<Vec3> rolled_strip(const Model& model, double curvature) {
  std::vector<Vec3> x;
  for (const Vec3& p : model.rest_positions) {
    const double angle = curvature * std::max(0.0, p.x() - strip_edge);
    x.emplace_back(std::min(p.x(), strip_edge) + std::sin(angle) / curvature,
                   (1 - std::cos(angle)) / curvature, p.z());
  }
  return x;
}

/// Least and greatest curvature along the strip [1/m], but for its free end, which begins to move at once.
inline std::pair<double, double> strip_curvatures(const Simulation& simulation) {
  const Model& model = simulation.model();
  const Shell& shell = as_shell(model.bodies[0])->shell;
  std::vector<std::uint8_t> held(model.vertex_count(), 0);
  for (const int v : model.pins[0].vertices) held[static_cast<std::size_t>(v)] = 1;
  const std::vector<double> bent = HingeAngles(shell, nullptr).deviations(simulation.state().positions);
  const PlateCurvatures plate = plate_curvatures(shell, {1, 1, 1, 0}, held);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double least = infinity, greatest = -infinity;
  for (std::size_t t = 0; t < shell.triangles.size(); ++t) {
    const auto x = [&](int c) {
      return model.rest_positions[static_cast<std::size_t>(shell.triangles[t][c])].x();
    };
    const double middle = (x(0) + x(1) + x(2)) / 3;
    if (middle < strip_edge || middle > 4.5 * strip_edge) continue;
    const double curvature = std::abs(plate.of(t, bent)[0]);
    least = std::min(least, curvature);
    greatest = std::max(greatest, curvature);
  }
  return {least, greatest};
}

}  // namespace muslin::test
