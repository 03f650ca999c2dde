#include "muslin/force/turbulence.hpp"

#include <cmath>
#include <numbers>

#include "muslin/core/error.hpp"
#include "muslin/force/split_mix.hpp"

namespace muslin {
namespace {

constexpr int bands = 12, frames = 2;

/// Numbers in [0, 1), one after another.
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : state_(split_mix(seed)) {}
  double next() { return static_cast<double>((state_ = split_mix(state_)) >> 11) * 0x1p-53; }

 private:
  std::uint64_t state_;
};

/// K. Shoemake, Uniform random rotations, Graphics Gems III, 1992.
Mat3 random_rotation(Draws& draws) {
  const double share = draws.next();
  const double a = 2 * std::numbers::pi * draws.next(), b = 2 * std::numbers::pi * draws.next();
  const double p = std::sqrt(1 - share), q = std::sqrt(share);
  return Eigen::Quaterniond(q * std::cos(b), p * std::sin(a), p * std::cos(a), q * std::sin(b))
      .toRotationMatrix();
}

}  // namespace

Turbulence::Turbulence(const Settings& settings) {
  require(settings.smallest > 0 && settings.smallest <= settings.largest,
          "the eddies of a turbulence have no size from `smallest` to `largest`",
          "give 0 < smallest ≤ largest");
  require(settings.turnover > 0, "the turnover time of a turbulence is not above 0", "give one above 0");
  const double least = 2 * std::numbers::pi / settings.largest;
  const double ratio = settings.largest / settings.smallest;
  const auto edge = [&](double band) { return least * std::pow(ratio, band / bands); };
  // ∫ k^−5/3 dk over a band and over all of them, of which a band has its share; equal without any width.
  const auto energy = [](double from, double to) {
    return std::pow(from, -2.0 / 3) - std::pow(to, -2.0 / 3);
  };
  Draws draws(settings.seed);
  for (int band = 0; band < bands; ++band) {
    const double k = edge(band + 0.5);
    const double share =
        ratio > 1 ? energy(edge(band), edge(band + 1)) / energy(edge(0), edge(bands)) : 1.0 / bands;
    // A wave along each axis of a frame, with its amplitude along the next, gives a²/2 to every component.
    const double amplitude = std::sqrt(2 * share / frames);
    const double frequency = 2 * std::numbers::pi / settings.turnover * std::pow(k / least, 2.0 / 3);
    for (int frame = 0; frame < frames; ++frame) {
      const Mat3 axes = random_rotation(draws);
      for (int i = 0; i < 3; ++i)
        waves_.push_back({k * axes.col(i), amplitude * axes.col((i + 1) % 3), frequency,
                          2 * std::numbers::pi * draws.next()});
    }
  }
}

FieldSample Turbulence::at(const Vec3& place, double time) const {
  Vec3 sum = Vec3::Zero();
  for (const Wave& wave : waves_)
    sum += std::cos(wave.number.dot(place) + wave.phase - wave.frequency * time) * wave.amplitude;
  return {sum, place.norm()};
}

}  // namespace muslin
