// Bending: stiffness by number of layers, large deflection, vibration.
#include <array>
#include <cmath>

#include "verify_case.hpp"
#include "verify_experiment.hpp"
#include <fmt/format.h>

namespace muslin::app {
namespace {

/// A strip clamped at x = 0, level, of voxels 1 m wide; isotropic springs (edge and face diagonal alike).
struct Strip {
  int length, layers, width;
  double modulus = 1e6;  ///< of the springs [N/m2]
  double density = 100;

  double youngs() const { return 2.5 * modulus; }
  double weight_per_length(double gravity) const { return density * gravity * layers * width; }
  /// Second moment of area of a solid strip [m4].
  double second_moment() const { return width * std::pow(layers, 3) / 12; }

  std::string body() const {
    return fmt::format(R"(
[[body]]
mesh = "strip.obj"
voxel_width = 1
bracing = "full"
boundary_springs = "shared"
material = {{ density = {}, edge_modulus = {}, face_diagonal_modulus = {} }}
[[pin]]
where = {{ plane = {{ point = [0, 0, 0], normal = [1, 0, 0], distance = 0.01 }} }}
)",
                       density, modulus, modulus);
  }
  Vec3 size() const { return {double(length), double(layers), double(width)}; }

  /// Centre of section i of the strip [m].
  Vec3 centre(const Simulation& simulation, int i) const {
    Vec3 sum = Vec3::Zero();
    for (int j = 0; j <= layers; ++j)
      for (int k = 0; k <= width; ++k) sum += position(simulation, i, j, k);
    return sum / ((layers + 1) * (width + 1));
  }
  double drop(const Simulation& simulation, int i) const { return layers / 2.0 - centre(simulation, i).y(); }
};

std::string downward(double acceleration) {
  return fmt::format("[[force]]\ntype = \"gravity\"\nacceleration = [0, {:.17g}, 0]\n", -acceleration);
}

/// The strip's bending rigidity [N m2], from how its middle half curves under a small weight: the second
/// difference of the deflection q (s^4 - 4 L s^3 + 6 L^2 s^2) / (24 D), which the clamp does not reach.
double measured_rigidity(const Experiment& experiment, const Strip& strip) {
  const double length = strip.length;
  const double slight =
      1e-4 * strip.youngs() * strip.second_moment() / (strip.weight_per_length(1) * std::pow(length, 3));
  Simulation simulation = experiment.start(static_solve(1e-9) + strip.body() + downward(slight));
  advance(simulation, 2);
  const int a = strip.length / 4, b = strip.length / 2, c = 3 * strip.length / 4;
  const auto shape = [&](double s) { return s * s * (s * s - 4 * length * s + 6 * length * length) / 24; };
  const double bent = strip.drop(simulation, a) - 2 * strip.drop(simulation, b) + strip.drop(simulation, c);
  return strip.weight_per_length(slight) * (shape(a) - 2 * shape(b) + shape(c)) / bent;
}

/// The strip's rigidity over E I of a solid one. Per unit of width and of k h^3, the layers of vertices and
/// the gaps between them (where the strain across relaxes) add up to the plate rigidities D11 and D12; a
/// strip with free edges curves freely across. docs/theory/lattice-moduli.md.
double layered_rigidity(int n) {
  const double layers = (std::pow(n, 3) + 2 * n) / 12, gaps = (std::pow(n, 3) - n) / 12;
  const double d11 = 2 * layers + 2 * gaps / 3, d12 = layers - gaps / 3;
  return (d11 - d12 * d12 / d11) / (2.5 * std::pow(n, 3) / 12);
}

std::vector<Comparison> layers() {
  std::vector<Comparison> numbers;
  for (const int n : {1, 2, 4}) {
    const Strip strip{n > 2 ? 48 : 24, n, 8};
    const Experiment experiment;
    experiment.box("strip.obj", strip.size());
    const double solid = strip.youngs() * strip.second_moment();
    numbers.push_back({fmt::format("rigidity over that of a solid, {} layer{}", n, n > 1 ? "s" : ""),
                       layered_rigidity(n), measured_rigidity(experiment, strip) / solid, 0.02});
  }
  return numbers;
}

std::vector<Comparison> elastica() {
  const Strip strip{48, 1, 1};
  const Experiment experiment;
  experiment.box("strip.obj", strip.size());
  const double rigidity = measured_rigidity(experiment, strip);
  std::vector<Comparison> numbers;
  // Drop of the tip over its reach, H/W.
  for (const auto& [load, ratio] : {std::pair{1.0, 0.1245617664}, {10.0, 1.0668023204}}) {
    const double full = load * rigidity / (strip.weight_per_length(1) * std::pow(strip.length, 3));
    Simulation simulation = experiment.start(static_solve(1e-6) + strip.body() +
                                             fmt::format(R"(
[[force]]
type = "gravity"
keyframes = [{{ time = 0, value = [0, 0, 0] }}, {{ time = 1e5, value = [0, {:.17g}, 0] }}]
)",
                                                         -full));
    advance(simulation, 12);
    const Vec3 tip = strip.centre(simulation, strip.length);
    numbers.push_back(
        {fmt::format("tip drop over reach, load {:.0f}", load), ratio, (0.5 - tip.y()) / tip.x(), 0.01});
  }
  return numbers;
}

