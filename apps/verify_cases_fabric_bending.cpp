// Fabrics bend, twist and buckle as plates do, on any triangulation: cantilever, torsion, bending with twist,
// lateral buckling.
#include <array>
#include <cmath>
#include <numbers>

#include "verify_fabric.hpp"
#include <fmt/format.h>

namespace muslin::app {
namespace {

struct Elastica {
  double reach, drop;  ///< of the tip, in lengths
};

/// The heavy elastica: θ'' = −Γ t cos θ over the length t from the tip with θ'(0) = 0; the angle at the tip
/// is such that θ(1) = 0 at the clamp. Classical Runge-Kutta, in the angle, its slope, reach and drop.
Elastica heavy_elastica(double load) {
  using Values = std::array<double, 4>;
  const auto from_tip = [&](double tip_angle) {
    constexpr int steps = 2000;
    const double h = 1.0 / steps;
    const auto slope = [&](double t, const Values& y) {
      return Values{y[1], -load * t * std::cos(y[0]), std::cos(y[0]), std::sin(y[0])};
    };
    const auto moved = [](const Values& y, double by, const Values& s) {
      return Values{y[0] + by * s[0], y[1] + by * s[1], y[2] + by * s[2], y[3] + by * s[3]};
    };
    Values y{tip_angle, 0, 0, 0};
    for (int i = 0; i < steps; ++i) {
      const double t = i * h;
      const Values a = slope(t, y), b = slope(t + h / 2, moved(y, h / 2, a)),
                   c = slope(t + h / 2, moved(y, h / 2, b)), d = slope(t + h, moved(y, h, c));
      for (std::size_t k = 0; k < 4; ++k) y[k] += h / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]);
    }
    return y;
  };
  double low = 0, high = std::numbers::pi / 2;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (from_tip(middle)[0] < 0 ? low : high) = middle;
  }
  const Values y = from_tip(low);
  return {y[2], y[3]};
}

std::string gravity_along(const Vec3& direction) {
  const Vec3 g = gravity * direction;
  return fmt::format("[[force]]\ntype = \"gravity\"\nacceleration = [{:.17g}, {:.17g}, {:.17g}]\n", g.x(),
                     g.y(), g.z());
}

double rigidity_for(double load) { return fabric_density * gravity / load; }

/// Drop over reach of the tip of a level strip, Γ = ρ g L³/D.
double drop_over_reach(const FabricMesh& of, double load) {
  const Experiment experiment;
  const FabricSheet sheet(experiment, of, fabric_width, true);
  Simulation simulation =
      experiment.start(static_solve(1e-4) + fabric_body(rigidity_for(load), 0, fabric_thickness) +
                       fabric_pin(-1, 0, 0, fabric_width) + gravity_along(-Vec3::UnitZ()));
  advance(simulation, 1);
  const Vec3 tip = sheet.mean(simulation, {{1, 0, 0}, {1, fabric_width, 0}});
  return -tip.z() / tip.x();
}

std::vector<Comparison> cantilever(std::initializer_list<int> cells, const std::vector<double>& loads) {
  std::vector<Comparison> numbers;
  for (const FabricMesh& of : fabric_meshes(cells)) {
    for (const double load : loads) {
      const Elastica exact = heavy_elastica(load);
      numbers.push_back(of.compare(fmt::format("drop over reach, load {}", load), exact.drop / exact.reach,
                                   drop_over_reach(of, load)));
    }
  }
  return numbers;
}

/// The energy of a strip of length L, width w whose ends are turned by φ against each other:
/// D (1 − ν) w φ²/L.
std::vector<Comparison> torsion(std::initializer_list<int> cells) {
  const double poisson = 0.3, rigidity = 1e-3, angle = 0.01;
  std::vector<Comparison> numbers;
  for (const FabricMesh& of : fabric_meshes(cells)) {
    const Experiment experiment;
    const FabricSheet sheet(experiment, of, fabric_width, false);
    const std::string turn =
        fmt::format("keyframes = [{{ time = 0 }}, {{ time = 1e4, rotate = [{:.17g}, 0, 0] }}]",
                    angle * 180 / std::numbers::pi);
    Simulation simulation = experiment.start(
        static_solve(1e-6) + fabric_body(rigidity, poisson, fabric_thickness) +
        fabric_pin(0, 0, 1e-9, fabric_width) + fabric_pin(1 - 1e-9, 0, 1, fabric_width, turn));
    advance(simulation, 1);
    numbers.push_back(of.compare(
        "energy over D (1 - nu) w phi^2 / L", 1,
        simulation.diagnostics().elastic / (rigidity * (1 - poisson) * fabric_width * angle * angle), 0.1));
  }
  return numbers;
}

