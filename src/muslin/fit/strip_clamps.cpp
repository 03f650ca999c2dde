#include "muslin/fit/strip_clamps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "muslin/energy/stress_curve.hpp"
#include "muslin/geometry/mesh.hpp"
#include "muslin/material/material.hpp"
#include "muslin/scene/model.hpp"
#include "muslin/scene/scene.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

constexpr double pull = 1e-3;  // strain of the simulated strip
constexpr double kes_width = 0.2, kes_length = 0.05;

/// A step so long that inertia does not matter finds the equilibrium. The material is replaced.
constexpr const char* strip_scene = R"(
[time]
frame_rate = 1e-4
steps_per_frame = 1
duration = 1e4
[solver]
effort = "exact"
[[body]]
name = "strip"
mesh = "strip"
model = "shell"
warp = [1, 0, 0]
material = {{ areal_density = 0.1, membrane_warp = 1000, bending_warp = 1e-5 }}
contact = false
[[pin]]
where = {{ group = "left" }}
[[pin]]
where = {{ group = "right" }}
keyframes = [{{ time = 0 }}, {{ time = 1e4, translate = [{}, 0, 0] }}]
)";

Mesh strip_mesh(double width, double length) {
  constexpr int fewest = 12, most = 48;  // cells of a side
  const double cell = std::min(width, length) / fewest;
  const int columns = std::min(most, static_cast<int>(std::round(length / cell)));
  const int rows = std::min(most, static_cast<int>(std::round(width / cell)));
  Mesh mesh;
  MeshGroup left{"left", {}, {}}, right{"right", {}, {}};
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const int v = static_cast<int>(mesh.positions.size());
      if (i == 0) left.vertices.push_back(v);
      if (i == columns) right.vertices.push_back(v);
      mesh.positions.emplace_back(length * i / columns, 0, width * j / rows);
    }
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int v = j * (columns + 1) + i, w = v + columns + 1;
      mesh.add_face(std::array{v, w, w + 1, v + 1});
    }
  mesh.groups = {left, right};
  return mesh;
}

double slope_at_rest(const Inversion& inversion, const char* modulus, const char* curve) {
  if (const FittedValue* value = find_value(inversion, modulus)) return value->value;
  // The slope of the force is that of the stress.
  return StressCurve(*find_value(inversion, curve)->curve).slope(0);
}

}  // namespace

double held_share(double width, double length, const StripModuli& moduli) {
  Scene scene = parse_scene(fmt::format(fmt::runtime(strip_scene), pull * length), "strip.toml");
  Material& material = scene.bodies.front().material;
  ShellMaterial sheet;
  sheet.areal_density = 0.1;
  sheet.membrane_warp = moduli.along;
  sheet.membrane_weft = moduli.across;
  sheet.membrane_shear = moduli.shear;
  sheet.poisson = moduli.poisson;
  sheet.bending_warp = sheet.bending_weft = sheet.bending_bias = 1e-5;
  material.shell = sheet;
  scene.meshes["strip"] = std::make_shared<const Mesh>(strip_mesh(width, length));
  Simulation simulation(std::make_shared<const Model>(build_model(scene)));
  simulation.advance();
  const double green = pull * (1 + pull / 2);
  const double modulus = 2 * simulation.diagnostics().elastic / (green * green * width * length);
  const double square = moduli.poisson * moduli.poisson;
  return std::clamp((modulus / moduli.along - 1) * (1 - square) / square, 0.0, 1.0);
}

void hold_strips(Measurements& m, const Inversion& inversion) {
  const double poisson = find_value(inversion, "poisson")->value;
  if (poisson <= 0) return;
  const double warp = slope_at_rest(inversion, "membrane_warp", "warp_curve");
  const double weft = slope_at_rest(inversion, "membrane_weft", "weft_curve");
  // The slope of the force over an angle in degrees.
  const FittedValue* shear_modulus = find_value(inversion, "membrane_shear");
  const double shear =
      shear_modulus != nullptr
          ? shear_modulus->value
          : StressCurve(*find_value(inversion, "shear_curve")->curve).slope(0) * 180 / std::numbers::pi;
  const auto share = [&](Thread direction, double width, double length) {
    const bool along_warp = direction == Thread::warp;
    return held_share(width, length, {along_warp ? warp : weft, along_warp ? weft : warp, shear, poisson});
  };
  const TensileTest* before = nullptr;
  for (TensileTest& test : m.tensile) {
    if (test.direction == Thread::bias || !test.width || !test.length) continue;
    const bool same = before != nullptr && before->direction == test.direction &&
                      before->width == test.width && before->length == test.length;
    test.held = same ? before->held : share(test.direction, *test.width, *test.length);
    before = &test;
  }
  if (!m.kes) return;
  if (m.kes->warp && m.kes->warp->extension) m.kes->warp->held = share(Thread::warp, kes_width, kes_length);
  if (m.kes->weft && m.kes->weft->extension) m.kes->weft->held = share(Thread::weft, kes_width, kes_length);
}

}  // namespace muslin
