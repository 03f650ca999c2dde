// RigidBody is a collider with a density: an affine body (geometry/affine_frame.hpp) that forces move.
// docs/theory/rigid-bodies.md.
//
// The stiffness of a contact is mass/step², which limits its penetration to its free fall in one step.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "muslin/component/collider/affine_collider.hpp"

namespace muslin {

class RigidBody final : public AffineCollider {
 public:
  /// Errors: input and file, with the place in the scene and the mesh file.
  RigidBody(const ColliderSettings& the_settings, const ComponentInputs& inputs);

  std::vector<double> masses() const override;
  std::vector<Vec3> velocities() const override;
  void predict(Integrator integrator, const State& state, std::span<const std::uint8_t> fixed,
               StepContext& context) const override;

 protected:
  std::string movement() const override { return "rigid body"; }

 private:
  double mass_ = 0;  ///< [kg]
};

struct ColliderKind;
extern const ColliderKind rigid_kind;

}  // namespace muslin
