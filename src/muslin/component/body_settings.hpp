// BodySettings holds the settings of a [[body]]: a lattice or a shell.
#pragma once

#include <optional>
#include <string>

#include "muslin/core/error.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/lattice/lattice.hpp"
#include "muslin/lattice/springs.hpp"
#include "muslin/material/material.hpp"

namespace muslin {

/// The degrees of freedom of a body.
enum class BodyModel {
  lattice,   ///< voxels filled into the mesh, with springs
  shell,     ///< the mesh itself, as thin cloth
  rigid,     ///< a collider: four points that carry it
  sequence,  ///< a collider whose vertices move along samples: the mesh itself
};

struct BodySettings {
  std::string name;
  std::string mesh;  ///< path as written; relative to the scene file
  Place mesh_place;
  BodyModel model = BodyModel::lattice;
  // For shells.
  std::optional<double> shell_thickness;  ///< as contact sees it [m]; default: see shell/shell_body.hpp
  std::string rest_mesh;                  ///< path of the shape without stress; empty: `mesh`
  Place rest_mesh_place;
  std::optional<Vec3>
      warp;  ///< direction of the warp threads; default: along the texture's u, or the longest side
  std::optional<double> stretch_limit;  ///< of length to rest length in every direction; default: none
  // For lattices.
  std::optional<double> thickness;  ///< of an open mesh [m]; default: one voxel width
  LatticeSettings lattice;
  Bracing bracing = Bracing::kuhn;
  enum class Mass { solid, cells } mass = Mass::solid;
  enum class BoundarySprings { full, shared } boundary_springs = BoundarySprings::full;
  Material material;              ///< has the numbers of the model
  Vec3 translate = Vec3::Zero();  ///< [m]
  Vec3 rotate = Vec3::Zero();     ///< Euler angles about x, then y, then z [degrees]
  Vec3 scale = Vec3::Ones();
  Vec3 velocity = Vec3::Zero();    ///< initial [m/s]
  bool contact = true;             ///< touches other bodies, colliders and itself
  bool self_contact = true;        ///< touches itself
  std::optional<double> friction;  ///< Coulomb's μ; default: that of the scene
  std::optional<Vec3> colour;      ///< in pictures, sRGB 0…1; default: one of a palette
  Place place;
};

}  // namespace muslin
