// UnevenPressure is what a pressure that differs from vertex to vertex of a closed surface has above an even
// one, as forces that follow the surface:
//
//   Fᵢ = Σ A n (2 pᵢ + pⱼ + pₖ)/12
//
// over the triangles i, j, k at a vertex, A n their area along the outward normal: ∫ p n φᵢ dA for a p that
// is linear on each triangle. The centre of a hole has the mean p of its rim, to which its force goes.
//
// No energy has these forces: where p varies, the work around a loop of deformations is not zero. So they are
// taken where a step begins and do work, which the energy account lists.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "muslin/geometry/enclosed_volume.hpp"
#include "muslin/potential/potential.hpp"

namespace muslin {

class UnevenPressure : public Load {
 public:
  /// Returns the pressure in a step from `begin` to `end` [s] where the share is 1 [Pa]; 0: none acts.
  using PressureOfStep = std::function<double(double begin, double end)>;
  /// p is that pressure times `shares` (#V). Errors: usage, if their count is another than that of vertices.
  UnevenPressure(std::shared_ptr<const EnclosedVolume> surface, std::vector<double> shares,
                 PressureOfStep pressure);

  std::unique_ptr<Potential> potential(const StepContext& step) const override;
  /// Returns the forces at x (#V by 3) under a pressure [Pa] [N].
  std::vector<Vec3> forces(ConstVectors x, double pressure) const;

 private:
  std::shared_ptr<const EnclosedVolume> surface_;
  std::vector<double> shares_;  ///< of the vertices, then of the centres of holes
  PressureOfStep pressure_;
};

}  // namespace muslin
