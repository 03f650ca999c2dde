#include "muslin/force/falloff.hpp"

#include <cmath>

namespace muslin {

double Falloff::at(double distance) const {
  if (max && distance > *max) return 0;
  if (power == 0 || distance <= min) return 1;
  return std::pow(1 + (distance - min) / length.value_or(min > 0 ? min : 1), -power);
}

}  // namespace muslin
