// Shells: a strip that hangs.
#include "verify_case.hpp"
#include "verify_experiment.hpp"
#include <fmt/format.h>

namespace muslin::app {
namespace {

constexpr int cells = 16;  // along either side
constexpr double areal_density = 0.2;

/// A sheet of 1 m by `width` in the plane y = 0 as a shell; vertex i + k (cells + 1).
std::string sheet(double membrane, double bending) {
  return fmt::format(R"(
[[body]]
mesh = "sheet.obj"
model = "shell"
material = {{ areal_density = {}, membrane_warp = {}, poisson = 0, bending_warp = {} }}
[[force]]
type = "gravity"
acceleration = [0, {}, 0]
)",
                     areal_density, membrane, bending, -gravity);
}

/// Mean of row i of vertices.
Vec3 row(const Simulation& simulation, int i) {
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k <= cells; ++k)
    sum += simulation.state().positions[static_cast<std::size_t>(i + k * (cells + 1))];
  return sum / (cells + 1);
}

std::vector<Comparison> hanging_shell() {
  const Experiment experiment;
  experiment.level_sheet("sheet.obj", 1, 0.25, cells);
  const double membrane = 500;
  Simulation simulation =
      experiment.start(static_solve(1e-4) + sheet(membrane, 1e-6) +
                           "[[pin]]\nwhere = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }\n",
                       {"body.0.rotate=[0, 0, -90]"});
  advance(simulation, 2);
  std::vector<Comparison> numbers;
  for (const int i : {4, 8, 12, 16}) {
    const double s = double(i) / cells;
    numbers.push_back({fmt::format("u({:.2f} m) [m]", s),
                       areal_density * gravity * (s - s * s / 2) / membrane, -row(simulation, i).y() - s,
                       1e-2});
  }
  return numbers;
}

}  // namespace

std::vector<VerifyCase> shell_cases() {
  return {
      {"hanging-shell", "a hanging shell stretches by rho g (L s - s2/2) / K", "closed form", false,
       hanging_shell},
  };
}

}  // namespace muslin::app
