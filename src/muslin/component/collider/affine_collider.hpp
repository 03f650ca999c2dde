// AffineCollider is a collider that moves rigidly and is carried by four vertices, the corners of a frame
// (geometry/affine_frame.hpp).
//
// Contact sees a sphere as a point and a capsule as a segment, both thickened by their radius, a plane as a
// half-space, a box or mesh as its triangles.
#pragma once

#include <string>
#include <vector>

#include "muslin/component/collider/collider_component.hpp"
#include "muslin/geometry/affine_frame.hpp"

namespace muslin {

class AffineCollider : public ColliderComponent {
 public:
  AffineFrame frame;  ///< at the start

  std::string kind() const override { return "rigid"; }
  Vec3 rest_position(std::size_t v) const override { return frame.corners()[v]; }
  bool deforms() const override { return false; }
  double longest_step() const override;
  bool is_mesh() const override { return false; }
  bool selects_vertices() const override { return false; }
  AttachedPoint attach(const Vec3& at) const override;
  std::optional<ContactPart> contact_part() const override;

 protected:
  /// Fills in skin and vertex_count and calls ColliderComponent::finish.
  void finish_affine();
};

/// Returns points of a body as combinations of the corners of its frame. Prepared for the transpose.
Embedding embed(const AffineFrame& frame, ConstVectors points);

}  // namespace muslin
