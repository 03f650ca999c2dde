// FrozenForces are forces on vertices that stay constant during a step.
#pragma once

#include <vector>

#include "muslin/potential/potential.hpp"

namespace muslin {

/// W = −Σ Fᵢ·xᵢ.
class FrozenForces : public Potential {
 public:
  /// forces: #V by 3 [N].
  explicit FrozenForces(std::vector<Vec3> forces);

  double value(ConstVectors x) const override;
  void add_gradient(ConstVectors x, Vectors g) const override;
  void add_hessian_product(ConstVectors, ConstVectors, Vectors) const override {}
  void add_diagonal_blocks(ConstVectors, std::span<Mat3>) const override {}
  void linearize(ConstVectors, HessianSink&, std::size_t) const override {}

 private:
  std::vector<Vec3> forces_;
};

}  // namespace muslin
