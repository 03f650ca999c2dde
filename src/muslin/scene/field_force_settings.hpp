// FieldForceSettings holds what a scene says of a [[force]] that is a field.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "muslin/core/error.hpp"
#include "muslin/force/falloff.hpp"
#include "muslin/force/keyed.hpp"
#include "muslin/force/region.hpp"

namespace muslin {

struct FieldForceSettings {
  enum class ActsAs { wind, acceleration };

  // Every kind has these.
  ActsAs acts_as = ActsAs::acceleration;  ///< drag always slows
  std::string wind;                       ///< the name of the wind to which it adds; empty: the only one
  KeyedNumber strength = 1;               ///< [m/s] or [m/s²]; of a drag a factor
  Vec3 center = Vec3::Zero();             ///< [m]
  Vec3 travel = Vec3::Zero();             ///< [m/s]
  std::optional<Falloff> falloff;         ///< none: 1 everywhere; of a vortex Rankine's
  std::optional<Region> region;           ///< none: everywhere

  Vec3 direction = Vec3::UnitX();  ///< uniform; of length 1

  Vec3 axis = Vec3::UnitY();  ///< vortex; of length 1
  double radius = 1;          ///< vortex: where the speed is `strength` [m]

  double largest = 1;              ///< turbulence: size of the largest eddies [m]
  std::optional<double> smallest;  ///< turbulence: of the smallest ones [m]; none: an eighth
  std::optional<double> turnover;  ///< turbulence: turnover time of the largest eddies [s]; none: frozen
  std::int64_t seed = 1;           ///< turbulence

  std::string file;  ///< grid: path of an array of vectors
  Place file_place;
  Vec3 origin = Vec3::Zero();   ///< grid: its first node, relative to the centre [m]
  Vec3 spacing = Vec3::Ones();  ///< grid: of the nodes along each axis [m]

  std::vector<Vec3> points;  ///< curve [m]
  double attraction = 0;     ///< curve
  double reach = 0.1;        ///< curve: where the attraction is full [m]

  double linear = 0;     ///< drag [1/s]
  double quadratic = 0;  ///< drag [1/m]
};

}  // namespace muslin