/// A level strip with threads at 30° to it, D along warp and D/4 along weft, 0.2 D against twisting, ν = 0.3,
/// that bends under a small load Γ also twists. By the plate of Morley's element, extrapolated
/// (tests/energy/plate_test), its end deflects by 0.187701 Γ and turns by 0.0717044 Γ.
std::vector<Comparison> bend_twist(std::initializer_list<int> cells) {
  const double load = 1e-3, rigidity = rigidity_for(load), angle = std::numbers::pi / 6;
  const std::string body = fmt::format(
      "[[body]]\nmesh = \"sheet.obj\"\nmodel = \"shell\"\nwarp = [{:.17g}, {:.17g}, 0]\n"
      "material = {{ areal_density = {}, membrane_warp = {:.17g}, bending_warp = {:.17g}, "
      "bending_weft = {:.17g}, bending_bias = {:.17g}, poisson = 0.3 }}\n",
      std::cos(angle), std::sin(angle), fabric_density, 12 * rigidity / std::pow(fabric_thickness, 2),
      rigidity, rigidity / 4, 0.5875 * rigidity);
  std::vector<Comparison> numbers;
  for (const FabricMesh& of : fabric_meshes(cells)) {
    const Experiment experiment;
    const FabricSheet sheet(experiment, of, fabric_width, true);
    Simulation simulation = experiment.start(static_solve(1e-6) + body + fabric_pin(-1, 0, 0, fabric_width) +
                                             gravity_along(-Vec3::UnitZ()));
    advance(simulation, 1);
    const double left = -sheet.mean(simulation, {{1, 0, 0}}).z(),
                 right = -sheet.mean(simulation, {{1, fabric_width, 0}}).z();
    numbers.push_back(of.compare("deflection of the end over the load", 0.187701, (left + right) / 2 / load));
    numbers.push_back(of.compare("its twist over the load", 0.0717044, (left - right) / fabric_width / load));
  }
  return numbers;
}

/// The load Γ at which a strip on edge buckles, by Southwell's method: under a slight load across, the tip's
/// deflection over it grows as 1/(1 − Γ²/Γc²), so that its inverse falls to zero, linear in Γ² near Γc. Two
/// loads give an estimate, a third one close to it the result.
double lateral_buckling(const FabricMesh& of, double expected) {
  const Experiment experiment;
  const FabricSheet sheet(experiment, of, fabric_width, true);
  const auto stiffness = [&](double load) {
    const double across = 1e-4;
    Simulation simulation =
        experiment.start(static_solve(1e-6) + fabric_body(rigidity_for(load), 0.25, fabric_thickness) +
                         fabric_pin(-1, 0, 0, fabric_width) + gravity_along({0, -1, across}));
    advance(simulation, 1);
    return load * across / sheet.mean(simulation, {{1, 0, 0}, {1, fabric_width, 0}}).z();
  };
  const auto zero = [](double a, double at_a, double b, double at_b) {
    return std::sqrt(b * b + at_b * (b * b - a * a) / (at_a - at_b));
  };
  const double a = 0.8 * expected, b = 0.9 * expected;
  const double at_b = stiffness(b), c = 0.98 * zero(a, stiffness(a), b, at_b);
  return zero(b, at_b, c, stiffness(c));
}

std::vector<Comparison> buckling(std::initializer_list<int> cells) {
  // That of a plate four times as long as wide, ν = ¼, by Morley's element, extrapolated
  // (tests/energy/plate_test). A strip without width has 12.854 √(2/(1+ν)) (1−ν²) = 15.24.
  const double expected = 18.457;
  std::vector<Comparison> numbers;
  for (const FabricMesh& of : fabric_meshes(cells))
    numbers.push_back(
        of.compare("load that buckles, rho g L^3 / D", expected, lateral_buckling(of, expected)));
  return numbers;
}

}  // namespace

std::vector<VerifyCase> fabric_bending_cases() {
  const std::string romero = "shooting; cantilever of Romero et al. 2021";
  const std::string plate = "plate theory",
                    morley = "Morley's element; lateral buckling of Romero et al. 2021";
  return {
      {"fabric-cantilever", "a level strip bends as the heavy elastica, on any mesh", romero, false,
       [] { return cantilever({10}, {5}); }},
      {"fabric-cantilever-fine", "a level strip bends as the heavy elastica, on finer meshes", romero, true,
       [] { return cantilever({20, 40}, {5}); }},
      {"fabric-cantilever-curve", "a level strip bends as the heavy elastica from small to large loads",
       romero, true, [] { return cantilever({20}, {1, 2, 10, 20, 50}); }},
      {"fabric-torsion", "a strip resists twisting as a plate, on any mesh", plate, false,
       [] { return torsion({10}); }},
      {"fabric-torsion-fine", "a strip resists twisting as a plate, on finer meshes", plate, true,
       [] { return torsion({20, 40}); }},
      {"fabric-bend-twist", "a strip with oblique threads twists as it bends, as a plate, on any mesh",
       "Morley's element", false, [] { return bend_twist({10}); }},
      {"fabric-bend-twist-fine", "a strip with oblique threads twists as it bends, on finer meshes",
       "Morley's element", true, [] { return bend_twist({20, 40}); }},
      {"fabric-buckling", "a strip on edge buckles as a plate, on any mesh", morley, false,
       [] { return buckling({10}); }},
      {"fabric-buckling-fine", "a strip on edge buckles as a plate, on finer meshes", morley, true,
       [] { return buckling({20, 40}); }},
  };
}

}  // namespace muslin::app
