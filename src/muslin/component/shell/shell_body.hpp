// ShellBody is a mesh as thin cloth: its vertices are the degrees of freedom, its triangles and the hinges
// between them carry membrane and bending energy.
//
// Contact sees its triangles, thickened by half its thickness. The thickness is that of the settings, or else
// 0.5 mm, but at most a tenth of its mean edge; where a map varies it, edges and triangles have the greatest
// of their vertices. The stiffness of a contact is 0.15 × its mean membrane
// modulus [N/m], the mean over its area where it has several fabrics.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "muslin/component/body_settings.hpp"
#include "muslin/component/component.hpp"
#include "muslin/component/shell/shell_body_settings.hpp"
#include "muslin/component/shell/shell_fabric.hpp"
#include "muslin/component/shell/trusted_edge.hpp"
#include "muslin/core/keyed_number.hpp"
#include "muslin/potential/symmetric_pattern.hpp"
#include "muslin/shell/shell.hpp"

namespace muslin {

class ShellBody final : public Component {
 public:
  BodySettings settings;  ///< with numbers of a shell in `material`
  Shell shell;            ///< with the rest lengths of `time`
  double time = 0;        ///< [s]
  /// Areas of its triangles and vertices before it shrinks or grows, which leaves its mass, #T and #V [m²].
  std::vector<double> woven_areas, woven_vertex_areas;
  std::shared_ptr<const SymmetricPattern> pattern;  ///< of the pairs of vertices that terms couple
  std::vector<FabricInUse> fabrics;   ///< at least one; the first has the material of `settings`
  std::vector<int> triangle_fabrics;  ///< #T, index into `fabrics`
  /// #T where maps or several fabrics vary the material; empty: one for all.
  std::vector<ShellMaterial> triangle_materials;
  double uv_scale = 0;  ///< with `rest = "uv"`: metres per unit of the texture

  std::string kind() const override { return "shell"; }
  void add_terms(std::span<const std::uint8_t> held) override;
  Vec3 rest_position(std::size_t v) const override { return mesh.positions[v]; }
  std::vector<double> masses() const override;
  std::vector<Vec3> velocities() const override;
  double spacing() const override { return shell.mean_edge; }
  std::vector<int> parts() const override;
  double max_stretch(ConstVectors x) const override { return muslin::max_stretch(shell, x); }
  /// The largest, if all triangles have one.
  std::optional<double> stretch_limit(double at_time) const override;

  std::optional<ContactPart> contact_part() const override;

  std::uint64_t shape_hash(std::uint64_t seed) const override;
  std::uint64_t material_hash(std::uint64_t seed) const override;
  Appearance appearance() const override { return {settings.colour}; }
  void write_stages(const std::filesystem::path& folder, const Progress& progress) const override;
  std::string description_json() const override;
  std::string description() const override;

  /// The numbers of its material. Errors: usage, if the material has none of shells.
  const ShellMaterial& material() const;
  bool has_several_fabrics() const { return fabrics.size() > 1; }
  /// Returns the rest lengths along warp and weft over those of the mesh, where the mean weight of maps is
  /// that of some vertices, at a time [s].
  Vec2 rest_scale(std::span<const int> vertices, double at_time) const;
  /// Returns the shell at a time [s].
  Shell shell_at(double at_time) const;
  /// Returns the mass of each fabric [kg] and its area before it shrinks or grows [m²].
  std::vector<double> fabric_masses() const;
  std::vector<double> fabric_areas() const;
  /// Returns the coefficients of mass damping of the vertices, Σ α m over the triangles around each, #V
  /// [kg/s].
  std::vector<double> mass_dampings() const;
  /// Returns the numbers at each triangle at a time [s], for fabrics that vary by maps or are several.
  std::vector<ShellMaterial> materials_of_triangles(double time) const;
  /// The numbers at a triangle.
  const ShellMaterial& material_at(std::size_t t) const {
    return triangle_materials.empty() ? material() : triangle_materials[t];
  }
  /// Returns the shortest of those of its fabrics.
  TrustedEdge shortest_trusted_edge() const;
  const ShellBodySettings& own() const { return settings.own.as<ShellBodySettings>(); }

  /// Returns Coulomb's μ of each vertex, negative where it is that of the body; empty: everywhere.
  std::vector<KeyedNumber> frictions() const;

 private:
  std::string description_of(std::size_t fabric) const;
  /// Returns the mean membrane modulus at rest [N/m].
  double mean_modulus() const;
  /// Calls visit(t, v, share) for every corner v of every triangle t with a third of the triangle's mass
  /// [kg].
  template <class Visit>
  void for_each_share(const Visit& visit) const;
};

/// Builds a shell. Errors: input and file, with the place in the scene and the mesh file.
std::shared_ptr<Component> build_shell_body(const BodySettings& settings, const ComponentInputs& inputs);

/// Returns the component as a shell, null if it is of another kind. Only for features that shells alone have.
const ShellBody* as_shell(const Component& component);

}  // namespace muslin