std::vector<Comparison> vibration() {
  const Strip strip{32, 1, 1};
  const Experiment experiment;
  experiment.box("strip.obj", strip.size());
  const double length = strip.length, beta = 1.875104;  // beta^2 = 3.516
  const double mass = strip.weight_per_length(1);
  const double expected =
      beta * beta * std::sqrt(measured_rigidity(experiment, strip) / (mass * std::pow(length, 4)));
  const double step = 2 * 3.14159265358979 / expected / 200;
  Simulation simulation = experiment.start(
      fmt::format("[time]\nframe_rate = {:.17g}\nsteps_per_frame = 1\n[solver]\nintegrator = "
                  "\"bdf2\"\ntolerance = 1e-6\n",
                  1 / step) +
      strip.body() + "[[force]]\ntype = \"gravity\"\nacceleration = [0, -1e-3, 0]\nuntil = " +
      fmt::format("{:.17g}\n", 20 * step));
  // Projected on the first mode shape, which is orthogonal to the others.
  const double sigma = (std::cosh(beta) + std::cos(beta)) / (std::sinh(beta) + std::sin(beta));
  const auto amplitude = [&] {
    double sum = 0;
    for (int i = 1; i <= strip.length; ++i) {
      const double s = beta * i / length;
      const double mode = std::cosh(s) - std::cos(s) - sigma * (std::sinh(s) - std::sin(s));
      sum += mode * strip.drop(simulation, i) * (i < strip.length ? 1.0 : 0.5);
    }
    return sum;
  };
  advance(simulation, 20);
  std::vector<double> crossings;
  double before = amplitude();
  for (int frame = 0; frame < 900 && crossings.size() < 7; ++frame) {
    advance(simulation, 1);
    const double after = amplitude();
    if ((before < 0) != (after < 0))
      crossings.push_back(simulation.diagnostics().time - step * after / (after - before));
    before = after;
  }
  if (crossings.size() < 7) return {{"half swings seen", 7, double(crossings.size()), 0}};
  const double frequency = 3.14159265358979 * 6 / (crossings.back() - crossings.front());
  return {{"first frequency w L^2 sqrt(mass / D)", 3.516, 3.516 * frequency / expected, 0.01}};
}

}  // namespace

std::vector<VerifyCase> bending_cases() {
  return {
      {"layers", "a strip of 1, 2, 4 voxels is stiffer in bending than a solid one, as computed",
       "lattice theory", true, layers},
      {"elastica", "a strip bends under its own weight as the heavy elastica does",
       "shooting; test of Romero et al. 2021", true, elastica},
      {"vibration", "a clamped strip swings with the first frequency of a cantilever", "beam theory", true,
       vibration},
  };
}

}  // namespace muslin::app
