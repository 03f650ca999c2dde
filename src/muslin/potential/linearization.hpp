// Linearization is the Hessian of an incremental potential at one x in float, for the inner solver.
//
//   H = diag(identity) + couplings + K,   K = block matrices + the loose rest,
//
// the loose rest being relative stiffnesses and potentials of any other kind.
//
// Potentials add themselves (Potential::linearize): springs as couplings, shells as block matrices, drags as
// part of the identity, contacts as relative stiffness, everything else by its product in double.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "muslin/core/vectors.hpp"
#include "muslin/potential/relative_stiffness.hpp"
#include "muslin/potential/spring_hessian.hpp"
#include "muslin/potential/symmetric_matrix.hpp"

namespace muslin {

class Potential;

class Linearization {
 public:
  /// Resets to H = M; potentials are added times `scale`.
  void reset(std::span<const double> masses, std::span<const std::uint8_t> fixed, double scale);

  std::size_t size() const { return identity_.size(); }
  double scale() const { return scale_; }
  std::span<const double> masses() const { return masses_; }

  /// Returns the couplings of this pattern on vertices first, first + 1, …; zero at the first request. A
  /// vertex has couplings of one pattern only.
  SpringHessian& couplings(const std::shared_ptr<const EliminationOrder>& pattern, std::size_t first);
  /// Returns the blocks of this pattern on vertices first, first + 1, …; zero at the first request. Added
  /// blocks must be symmetric and, with the masses, positive definite.
  SymmetricMatrix& matrix(const std::shared_ptr<const SymmetricPattern>& pattern, std::size_t first);
  /// Adds an empty relative stiffness between `count` vertices first, first + 1, …; terms are already scaled.
  RelativeStiffness& relative_stiffness(std::size_t first, std::size_t count);
  /// H += value on vertex v; already scaled.
  void add_identity(std::size_t v, double value) { identity_.data()[v] += static_cast<float>(value); }
  /// Adds a potential of vertices first, first + 1, … at x, kept by reference.
  void add_general(const Potential& potential, std::size_t first, ConstVectors x);

  /// Call when all potentials have been added.
  void finish();

  /// Leaves out the negative eigenvalues of the couplings.
  void project();

  /// Returns scratch memory for computing couplings and, later, for the solver; valid until the next call.
  std::span<float> workspace(std::size_t count) {
    if (workspace_.size() < count) workspace_.resize(count);
    return {workspace_.data(), count};
  }

  /// Returns the couplings of all vertices in ascending order, empty ones for vertices without any.
  std::span<const SpringHessian* const> sets() const { return sets_; }
  std::span<const SymmetricMatrix* const> matrices() const { return matrices_; }
  bool has_springs() const;
  const float* identity() const { return identity_.data(); }
  const std::uint8_t* fixed() const { return fixed_.data(); }

  /// True if K is not zero.
  bool has_remainder() const { return !matrices_.empty() || !generals_.empty() || relative_count_ > 0; }
  /// Diagonal blocks of K, with the identity positive definite: xx, xy, xz of `upper` and yy, yz, zz of
  /// `lower`, #V by 3. Relative stiffnesses are scaled down where masses would be lost to rounding.
  const FloatVectors& remainder_upper() const { return upper_; }
  const FloatVectors& remainder_lower() const { return lower_; }
  /// Returns the largest trace of a diagonal block of relative stiffnesses over the vertex's part of the
  /// identity.
  double stiffest_relative() const { return stiffest_relative_; }
  /// y += K p, #V by 3 and a zero each; returns pᵀK p.
  double add_remainder_product(const Float4* p, Float4* y);

  std::size_t bytes() const;

 private:
  struct General {
    const Potential* potential;
    std::size_t first;
    ConstVectors x;
  };
  void cover_gap(std::size_t begin, std::size_t end);
  void find_remainder_diagonal();

  std::span<const double> masses_;
  std::span<const std::uint8_t> fixed_;
  double scale_ = 1;
  Buffer<float> identity_, workspace_;
  std::vector<std::unique_ptr<SpringHessian>> storage_;  // reused from step to step
  std::vector<const SpringHessian*> sets_;               // of this x
  std::vector<std::unique_ptr<SymmetricMatrix>> matrix_storage_;
  std::vector<const SymmetricMatrix*> matrices_;
  std::vector<General> generals_;
  std::vector<std::unique_ptr<RelativeStiffness>> relatives_;  // reused from step to step
  std::size_t relative_count_ = 0;                             // of this x
  FloatVectors upper_, lower_;
  double stiffest_relative_ = 0;
  std::vector<Vec3> p_, y_;  // for products in double
  std::vector<Mat3> blocks_;
};

}  // namespace muslin
