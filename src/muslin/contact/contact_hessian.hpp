// ContactHessian stores the positive semidefinite Hessian of contact at one position, ready for many
// products:
//
//   H = Σ Aᵀ (a n nᵀ + b (I − n nᵀ)) A,   A u = Σ wᵢ (J u)ᵢ + Σ wⱼ uⱼ the relative motion at a contact.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "muslin/contact/surface_map.hpp"
#include "muslin/potential/potential.hpp"
#include "muslin/potential/step_guard.hpp"

namespace muslin {

struct ContactRow {
  std::array<int, 4> points{};  ///< −1: none
  std::array<double, 4> weights{};
  Vec3 normal = Vec3::Zero();
  double normal_stiffness = 0;  ///< a ≥ 0 [N/m]
  double tangential = 0;        ///< b ≥ 0 [N/m]
  /// Further vertices with their weights, besides the points.
  std::span<const SurfaceMap::Entry> carried;
};

/// As a potential, this is the quadratic ½ qᵀ H q.
class ContactHessian : public Potential {
 public:
  ContactHessian(const SurfaceMap& map, const std::vector<ContactRow>& rows);

  double value(ConstVectors q) const override;
  void add_gradient(ConstVectors q, Vectors g) const override { add_hessian_product(q, q, g); }
  void for_each_row(const std::function<void(const StepGuard::Contact&)>& visit) const;
  void add_hessian_product(ConstVectors q, ConstVectors p, Vectors y) const override;
  void add_diagonal_blocks(ConstVectors q, std::span<Mat3> blocks) const override;
  void linearize(ConstVectors q, HessianSink& into, std::size_t first) const override;

 private:
  struct Stiffness {
    Vec3 normal;
    double a, b;
    Vec3 times(const Vec3& r) const { return b * r + (a - b) * normal.dot(r) * normal; }
  };
  std::span<const StepGuard::Weight> weights(std::size_t row) const;
  Vec3 relative(std::size_t row, ConstVectors p) const;

  std::size_t vertex_count_;
  std::vector<Stiffness> rows_;
  std::vector<int> offsets_;  ///< of the rows' weights
  std::vector<StepGuard::Weight> weights_;
};

}  // namespace muslin
