// Fabrics stretch and shear as their moduli say, exactly and on any triangulation.
#include <cmath>

#include "verify_fabric.hpp"
#include <Eigen/Dense>
#include <fmt/format.h>

namespace muslin::app {
namespace {

constexpr double warp = 1000, weft = 600, shear = 150, poisson = 0.2;  // of the membrane [N/m]

/// Force per width at rest [N/m] of an orthotropic sheet with the symmetric gradient F: P = F S, where the
/// stress S is linear in ½ (FᵀF − I).
Eigen::Matrix2d traction(const Eigen::Matrix2d& f) {
  const Eigen::Matrix2d strain = (f.transpose() * f - Eigen::Matrix2d::Identity()) / 2;
  const double scale = 1 / (1 - poisson * poisson), coupling = poisson * std::sqrt(warp * weft) * scale;
  Eigen::Matrix2d stress;
  stress(0, 0) = warp * scale * strain(0, 0) + coupling * strain(1, 1);
  stress(1, 1) = weft * scale * strain(1, 1) + coupling * strain(0, 0);
  stress(0, 1) = stress(1, 0) = 2 * shear * strain(0, 1);
  return f * stress;
}

/// Forces on the free side where this coordinate is 1, or its opposite: those of a constant traction [N/m].
/// Two forces at the ends of the side take half a cell each.
std::string side_load(int axis, double at, const Eigen::Vector2d& traction, int cells) {
  std::string forces;
  for (const double inset : {0.0, 0.5 / cells}) {
    Vec3 low(inset, inset, -1), high(1 - inset, 1 - inset, 1);
    low[axis] = high[axis] = at;
    const Eigen::Vector2d share = traction / (2 * cells);
    forces += fmt::format(
        "[[force]]\ntype = \"point\"\nforce = [{:.17g}, {:.17g}, 0]\n"
        "where = {{ box = [[{}, {}, {}], [{}, {}, {}]] }}\n",
        share.x(), share.y(), low.x(), low.y(), low.z(), high.x(), high.y(), high.z());
  }
  return forces;
}

/// Pulls a square at its sides so that it has the constant gradient F; returns the largest distance of a
/// vertex from F X, in sides.
double farthest(const FabricMesh& of, const Eigen::Matrix2d& f) {
  const Experiment experiment;
  const FabricSheet sheet(experiment, of, 1, false);
  const Eigen::Matrix2d p = traction(f);
  std::string scene = static_solve(1e-7) +
                      fmt::format(R"(
[[body]]
mesh = "sheet.obj"
model = "shell"
warp = [1, 0, 0]
[body.material]
areal_density = {}
membrane_warp = {}
membrane_weft = {}
membrane_shear = {}
poisson = {}
bending_warp = 1e-5
)",
                                  fabric_density, warp, weft, shear, poisson) +
                      fabric_pin(0, 0, 0, 0);
  for (const int axis : {0, 1})
    for (const double at : {0.0, 1.0})
      scene += side_load(axis, at, (at > 0 ? 1 : -1) * p.col(axis), of.cells);
  Simulation simulation = experiment.start(scene);
  advance(simulation, 1);
  double farthest = 0;
  for (std::size_t v = 0; v < sheet.mesh.positions.size(); ++v) {
    const Vec3& x = sheet.mesh.positions[v];
    Vec3 expected = Vec3::Zero();
    expected.head<2>() = f * x.head<2>();
    farthest = std::max(farthest, (simulation.state().positions[v] - expected).norm());
  }
  return farthest;
}

std::vector<Comparison> membrane(std::initializer_list<int> cells) {
  // Pulled along warp by a fifth, the sheet narrows until no force acts across.
  const double along = 0.22, narrowing = poisson * std::sqrt(warp / weft) * along;
  Eigen::Matrix2d uniaxial = Eigen::Matrix2d::Identity(), biaxial = uniaxial, sheared = uniaxial;
  uniaxial(0, 0) = 1.2;
  uniaxial(1, 1) = std::sqrt(1 - 2 * narrowing);
  biaxial(0, 0) = 1.1;
  biaxial(1, 1) = 1.05;
  sheared(0, 1) = sheared(1, 0) = 0.1;
  std::vector<Comparison> numbers;
  for (const FabricMesh& of : fabric_meshes(cells)) {
    numbers.push_back({of.label("uniaxial, 20 %, off"), 0, farthest(of, uniaxial), 1e-6, false});
    numbers.push_back({of.label("biaxial, 10 and 5 %, off"), 0, farthest(of, biaxial), 1e-6, false});
    numbers.push_back({of.label("sheared by 11 degrees, off"), 0, farthest(of, sheared), 1e-6, false});
  }
  return numbers;
}

}  // namespace

std::vector<VerifyCase> fabric_membrane_cases() {
  return {
      {"fabric-membrane",
       "pulled along warp, both ways and in shear, a sheet takes its exact shape, on any mesh", "closed form",
       false, [] { return membrane({4, 8}); }},
      {"fabric-membrane-fine", "a pulled sheet takes its exact shape, on finer meshes", "closed form", true,
       [] { return membrane({16}); }},
  };
}

}  // namespace muslin::app
