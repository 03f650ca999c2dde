// Kinematic components have scripted motion and no mass: a collider that is static or moves rigidly along
// keyframes, and a mesh whose vertices follow the samples of an animation.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "muslin/component/collider/affine_collider.hpp"

namespace muslin {

/// Fixed, or moved rigidly along keyframes.
class KinematicBody final : public AffineCollider {
 public:
  KinematicBody(const ColliderSettings& the_settings, const ComponentInputs& inputs);

  std::vector<double> masses() const override { return std::vector<double>(4, 0.0); }
  std::vector<Vec3> velocities() const override { return velocities_; }
  const Prescribed* motion() const override { return &motion_; }

 protected:
  std::string movement() const override { return settings.motion.keys.empty() ? "fixed" : "keyframed"; }

 private:
  Prescribed motion_;
  std::vector<Vec3> velocities_;
};

/// Its vertices are those of the mesh.
class KinematicMesh final : public ColliderComponent {
 public:
  KinematicMesh(const ColliderSettings& the_settings, const ComponentInputs& inputs);

  std::string kind() const override { return "sequence"; }
  Vec3 rest_position(std::size_t v) const override { return mesh.positions[v]; }
  std::vector<double> masses() const override { return std::vector<double>(mesh.vertex_count(), 0.0); }
  std::vector<Vec3> velocities() const override { return velocities_; }
  const Prescribed* motion() const override { return &motion_; }
  std::optional<ContactPart> contact_part() const override;

 protected:
  std::string movement() const override { return "sequence"; }

 private:
  Prescribed motion_;
  std::vector<Vec3> velocities_;
};

struct ColliderKind;
extern const ColliderKind kinematic_kind;

}  // namespace muslin
