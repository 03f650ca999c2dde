// ContactPairSettings describes how two bodies, or groups of their vertices, meet, in place of what the
// bodies say of themselves.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>

#include "muslin/api.hpp"
#include "muslin/core/error.hpp"
#include "muslin/schema/variation.hpp"

namespace muslin {

struct Scene;
namespace schema {
struct Table;
}

struct MUSLIN_API ContactPairSettings {
  struct Side {
    std::string body;                  ///< or a collider
    std::optional<std::string> group;  ///< of vertices of its mesh; none: all
    Place place;
  };
  std::array<Side, 2> between;      ///< both may be the same
  bool contact = true;              ///< false: they pass through each other
  std::optional<double> thickness;  ///< distance of the midsurfaces that touch [m]
  std::optional<double> distance;   ///< d̂ [m]
  std::optional<double> friction;   ///< Coulomb's μ
  schema::Variations variations;    ///< of `friction`, by keyframes
  std::optional<double> stiffness;  ///< [N/m]
  double from = 0, until = std::numeric_limits<double>::infinity();  ///< [s]
  Place place;
};

/// [[contact.pair]] of a scene file.
const schema::Table& contact_pair_table();

/// Throws Error(input), with the nearest name, if a pair names a body that the scene does not have.
void check_contact_pairs(const Scene& scene);

}  // namespace muslin
