#include "muslin/fit/specimens.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "muslin/energy/stress_curve.hpp"
#include "muslin/fit/rising_curve.hpp"

namespace muslin {
namespace {

/// The standard deviation of the factors of each group of specimens becomes the uncertainty of each, unless a
/// test of the group states its own.
template <class Test, class Same>
void scatter_of(std::vector<Test>& tests, const Same& same) {
  for (const Test& first : tests) {
    std::vector<Test*> group;
    std::vector<std::vector<Vec2>> curves;
    for (Test& test : tests) {
      if (test.points.empty() || !same(test, first)) continue;
      group.push_back(&test);
      curves.push_back(test.points);
    }
    if (group.size() < 2 || std::any_of(group.begin(), group.end(),
                                        [](const Test* t) { return t->factor.plus_minus.has_value(); }))
      continue;
    double squares = 0;
    for (const double factor : specimen_factors(curves)) squares += (factor - 1) * (factor - 1);
    const double deviation = std::sqrt(squares / static_cast<double>(group.size() - 1));
    for (Test* test : group) test->factor.plus_minus = deviation;
  }
}

}  // namespace

std::vector<double> specimen_factors(const std::vector<std::vector<Vec2>>& curves) {
  std::vector<Vec2> data;
  for (const std::vector<Vec2>& curve : curves) data.insert(data.end(), curve.begin(), curve.end());
  const StressCurve common(fit_rising_curve(data).points);
  std::vector<double> factors;
  factors.reserve(curves.size());
  for (const std::vector<Vec2>& curve : curves) {
    double product = 0, size = 0;
    for (const Vec2& point : curve) {
      const double expected = common.at(point[0]).stress;
      product += expected * point[1];
      size += expected * expected;
    }
    factors.push_back(product / size);
  }
  return factors;
}

void estimate_scatter(Measurements& m) {
  const auto same_direction = [](const auto& a, const auto& b) { return a.direction == b.direction; };
  scatter_of(m.tensile, same_direction);
  scatter_of(m.bending, same_direction);
  scatter_of(m.shear, [](const ShearTest&, const ShearTest&) { return true; });
}

double relative_change(const std::vector<Vec2>& curve, const std::vector<Vec2>& other) {
  const StressCurve changed(other);
  double squares = 0, size = 0;
  for (const Vec2& point : curve) {
    const double change = changed.at(point[0]).stress - point[1];
    squares += change * change;
    size += point[1] * point[1];
  }
  return std::sqrt(squares / size);
}

}  // namespace muslin
