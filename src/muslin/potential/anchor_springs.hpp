// AnchorSprings pulls single vertices to anchors.
#pragma once

#include <vector>

#include "muslin/potential/potential.hpp"

namespace muslin {

/// W = Σ ½ cᵢ |xᵢ − anchorᵢ|². It is also a drag: with cᵢ = kᵢ / dt and the step's own anchor, in which
/// v = (x − anchor) / dt is the velocity at the end of the step, the force is −kᵢ vᵢ.
class AnchorSprings : public Potential {
 public:
  /// coefficients: #V, ≥ 0 [N/m]; anchor: #V by 3 [m].
  AnchorSprings(std::vector<double> coefficients, std::vector<Vec3> anchor);

  double value(ConstVectors x) const override;
  void add_gradient(ConstVectors x, Vectors g) const override;
  void add_hessian_product(ConstVectors x, ConstVectors p, Vectors y) const override;
  void add_diagonal_blocks(ConstVectors x, std::span<Mat3> blocks) const override;
  void linearize(ConstVectors x, HessianSink& into, std::size_t first) const override;

 private:
  std::vector<double> coefficients_;
  std::vector<Vec3> anchor_;
};

}  // namespace muslin
