// VertexDrag resists the motion of single vertices.
#pragma once

#include <vector>

#include "muslin/potential/potential.hpp"

namespace muslin {

/// W = Σ ½ cᵢ |xᵢ − anchorᵢ|². With cᵢ = kᵢ / dt, of a step that takes v = (x − anchor) / dt as the velocity
/// at its end, the force is −kᵢ vᵢ.
class VertexDrag : public Potential {
 public:
  /// coefficients: #V, ≥ 0 [N/m]; anchor: #V by 3 [m].
  VertexDrag(std::vector<double> coefficients, std::vector<Vec3> anchor);

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
