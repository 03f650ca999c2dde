// A clamped strip that is pushed against a floor sticks until friction cannot bear the force across: the
// stick-slip test of Romero et al. 2021.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "verify_fabric.hpp"
#include <fmt/format.h>

namespace muslin::app {
namespace {

constexpr double soft_thickness = 1.0 / 32;                                   // of the length
constexpr double stretch_stiffness = 12 / (soft_thickness * soft_thickness);  // K L²/D
constexpr double contact_distance = 5e-4;    // of the length

/// A strip of length 1 clamped at x = 0 along x, bent, whose tip is held on the x axis and free to turn.
class PinnedElastica {
 public:
  /// The strip's tip turns by this angle. The forces N along and T across, over EI/L², solve
  ///
  ///   θ'' = λ (T cos θ − N sin θ),  x' = λ cos θ,  y' = λ sin θ,  λ = 1 − (N cos θ + T sin θ)/K
  ///
  /// over the length at rest from the tip, where θ' = 0, to the clamp, where θ = 0, on the axis; K compresses
  /// the strip. Shooting with Newton's method.
  explicit PinnedElastica(double tip_angle) : across_(0.178 * buckling * tip_angle) {
    for (int i = 0; i < 30; ++i) {
      const double small = 1e-5;
      integrate(tip_angle);
      const double angle = angle_, off = points_.back().y();
      along_ += small;
      integrate(tip_angle);
      const double angle_n = (angle_ - angle) / small, off_n = (points_.back().y() - off) / small;
      along_ -= small;
      across_ += small;
      integrate(tip_angle);
      const double angle_t = (angle_ - angle) / small, off_t = (points_.back().y() - off) / small;
      across_ -= small;
      const double determinant = angle_n * off_t - angle_t * off_n;
      along_ -= (off_t * angle - angle_t * off) / determinant;
      across_ -= (angle_n * off - off_n * angle) / determinant;
      if (std::abs(angle) + std::abs(off) < 1e-12) break;
    }
    integrate(tip_angle);
  }

  /// Way of the tip towards the clamp, in lengths.
  double shortening() const { return 1 - points_.back().x(); }
  /// The coefficient of friction at which the tip begins to slip, T/N.
  double friction() const { return across_ / along_; }
  /// Position at the length s from the clamp; straight before it.
  Vec3 at(double s) const {
    if (s <= 0) return {s, 0, 0};
    const double u = (1 - s) * steps;
    const auto i = std::min(static_cast<std::size_t>(u), points_.size() - 2);
    const Vec3 p = points_[i] + (u - static_cast<double>(i)) * (points_[i + 1] - points_[i]);
    return {points_.back().x() - p.x(), points_.back().y() - p.y(), 0};
  }

 private:
  void integrate(double tip_angle) {
    using Values = std::array<double, 4>;  // angle, its slope, x and y, from the tip
    const auto slope = [&](const Values& y) {
      const double cosine = std::cos(y[0]), sine = std::sin(y[0]);
      const double length = 1 - (along_ * cosine + across_ * sine) / stretch_stiffness;
      return Values{y[1], length * (across_ * cosine - along_ * sine), length * cosine, length * sine};
    };
    const auto moved = [](const Values& y, double by, const Values& s) {
      return Values{y[0] + by * s[0], y[1] + by * s[1], y[2] + by * s[2], y[3] + by * s[3]};
    };
    const double h = 1.0 / steps;
    Values y{tip_angle, 0, 0, 0};
    points_ = {Vec3::Zero()};
    for (int i = 0; i < steps; ++i) {
      const Values a = slope(y), b = slope(moved(y, h / 2, a)), c = slope(moved(y, h / 2, b)),
                   d = slope(moved(y, h, c));
      for (std::size_t k = 0; k < 4; ++k) y[k] += h / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]);
      points_.emplace_back(y[2], y[3], 0);
    }
    angle_ = y[0];
  }

  static constexpr int steps = 400;
  static constexpr double buckling = 20.19;  // the force of a straight strip that buckles
  double along_ = buckling, across_;
  double angle_ = 0;          ///< at the clamp
  std::vector<Vec3> points_;  ///< from the tip
};

/// The strip that begins to slip at this coefficient of friction, by bisection.
PinnedElastica about_to_slip(double friction) {
  double low = 0.01, high = 1.5;
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2;
    (PinnedElastica(middle).friction() < friction ? low : high) = middle;
  }
  return PinnedElastica(low);
}

