// AffineBodyEnergy keeps a rigid body rigid: the four points q that move it affinely
// (geometry/affine_frame.hpp) are held to rigid motions by a stiff energy, as in Lan, Kaufman, Li, Jiang,
// Yang, Affine Body Dynamics (2022).
//
//   bᵢ = ¼ Σ_c s_ci q_c,   the half axes of the tetrahedron, s the signs of its corners; at rest |bᵢ| = aᵢ
//   r_ij = (bᵢ·b_j − δ_ij aᵢ²) / max(aᵢ, a_j)
//   W = k/8 Σ_ij r_ij²
//
// With kinetic energy ½ m (|ċ|² + Σ |ḃᵢ|²) every small distortion oscillates at ω² = k/m, whatever the shape:
// a plate is no harder to solve than a ball. A force F at a point X of the body distorts it by about F
// |X/a|²/k, 3 to 5 F/k on the surface of common shapes.
//
// The projected stiffness leaves out negative eigenvalues: those of the second part, k/2 Σ_ij r_ij/max(aᵢ,
// a_j) dbᵢ·db_j, whose 3 × 3 matrix is cut at zero.
#pragma once

#include <array>

#include "muslin/core/vectors.hpp"
#include "muslin/potential/potential.hpp"

namespace muslin {

class AffineBodyEnergy : public Potential {
 public:
  /// For four vertices; `radii` as in AffineFrame [m], `stiffness` k [N/m]. Errors: usage, if any is not
  /// positive.
  AffineBodyEnergy(const Vec3& radii, double stiffness);

  double value(ConstVectors q) const override;
  void add_gradient(ConstVectors q, Vectors g) const override;
  void add_hessian_product(ConstVectors q, ConstVectors p, Vectors y) const override;
  void add_diagonal_blocks(ConstVectors q, std::span<Mat3> blocks) const override;
  void linearize(ConstVectors q, HessianSink& into, std::size_t first) const override;

 private:
  Mat3 strain(const Mat3& b) const;  ///< r
  /// Returns the projected stiffness between bᵢ and b_j at b.
  std::array<std::array<Mat3, 3>, 3> projected(const Mat3& b) const;

  Vec3 radii_;
  Mat3 largest_;  ///< max(aᵢ, a_j)
  double stiffness_;
};

}  // namespace muslin
