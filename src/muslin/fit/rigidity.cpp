#include "muslin/fit/rigidity.hpp"

#include <cmath>
#include <numbers>

#include "muslin/fit/elastica.hpp"

namespace muslin {
namespace {

constexpr double gravity = 9.80665;                             // m/s²
constexpr double tester_angle = 41.5 * std::numbers::pi / 180;  // of cantilevers

double bending_length(const BendingTest& test) {
  if (test.bending_length) {
    static const double share = cantilever_bending_length(1, tester_angle);
    return 2 * test.bending_length->value * share;
  }
  try {
    return loop_bending_length(test.loop, *test.loop_length, test.loop_height->value);
  } catch (const Error& error) {
    throw Error(error.kind(), test.place, error.problem(), error.remedy());
  }
}

}  // namespace

std::optional<double> rigidity_by(const BendingTest& test, double areal_density) {
  if (test.rigidity) return test.rigidity->value;
  if (!test.bending_length && !test.loop_height) return std::nullopt;
  return areal_density * gravity * std::pow(bending_length(test), 3);
}

}  // namespace muslin
