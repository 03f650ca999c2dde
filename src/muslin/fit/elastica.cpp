#include "muslin/fit/elastica.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

/// θ, κ, x, z at a point of a strip of length 1, or their derivatives.
using Elastica = std::array<double, 4>;

Elastica slope_of(const Elastica& y, double s, double weight, double tension) {
  const double sine = std::sin(y[0]), cosine = std::cos(y[0]);
  return {y[1], tension * sine - weight * s * cosine, cosine, sine};
}

/// The state at `length` by Runge's and Kutta's method; `weight` is w L³/D, `tension` H L²/D.
Elastica integrate(double angle, double curvature, double weight, double tension, double length) {
  constexpr int steps = 100;
  Elastica y = {angle, curvature, 0, 0};
  const double h = length / steps;
  const auto moved = [](const Elastica& a, const Elastica& k, double t) {
    Elastica sum;
    for (std::size_t i = 0; i < 4; ++i) sum[i] = a[i] + t * k[i];
    return sum;
  };
  for (int step = 0; step < steps; ++step) {
    const double s = step * h;
    const Elastica a = slope_of(y, s, weight, tension);
    const Elastica b = slope_of(moved(y, a, h / 2), s + h / 2, weight, tension);
    const Elastica c = slope_of(moved(y, b, h / 2), s + h / 2, weight, tension);
    const Elastica d = slope_of(moved(y, c, h), s + h, weight, tension);
    for (std::size_t i = 0; i < 4; ++i) y[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
  }
  return y;
}

/// The x in [low, high] at which a rising function is 0.
template <class Function>
double root_between(double low, double high, const Function& f) {
  for (int i = 0; i < 45; ++i) {
    const double middle = (low + high) / 2;
    (f(middle) < 0 ? low : high) = middle;
  }
  return (low + high) / 2;
}

/// The angle below the horizontal at which the end of a cantilever is seen.
double cantilever_angle(double weight) {
  // From the end, which points up towards the clamp by the angle that makes the clamp horizontal.
  const auto at_clamp = [&](double angle) { return integrate(angle, 0, weight, 0, 1); };
  const double angle = root_between(0, std::numbers::pi / 2, [&](double a) { return at_clamp(a)[0]; });
  const Elastica clamp = at_clamp(angle);
  return std::atan2(clamp[3], clamp[2]);
}

/// Half a loop of a strip of length 1: what it is from its lowest point.
struct HalfLoop {
  double curvature = 2 * std::numbers::pi, tension = 0;
  double height = 1 / std::numbers::pi;  // of a ring
};

/// Solves x = 0 and θ = `direction` at the grip by Newton's method, from the half loop that is given.
HalfLoop closed(HalfLoop half, double weight, double direction) {
  const auto misses = [&](double curvature, double tension) {
    const Elastica end = integrate(0, curvature, weight, tension, 0.5);
    return Vec2(end[2], end[0] - direction);
  };
  for (int i = 0; i < 20; ++i) {
    const Vec2 miss = misses(half.curvature, half.tension);
    constexpr double d = 1e-6;
    const Vec2 by_curvature = (misses(half.curvature + d, half.tension) - miss) / d;
    const Vec2 by_tension = (misses(half.curvature, half.tension + d) - miss) / d;
    const double determinant = by_curvature[0] * by_tension[1] - by_curvature[1] * by_tension[0];
    const Vec2 step((miss[0] * by_tension[1] - miss[1] * by_tension[0]) / determinant,
                    (by_curvature[0] * miss[1] - by_curvature[1] * miss[0]) / determinant);
    half.curvature -= step[0];
    half.tension -= step[1];
    if (step.norm() < 1e-10 * (1 + std::abs(half.tension))) break;
  }
  half.height = integrate(0, half.curvature, weight, half.tension, 0.5)[3];
  return half;
}

/// A loop without weight, turned from a ring into its shape.
HalfLoop weightless(double direction) {
  HalfLoop half;
  constexpr int steps = 32;
  for (int i = 1; i <= steps; ++i)
    half = closed(half, 0, std::numbers::pi + (direction - std::numbers::pi) * i / steps);
  return half;
}

double direction_of(LoopShape shape) {
  constexpr double quarter = std::numbers::pi / 2;
  return shape == LoopShape::pear ? quarter : shape == LoopShape::ring ? 2 * quarter : 3 * quarter;
}

}  // namespace

double cantilever_bending_length(double overhang, double angle) {
  // Weights from 1e-3 to 1e6, by their logarithm.
  const double logarithm = root_between(std::log(1e-3), std::log(1e6),
                                        [&](double x) { return cantilever_angle(std::exp(x)) - angle; });
  return overhang * std::exp(-logarithm / 3);
}

double loop_bending_length(LoopShape shape, double strip_length, double height) {
  const double direction = direction_of(shape), wanted = height / strip_length;
  HalfLoop light = weightless(direction);
  if (wanted <= light.height || wanted >= 0.49)
    throw Error(ErrorKind::input,
                fmt::format("a loop of a strip of {:.4g} m cannot hang {:.4g} m below its grip", strip_length,
                            height),
                fmt::format("measure from the grip to the lowest point, between {:.4g} and {:.4g} m",
                            light.height * strip_length, 0.49 * strip_length));
  double low = 0, high = 0.25;
  HalfLoop next = closed(light, high, direction);
  while (next.height < wanted) {
    light = next;
    low = high;
    high *= 1.25;
    next = closed(light, high, direction);
  }
  const double weight =
      root_between(low, high, [&](double w) { return closed(light, w, direction).height - wanted; });
  return strip_length / std::cbrt(weight);
}

}  // namespace muslin
