// Joints are pairs of points of bodies that an attachment holds together; JointPotential is an energy of the
// vectors between them.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "muslin/core/vectors.hpp"
#include "muslin/potential/potential.hpp"

namespace muslin {

/// The first point of joint j minus its second one is z = Σ wᵢ xᵢ over its weights.
struct Joints {
  struct Weight {
    int vertex = 0;  ///< of the model
    double weight = 0;
  };
  std::vector<Weight> weights;             ///< of all joints, each vertex once per joint
  std::vector<std::size_t> offsets = {0};  ///< #joints + 1, into weights
  std::vector<double> stiffness;           ///< #joints [N/m]
  std::vector<double> damping;             ///< #joints [N·s/m]
  std::vector<double> strength;            ///< #joints, the force that breaks it [N]; or infinity

  std::size_t size() const { return stiffness.size(); }
  std::span<const Weight> of(std::size_t j) const {
    return std::span(weights).subspan(offsets[j], offsets[j + 1] - offsets[j]);
  }
  /// Adds the points of a new joint, each as a weighted sum; the caller adds its constants.
  void add_points(std::span<const Weight> first, std::span<const Weight> second);
  /// Returns z of joint j.
  Vec3 apart(std::size_t j, ConstVectors x) const;
};

/// The answer of a joint to its z: energy [J], its gradient with respect to z [N], and its Hessian
/// along n nᵀ + across (I − n nᵀ) [N/m], of which `across` may be negative.
struct JointAnswer {
  double energy = 0;
  Vec3 gradient = Vec3::Zero();
  Vec3 normal = Vec3::UnitX();  ///< n, of length 1
  double along = 0, across = 0;
};

/// Σ over the joints that act. Derivatives follow from those of one joint.
class JointPotential : public Potential {
 public:
  JointPotential(std::shared_ptr<const Joints> joints, std::vector<std::size_t> acting);

  double value(ConstVectors x) const override;
  void add_gradient(ConstVectors x, Vectors g) const override;
  void add_hessian_product(ConstVectors x, ConstVectors p, Vectors y) const override;
  void add_diagonal_blocks(ConstVectors x, std::span<Mat3> blocks) const override;
  void linearize(ConstVectors x, HessianSink& into, std::size_t first) const override;

 protected:
  virtual JointAnswer answer(std::size_t j, const Vec3& z) const = 0;
  const Joints& joints() const { return *joints_; }
  const std::vector<std::size_t>& acting() const { return acting_; }

 private:
  std::shared_ptr<const Joints> joints_;
  std::vector<std::size_t> acting_;
};

}  // namespace muslin
