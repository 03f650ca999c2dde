// Fabrics swing with the period of a chain and the decay of the integrator.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "verify_fabric.hpp"
#include <Eigen/Dense>
#include <fmt/format.h>

namespace muslin::app {
namespace {

struct Oscillation {
  double frequency;  ///< [rad/s]
  double decay;      ///< factor of the amplitude in a step
};

/// The oscillation whose steps are nearest to amplitudes at equal intervals: they obey
/// a_{n+1} = 2 r cos(ω dt) a_n − r² a_{n−1}.
Oscillation fit(const std::vector<double>& amplitudes, double step) {
  const auto count = static_cast<Eigen::Index>(amplitudes.size()) - 2;
  Eigen::MatrixX2d before(count, 2);
  Eigen::VectorXd after(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto at = [&](Eigen::Index k) { return amplitudes[static_cast<std::size_t>(k)]; };
    before.row(i) << at(i + 1), -at(i);
    after[i] = at(i + 2);
  }
  const Eigen::Vector2d factors = before.colPivHouseholderQr().solve(after);
  const double decay = std::sqrt(factors[1]);
  return {std::acos(factors[0] / (2 * decay)) / step, decay};
}

/// A sheet that hangs from its upper edge swings in its first mode J₀(j √(s/L)), s from the lower edge, with
/// ω = ½ j √(g/L), j = 2.4048. Implicit Euler turns the phase of an oscillator by atan(ω dt) in a step and
/// its amplitude by 1/√(1 + ω² dt²).
std::vector<Comparison> swing(std::initializer_list<int> cells) {
  const double j = 2.404825557695773, rate = j / 2 * std::sqrt(gravity);
  const double step = 2 * std::numbers::pi / rate / 50;
  std::vector<Comparison> numbers;
  for (const FabricMesh& of : fabric_meshes(cells)) {
    const Experiment experiment;
    const FabricSheet sheet(experiment, of, fabric_width, false);
    // x points down. The rigidity is a hundred-thousandth of ρ g L³: the sheet is a chain.
    Simulation simulation = experiment.start(
        fmt::format("[time]\nframe_rate = {:.17g}\nsteps_per_frame = 1\n[solver]\ntolerance = 1e-4\n",
                    1 / step) +
        fabric_body(1e-5 * fabric_density * gravity, 0, 3e-4) + fabric_pin(0, 0, 1e-9, fabric_width) +
        fmt::format("[[force]]\ntype = \"gravity\"\nacceleration = [{}, 0, 0]\n"
                    "[[force]]\ntype = \"gravity\"\nacceleration = [0, 0, 0.05]\nuntil = {:.17g}\n",
                    gravity, 10.5 * step));
    std::vector<double> mode;
    mode.reserve(sheet.mesh.positions.size());
    for (const Vec3& p : sheet.mesh.positions)
      mode.push_back(std::cyl_bessel_j(0, j * std::sqrt(std::max(0.0, 1 - p.x()))));
    advance(simulation, 12);
    std::vector<double> amplitudes;
    for (int i = 0; i < 50; ++i) {
      double sum = 0;
      for (std::size_t v = 0; v < mode.size(); ++v)
        sum += simulation.model().masses[v] * mode[v] * simulation.state().positions[v].z();
      amplitudes.push_back(sum);
      advance(simulation, 1);
    }
    const Oscillation found = fit(amplitudes, step);
    // A step that does not converge is halved, and the next ones too.
    const int parts = simulation.diagnostics().steps;
    const double turn = rate * step / parts;
    numbers.push_back(
        of.compare("period over 2 pi / w", turn / std::atan(turn), rate / found.frequency, 0.1));
    numbers.push_back(of.compare("amplitude lost in a fiftieth of it",
                                 1 - std::pow(1 + turn * turn, -parts / 2.0), 1 - found.decay, 0.1));
  }
  return numbers;
}

}  // namespace

std::vector<VerifyCase> fabric_motion_cases() {
  const std::string chain = "Daniel Bernoulli's chain; discrete equation of an oscillator";
  return {
      {"fabric-swing", "a hanging sheet swings with the period and decay of implicit Euler, on any mesh",
       chain, false, [] { return swing({10}); }},
      {"fabric-swing-fine", "a hanging sheet swings as a chain, on finer meshes", chain, true,
       [] { return swing({20, 40}); }},
  };
}

}  // namespace muslin::app
