// SpringEnergy is the energy of the springs of one lattice body.
//
//   W(x) = Σ ½ k (|z| − r)²,  z = x_b − x_a,
//
// r the rest length and k = modulus × voxel width × weight of the spring [N/m]. With n = z/|z|:
//
//   ∂W/∂x_b = k (|z| − r) n = −∂W/∂x_a
//   ∂²W/∂z² = k (n nᵀ + (1 − r/|z|)(I − n nᵀ)),
//
// indefinite under compression. A spring shorter than 1e-12 r has no direction: it stores its energy but
// exerts no force, and k I is used as its Hessian.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "muslin/energy/spring_kernels.hpp"
#include "muslin/energy/spring_slabs.hpp"
#include "muslin/lattice/springs.hpp"
#include "muslin/potential/potential.hpp"
#include "muslin/potential/spring_network.hpp"

namespace muslin {

class SpringEnergy : public Potential {
 public:
  /// `width` is the voxel width [m]; `moduli` by SpringKind [N/m²], ≥ 0; `weights` (#springs, or empty for
  /// all 1) scales single springs, e.g. at a boundary or a partly filled voxel. `network`: that of an energy
  /// of the same springs and weights, for linear systems to recognise; null: a new one.
  SpringEnergy(const Springs& springs, double width, const std::array<double, 3>& moduli,
               std::vector<float> weights = {}, std::shared_ptr<const SpringNetwork> network = nullptr);

  double value(ConstVectors x) const override;
  void add_gradient(ConstVectors x, Vectors g) const override;
  double add_gradient_and_value(ConstVectors x, Vectors g) const override;
  void add_hessian_product(ConstVectors x, ConstVectors p, Vectors y) const override;
  void add_diagonal_blocks(ConstVectors x, std::span<Mat3> blocks) const override;

  void linearize(ConstVectors x, HessianSink& into, std::size_t first) const override;

  /// Returns the largest |z| / r over all springs of weight above 0, 1 if there are no springs.
  double max_stretch(ConstVectors x) const;

  const SpringSlabs& slabs() const { return slabs_; }
  double rest_length(int direction) const { return types_[static_cast<std::size_t>(direction)].rest; }
  /// Returns k of spring `index` (counted as in Springs) of this direction [N/m].
  double stiffness(int direction, std::int64_t index) const {
    const double k = types_[static_cast<std::size_t>(direction)].stiffness;
    return weights_.empty() ? k : k * static_cast<double>(weights_[static_cast<std::size_t>(index)]);
  }
  /// Returns rest length and `factor` k of consecutive springs of a direction, beginning at this slot.
  SpringType type(int direction, std::int64_t slot, double factor = 1) const {
    const Type& type = types_[static_cast<std::size_t>(direction)];
    return {factor * type.stiffness, type.rest,
            slot_weights_.empty() ? nullptr : slot_weights_.data() + slot};
  }
  std::int64_t count() const { return count_; }

  /// Returns the springs as the linear systems take them; kinds are directions.
  const std::shared_ptr<const SpringNetwork>& network() const { return network_; }
  /// Returns rest length and `factor` k by direction.
  std::vector<CentralSpring> kinds(double factor) const;

 private:
  struct Type {
    double rest = 0;       // [m]
    double stiffness = 0;  // modulus × width [N/m]
  };
  std::vector<Type> types_;  // by direction
  std::vector<float> weights_;
  std::int64_t count_ = 0;
  std::shared_ptr<const SpringNetwork> network_;
  std::vector<float> slot_weights_;  // 0 where joining runs left a gap
  SpringSlabs slabs_;
};

}  // namespace muslin
