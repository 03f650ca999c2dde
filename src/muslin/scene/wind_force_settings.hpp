// WindForceSettings holds what a scene says of a [[force]] that is wind.
#pragma once

#include <cstdint>

#include "muslin/force/keyed.hpp"

namespace muslin {

struct WindForceSettings {
  KeyedNumber air_density = 1.2;  ///< [kg/m³]
  KeyedNumber drag = 1.17;        ///< drag coefficient C_D
  KeyedNumber lift = 0.0;         ///< lift coefficient C_L ≤ C_D
  KeyedNumber gust = 0.0;         ///< root mean square of each component of the turbulence [m/s]
  double gust_length = 1.0;  ///< size of its largest eddies [m]
  std::int64_t seed = 1;     ///< decides the turbulence
  double porosity = 0.0;     ///< open share of the surface
};

}  // namespace muslin
