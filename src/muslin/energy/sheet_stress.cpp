#include "muslin/energy/sheet_stress.hpp"

#include <cmath>

namespace muslin {
namespace {

double softening(const StressCurve& curve) {
  const double first = curve.slope(0);
  return first > 0 ? curve.least_slope() / first : 1;
}

}  // namespace

double highest_poisson(const SheetStress& stress) {
  const double p = softening(stress.warp), q = softening(stress.weft), rest = (1 - p) * (1 - q);
  return p * q < rest ? std::sqrt(p * q / rest) : 1;
}

}  // namespace muslin
