// ShellBodySettings holds what a scene says of a [[body]] that is a shell.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "muslin/component/shell/shell_fabric.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/schema/variation.hpp"

namespace muslin {

/// Tells how threads resist compression: by no more than the load at which cells of the mesh buckle
/// (energy/cell_buckling.hpp), or with the moduli of tension.
enum class Compression { buckling, elastic };

/// The shape without stress: that of a mesh, or the texture coordinates as a flat pattern.
enum class RestSource { mesh, uv };

struct ShellBodySettings {
  std::optional<double> thickness;  ///< as contact sees it [m]; default: see shell_body.hpp
  RestSource rest = RestSource::mesh;
  std::string rest_mesh;  ///< path of the shape without stress; empty: the mesh
  Place rest_mesh_place;
  std::optional<double> uv_scale;  ///< metres per unit of the texture; default: areas as those of the mesh
  /// Direction of the warp threads; default: along the texture's u, or the longest side.
  std::optional<Vec3> warp;
  double rest_scale_warp = 1;             ///< rest length over that of the mesh or the rest mesh
  std::optional<double> rest_scale_weft;  ///< default: as warp
  double rest_scale_share = 1;            ///< of the change of rest lengths that has come about
  schema::Variations variations;          ///< of numbers above
  Compression compression = Compression::buckling;
  std::optional<double> stretch_limit;  ///< of length to rest length in every direction; default: none

  std::vector<ShellFabric> fabrics;  ///< of faces that do not have the material of the body
};

}  // namespace muslin
