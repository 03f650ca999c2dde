// BodySettings holds the settings of a [[body]].
#pragma once

#include <optional>
#include <string>

#include "muslin/core/error.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/material/material.hpp"
#include "muslin/schema/own_settings.hpp"
#include "muslin/schema/variation.hpp"

namespace muslin {

struct BodySettings {
  std::string name;
  std::string mesh;  ///< path as written; relative to the scene file
  Place mesh_place;
  std::string model = "lattice";  ///< the kind of its degrees of freedom: "lattice" or "shell"
  OwnSettings own;                ///< those of its kind: LatticeBodySettings, ShellBodySettings
  Material material;              ///< has the numbers of the model
  Vec3 translate = Vec3::Zero();  ///< [m]
  Vec3 rotate = Vec3::Zero();     ///< Euler angles about x, then y, then z [degrees]
  Vec3 scale = Vec3::Ones();
  std::optional<double> weld;      ///< joins vertices nearer than this [m]
  Vec3 velocity = Vec3::Zero();    ///< initial [m/s]
  bool contact = true;             ///< touches other bodies, colliders and itself
  bool self_contact = true;        ///< touches itself
  std::optional<double> friction;  ///< Coulomb's μ; default: that of the scene
  schema::Variations variations;   ///< of `friction`
  std::optional<int> layer;        ///< order outward: a body belongs outside those of lower layers
  std::optional<Vec3> colour;      ///< in pictures, sRGB 0…1; default: one of a palette
  Place place;
};

}  // namespace muslin