struct Slip {
  double onset;  ///< T/N halfway between the last push at which the strip sticks and the next one
  double early;  ///< way of its tip before, at the last push at which T/N is below 0.96 of the limit
};

/// Pushes a strip against a floor, from one push to the next in one step without inertia and another one of
/// rest, until it slips by more than a hundredth of its length. T/N grows with the push.
Slip push_until_slip(const FabricMesh& of, double friction) {
  const double rigidity = 1e-3, frame_rate = 0.02;  // a step is twelve times 1/ω of the strip
  const int frames = 2;
  const std::vector<double> shares = {0.9, 0.95, 0.98, 0.99, 1, 1.01, 1.02, 1.03};
  const PinnedElastica start = about_to_slip(0.8 * friction);
  const Experiment experiment;
  experiment.mesh("sheet.obj", bent_strip(of, fabric_width, true, [&](const Vec3& p) {
                    return Vec3(start.at(p.x()) + p.y() * Vec3::UnitZ());
                  }));
  const Mesh flat = bent_strip(of, fabric_width, true, [](const Vec3& p) { return p; });
  experiment.mesh("flat.obj", flat);
  std::string push = "keyframes = [{ time = 0 }";
  double time = 0;
  for (const double share : shares) {
    const double by = about_to_slip(share * friction).shortening() - start.shortening();
    for (int i = 0; i < frames; ++i)
      push += fmt::format(", {{ time = {:.17g}, translate = [{:.17g}, 0, 0] }}", time += 1 / frame_rate, by);
  }
  // The strip starts where contact begins: thrown onto or off the floor in the first iterations of a step, in
  // which friction is taken, it would slip.
  Simulation simulation = experiment.start(
      fmt::format("[time]\nframe_rate = {}\nsteps_per_frame = 1\nduration = 1e4\n"
                  "[solver]\neffort = \"exact\"\ntolerance = 1e-5\n"
                  "[contact]\nfriction = {}\ndistance = {}\n"
                  "[[collider]]\nshape = \"plane\"\ncenter = [{:.17g}, 0, 0]\nnormal = [-1, 0, 0]\n",
                  frame_rate, friction, contact_distance, start.at(1).x() + contact_distance) +
      fabric_body(rigidity, 0, soft_thickness) +
      "rest_mesh = \"flat.obj\"\nthickness = 1e-6\nself_contact = false\n" +
      "[[pin]]\nwhere = { box = [[-1, -1, -1], [1e-9, 1, 1]] }\n" + push + "]\n");
  Slip slip{0, 0};
  double stuck = 0;
  for (const double share : shares) {
    advance(simulation, frames);
    double way = 0;
    for (std::size_t v = 0; v < flat.positions.size(); ++v)
      if (flat.positions[v].x() > 1 - 1e-9)
        way = std::max(way, std::abs(simulation.state().positions[v].y()));
    slip.onset = (stuck + share) / 2 * friction;
    if (way > 0.01) return slip;
    if (share < 0.96) slip.early = way;
    stuck = share;
  }
  return slip;
}

std::vector<Comparison> stick_slip(std::initializer_list<int> cells, const std::vector<double>& frictions) {
  std::vector<Comparison> numbers;
  for (const FabricMesh& of : fabric_meshes(cells)) {
    for (const double friction : frictions) {
      const Slip slip = push_until_slip(of, friction);
      numbers.push_back(
          {of.label(fmt::format("T/N where it slips, friction {}", friction)), friction, slip.onset, 0.02});
      numbers.push_back({of.label(fmt::format("way before, in lengths, friction {}", friction)), 0,
                         slip.early, contact_distance, false});
    }
  }
  return numbers;
}

}  // namespace

std::vector<VerifyCase> fabric_stick_slip_cases() {
  const std::string source = "shooting; stick-slip of Romero et al. 2021";
  return {
      {"fabric-stick-slip", "a clamped strip pushed against a floor sticks until T = mu N, on any mesh",
       source, true, [] { return stick_slip({10, 20}, {0.1}); }},
      {"fabric-stick-slip-curve", "a clamped strip sticks until T = mu N at small and large friction", source,
       true, [] { return stick_slip({10}, {0.05, 0.2}); }},
  };
}

}  // namespace muslin::app
