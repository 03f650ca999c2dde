// Stretching: moduli of the lattice, a bar under its own weight, volume.
#include <array>
#include <cmath>

#include "verify_case.hpp"
#include "verify_experiment.hpp"
#include <fmt/format.h>

namespace muslin::app {
namespace {

/// Springs of a lattice with full bracing and a volume modulus; docs/theory/lattice-moduli.md.
struct Moduli {
  double edge, face_diagonal, body_diagonal, volume;

  double c11() const { return edge + 2 * face_diagonal + 4 * body_diagonal / 3 + volume; }
  double c12() const { return face_diagonal + 4 * body_diagonal / 3 + volume; }
  double youngs() const { return c11() - 2 * c12() * c12() / (c11() + c12()); }
  double poisson() const { return c12() / (c11() + c12()); }
};

/// Pulls a bar of 3 x 3 x 24 voxels at its free end and looks at its middle, far from both ends.
std::vector<Comparison> moduli() {
  const Experiment experiment;
  const double h = 0.1, length = 2.4;
  experiment.box("bar.obj", {length, 3 * h, 3 * h});
  const double force = 0.01;  // on each of 16 vertices [N]
  std::vector<Comparison> numbers;
  for (const auto& [name, m] : {std::pair{"1/1/0", Moduli{1e5, 1e5, 0, 0}},
                                {"3/1/1", Moduli{3e5, 1e5, 1e5, 0}},
                                {"3/1/1 + volume", Moduli{3e5, 1e5, 1e5, 5e5}}}) {
    Simulation simulation =
        experiment.start(static_solve(1e-8) + fmt::format(R"(
[[body]]
mesh = "bar.obj"
voxel_width = {}
bracing = "full"
boundary_springs = "shared"
material = {{ density = 1000, edge_modulus = {}, face_diagonal_modulus = {}, body_diagonal_modulus = {}, volume_modulus = {} }}
[[pin]]
where = {{ plane = {{ point = [0, 0, 0], normal = [1, 0, 0], distance = 0.01 }} }}
[[force]]
type = "point"
where = {{ plane = {{ point = [{}, 0, 0], normal = [1, 0, 0], distance = 0.01 }} }}
force = [{}, 0, 0]
)",
                                                          h, m.edge, m.face_diagonal, m.body_diagonal,
                                                          m.volume, length, force));
    advance(simulation, 2);
    const auto mean = [&](int i, int axis) {
      double sum = 0;
      for (int j = 0; j <= 3; ++j)
        for (int k = 0; k <= 3; ++k) sum += position(simulation, i, j, k)[axis];
      return sum / 16;
    };
    const double along = (mean(16, 0) - mean(8, 0)) / (8 * h) - 1;
    double across = 0;
    for (int k = 0; k <= 3; ++k) {
      across += ((position(simulation, 12, 3, k).y() - position(simulation, 12, 0, k).y()) / (3 * h) - 1) / 4;
    }
    const double stress = 16 * force / (9 * h * h);
    numbers.push_back(
        {fmt::format("Young's modulus [N/m2], springs {}", name), m.youngs(), stress / along, 1e-3});
    numbers.push_back({fmt::format("Poisson's ratio, springs {}", name), m.poisson(), -across / along, 2e-3});
  }
  return numbers;
}

std::vector<Comparison> hanging_bar() {
  const Experiment experiment;
  const int layers = 40;
  const double h = 0.05, length = layers * h, density = 1000, youngs = 1e7, gravity = 9.8;
  experiment.box("bar.obj", {2 * h, length, 2 * h});
  Simulation simulation = experiment.start(static_solve(1e-7) + fmt::format(R"(
[[body]]
mesh = "bar.obj"
voxel_width = {}
bracing = "full"
boundary_springs = "shared"
material = {{ density = {}, youngs_modulus = {} }}
[[pin]]
where = {{ plane = {{ point = [0, {}, 0], normal = [0, 1, 0], distance = 0.01 }} }}
[[force]]
type = "gravity"
)",
                                                                            h, density, youngs, length));
  advance(simulation, 2);
  // Downward displacement of the section s below the held end, on the axis of the bar.
  const auto sunk = [&](int layer) { return h * layer - position(simulation, 1, layer, 1).y(); };
  const auto theory = [&](double s) { return density * gravity * (length * s - s * s / 2) / youngs; };
  std::vector<Comparison> numbers;
  numbers.push_back({"lengthening [m]", theory(length), sunk(0), 1e-2});
  // The held end cannot contract, which makes it a little stiffer: the profile is taken from one width below.
  const int first = layers - 2;
  for (const int layer : {30, 20, 10, 0}) {
    const double s = (layers - layer) * h;
    numbers.push_back({fmt::format("u({:.1f} m) - u(0.1 m) [m]", s), theory(s) - theory(0.1),
                       sunk(layer) - sunk(first), 2e-3});
  }
  return numbers;
}

std::vector<Comparison> volume() {
  const Experiment experiment;
  experiment.box("block.obj", {0.8, 0.4, 0.4});
  std::vector<Comparison> numbers;
  for (const auto& [modulus, tolerance] : {std::pair{0.0, 0.12}, {1e6, 0.015}, {1e7, 0.003}}) {
    Simulation simulation = experiment.start(fmt::format(R"(
[time]
frame_rate = 10
steps_per_frame = 1
[[body]]
mesh = "block.obj"
voxel_width = 0.1
bracing = "full"
boundary_springs = "shared"
material = {{ density = 1000, youngs_modulus = 1e5, volume_modulus = {} }}
[[pin]]
where = {{ plane = {{ point = [0, 0, 0], normal = [1, 0, 0] }} }}
[[pin]]
where = {{ plane = {{ point = [0.8, 0, 0], normal = [1, 0, 0] }} }}
keyframes = [{{ time = 0 }}, {{ time = 1, translate = [0.16, 0, 0] }}]
)",
                                                         modulus));
    advance(simulation, 20);
    const std::vector<Vec3>& x = simulation.state().positions;
    double sum = 0;
    for (const auto& tet : build_tetrahedra(as_lattice(simulation.model().bodies.front())->lattice)) {
      const auto corner = [&](int i) {
        return x[static_cast<std::size_t>(tet[static_cast<std::size_t>(i)])];
      };
      sum += (corner(1) - corner(0)).dot((corner(2) - corner(0)).cross(corner(3) - corner(0))) / 6;
    }
    numbers.push_back({fmt::format("change at 20 % stretch, {:.0f} E", modulus / 1e5), 0, sum / 0.128 - 1,
                       tolerance, false});
  }
  return numbers;
}

}  // namespace

std::vector<VerifyCase> elasticity_cases() {
  return {
      {"moduli", "a pulled bar has the moduli that follow from its springs",
       "lattice theory (Born, Huang 1954)", false, moduli},
      {"hanging-bar", "a bar stretches under its own weight by rho g L^2 / (2 E)", "closed form", false,
       hanging_bar},
      {"volume", "a stretched block keeps its volume as the volume modulus grows", "conservation", false,
       volume},
  };
}

}  // namespace muslin::app
