// ColliderComponent is the base of components from a [[collider]]: their shape as a mesh, placed in the
// world.
#pragma once

#include <string>

#include "muslin/component/collider/collider_settings.hpp"
#include "muslin/component/component.hpp"
#include "muslin/geometry/mass_properties.hpp"

namespace muslin {

class ColliderComponent : public Component {
 public:
  ColliderSettings settings;
  double mean_edge = 0;  ///< of the mesh [m]

  double spacing() const override { return mean_edge; }
  Appearance appearance() const override;
  std::string description_json() const override;
  std::string description() const override;

 protected:
  /// Returns the kind of motion in words.
  virtual std::string movement() const = 0;
  /// Fills in settings, name, mesh and report. Errors: input and file, with the place in the scene and the
  /// mesh file.
  void begin(const ColliderSettings& the_settings, const ComponentInputs& inputs);
  /// Fills in mean_edge and statistics; skin and vertex_count must be set. Errors: input.
  void finish();
};

/// Returns the placement of a box or mesh in the world.
Eigen::Affine3d placement_of(const ColliderSettings& settings);

/// Returns the mass properties for density 1 of the shape, whose mesh is placed in the world.
MassProperties mass_properties(const ColliderSettings& settings, const Mesh& mesh);

}  // namespace muslin
