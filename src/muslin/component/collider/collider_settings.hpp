// ColliderSettings holds the settings of a [[collider]]: an obstacle or a rigid body.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "muslin/constraint/pin.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/schema/variation.hpp"

namespace muslin {

/// An obstacle for bodies, static or moving; with a density it is a rigid body.
struct ColliderSettings {
  enum class Shape { plane, sphere, capsule, box, mesh } shape = Shape::plane;
  std::string name;
  Vec3 center = Vec3::Zero();    ///< of a sphere or box; a point of a plane [m]
  double radius = 0;             ///< of a sphere or capsule [m]
  Vec3 normal = Vec3(0, 1, 0);   ///< of a plane, towards the free side, of length 1
  Vec3 size = Vec3::Ones();      ///< of a box [m]
  std::array<Vec3, 2> points{};  ///< the ends of a capsule's axis [m]
  std::string mesh;              ///< path as written; relative to the scene file
  Place mesh_place;
  Vec3 translate = Vec3::Zero();  ///< of a mesh [m]
  Vec3 rotate = Vec3::Zero();     ///< of a mesh, or of a box about its centre [degrees], as for a body
  Vec3 scale = Vec3::Ones();      ///< of a mesh
  Motion motion;                  ///< relative to the shape's placement
  std::optional<Vec3> pivot;      ///< of the motion [m]; default: the middle of the shape
  std::string sequence;           ///< path of the samples that a mesh follows; empty: none
  Place sequence_place;
  std::optional<double> frame_rate;      ///< of the samples, except of an .mdd [1/s]; default: the scene's
  std::optional<double> start;           ///< time of the first sample [s]; default: that of the file, or 0
  std::optional<double> density;         ///< [kg/m³]; if given, it moves dynamically
  Vec3 velocity = Vec3::Zero();          ///< initial, with a density [m/s]
  Vec3 angular_velocity = Vec3::Zero();  ///< initial, with a density, about its centre of mass [degrees/s]
  bool contact = true;
  std::optional<double> friction;  ///< Coulomb's μ; default: that of the scene
  schema::Variations variations;   ///< of `friction`, by keyframes
  std::optional<int> layer;        ///< order outward: a body belongs outside those of lower layers
  std::optional<Vec3> colour;      ///< in pictures, sRGB 0…1; default: grey
  Place place;

  bool is_free() const { return density.has_value(); }
};

/// Returns the word of the scene file for a shape.
const char* name_of(ColliderSettings::Shape shape);

}  // namespace muslin
