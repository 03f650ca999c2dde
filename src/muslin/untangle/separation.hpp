// Separations push places of surfaces apart that cross, lie on each other or are closer than their thickness.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "muslin/contact/contact_hessian.hpp"
#include "muslin/contact/surface_map.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/potential/potential.hpp"

namespace muslin {

/// The place Σ wᵢ xᵢ, relative to another surface or to the origin, is to be at least `gap` along `normal`.
struct Separation {
  std::array<int, 4> points = {-1, -1, -1, -1};  ///< of the surface; −1: none
  std::array<double, 4> weights{};  ///< w, of sum 0 between two surfaces, of sum 1 relative to the origin
  Vec3 normal = Vec3::Zero();       ///< of length 1
  double gap = 0;                   ///< [m]
  double stiffness = 0;             ///< [N/m]
};

/// W(q) = Σ ½ k max(0, gap − n · Σ wᵢ xᵢ)², x = J q.
class SeparationPotential : public Potential {
 public:
  SeparationPotential(std::shared_ptr<const SurfaceMap> map, std::vector<Separation> separations);

  double value(ConstVectors q) const override;
  void add_gradient(ConstVectors q, Vectors g) const override;
  void add_hessian_product(ConstVectors q, ConstVectors p, Vectors y) const override;
  void add_diagonal_blocks(ConstVectors q, std::span<Mat3> blocks) const override;
  void linearize(ConstVectors q, HessianSink& into, std::size_t first) const override;

  /// Returns by how much the separations that are missing fall short, in the mean [m]; 0 if none is.
  double mean_missing(ConstVectors q) const;

 private:
  /// Returns by how much a separation falls short at points x [m].
  static double missing(const Separation& s, ConstVectors x);
  ContactHessian hessian(ConstVectors q) const;

  std::shared_ptr<const SurfaceMap> map_;
  std::vector<Separation> separations_;
};

}  // namespace muslin
