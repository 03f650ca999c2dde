// ShellFabric is a [[body.fabric]]: the cloth of some faces of a shell. The other faces have the material of
// the body.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "muslin/component/mapped_number.hpp"
#include "muslin/core/error.hpp"
#include "muslin/geometry/mesh.hpp"
#include "muslin/material/material.hpp"
#include "muslin/schema/variation.hpp"

namespace muslin {

struct ShellFabric {
  std::string faces;  ///< a face group of the mesh, or a material of its file
  Material material;  ///< has numbers of shells
  std::optional<double> friction;  ///< Coulomb's μ; default: that of the body
  schema::Variations variations;   ///< of `friction`
  Place place;
};

/// A fabric of a shell that some of its faces have.
struct FabricInUse {
  std::string name;  ///< its `faces`; that of its material for faces that no [[body.fabric]] names
  Material material;
  std::optional<double> friction;
  schema::Variations variations;
  Place place;
  std::vector<MappedNumber> maps;  ///< by which its material varies over the vertices of the mesh

  const ShellMaterial& numbers() const { return *material.shell; }
};

struct FabricsOfFaces {
  std::vector<FabricInUse> fabrics;  ///< that of the body first, if a face has it; without maps
  std::vector<int> of_face;          ///< #F, index into `fabrics`
};

/// Finds the fabric of each face, `material` where no fabric names it. A group comes before a material of the
/// same name. Errors: input, at the place of the fabric: an unknown name, one without faces, a face that has
/// a fabric already.
FabricsOfFaces fabrics_of_faces(const Material& material, const Place& place,
                                const std::vector<ShellFabric>& fabrics, const Mesh& mesh);

/// Returns the largest limit of stretch of a material, whose limit may vary.
std::optional<double> largest_stretch_limit(const ShellMaterial& material);

}  // namespace muslin
