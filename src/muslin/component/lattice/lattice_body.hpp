// LatticeBody is a solid, or a sheet with its thickness, filled with voxels: springs and tetrahedra between
// the voxels' corners carry the mesh and a contour.
//
// Contact sees the mesh, thickened if it is a sheet. The stiffness of a contact is 0.15 × Young's modulus
// along the voxels × voxel width (or thickness, of a thinner sheet whose voxels count by their share).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "muslin/component/body_settings.hpp"
#include "muslin/component/component.hpp"
#include "muslin/component/lattice/lattice_body_settings.hpp"
#include "muslin/component/lattice/separate_parts.hpp"
#include "muslin/lattice/lattice.hpp"
#include "muslin/lattice/springs.hpp"
#include "muslin/potential/spring_network.hpp"
#include "muslin/surface/contour.hpp"

namespace muslin {

class LatticeBody final : public Component {
 public:
  BodySettings settings;
  Mesh
      solid;  ///< filled with voxels: the mesh itself, faces outward, or the sheet with its thickness; closed
  double thickness = 0;  ///< of a sheet [m]
  SeparateParts separate;  ///< of `solid`
  Lattice lattice;
  Springs springs;
  Contour contour;
  std::shared_ptr<const SpringNetwork> network;  ///< of springs whose stiffness changes; null: none
  std::vector<MappedNumber> vertex_maps;  ///< `maps` over the vertices of the lattice, by the nearest surface

  std::string kind() const override { return "lattice"; }
  Vec3 rest_position(std::size_t v) const override { return lattice.rest_position(v); }
  std::vector<double> masses() const override;
  std::vector<Vec3> velocities() const override;
  double spacing() const override { return lattice.width; }
  std::vector<int> parts() const override;
  double max_stretch(ConstVectors x) const override;

  bool is_mesh() const override { return false; }
  std::size_t selectable_count() const override { return lattice.vertex_count(); }
  Vec3 selectable(std::size_t i) const override { return lattice.rest_position(i); }
  std::vector<std::uint8_t> in_group(const MeshGroup& group) const override;
  AttachedPoint attach(const Vec3& at) const override;

  std::optional<ContactPart> contact_part() const override;

  std::uint64_t shape_hash(std::uint64_t seed) const override;
  std::uint64_t material_hash(std::uint64_t seed) const override;
  Appearance appearance() const override { return {settings.colour}; }
  std::vector<CachedPoints> cached_points() const override;
  void write_stages(const std::filesystem::path& folder, const Progress& progress) const override;
  std::string description_json() const override;
  std::string description() const override;

  const LatticeBodySettings& own() const { return settings.own.as<LatticeBodySettings>(); }
  /// Embeds points [m] in the voxels of the part that is nearest.
  Embedding carry(ConstVectors points) const { return embed(lattice, separate.in_grid(points)); }
  /// Returns the share by which each voxel counts: its fill, or 1 with Mass::cells.
  std::vector<double> voxel_shares() const;
  /// Returns #voxels: the mean of a mapped number over a voxel's corners, over the nominal one; 1 without a
  /// map.
  std::vector<double> voxel_factors(std::string_view key) const;
};

/// Builds a lattice. Errors: input and file, with the place in the scene and the mesh file.
std::shared_ptr<Component> build_lattice_body(const BodySettings& settings, const ComponentInputs& inputs);

/// Returns the component as a lattice, null if it is of another kind. Only for features that lattices alone
/// have.
const LatticeBody* as_lattice(const Component& component);

}  // namespace muslin
