// The Hessian of an incremental potential at one x, as the inner solver works with it: in float.
//
//   H = diag(identity) + couplings + block matrices + potentials of any other kind
//
// Potentials add themselves (Potential::linearize): springs as couplings, shells as block matrices, drags as
// part of the identity, everything else by its product in double.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "muslin/core/vectors.hpp"
#include "muslin/potential/block_matrix.hpp"
#include "muslin/potential/couplings.hpp"

namespace muslin {

class Potential;

class Linearization {
 public:
  /// Starts anew with H = M; potentials are added times `scale`. `fixed` vertices are left out of the
  /// preconditioner's view only: products have rows for them too.
  void reset(std::span<const double> masses, std::span<const std::uint8_t> fixed, double scale);

  std::size_t size() const { return identity_.size(); }
  double scale() const { return scale_; }

  /// The couplings of this pattern on vertices first, first + 1, …; zero when first asked for.
  Couplings& couplings(const std::shared_ptr<const CouplingPattern>& pattern, std::size_t first);
  /// The blocks of this pattern on vertices first, first + 1, …; zero when first asked for. What is added
  /// must be symmetric and positive semidefinite.
  BlockMatrix& matrix(const std::shared_ptr<const BlockPattern>& pattern, std::size_t first);
  /// H += value on vertex v; scaled already.
  void add_identity(std::size_t v, double value) { identity_.data()[v] += static_cast<float>(value); }
  /// A potential of vertices first, first + 1, … at x, kept by reference.
  void add_general(const Potential& potential, std::size_t first, ConstVectors x);
  /// The same, owned until the next `reset`.
  void add_general(std::shared_ptr<const Potential> potential, std::size_t first, ConstVectors x);

  /// Called when all potentials are in: computes the diagonal blocks.
  void finish();

  /// y = H p; returns pᵀy.
  double product(const FloatVectors& p, FloatVectors& y);

  /// Projected diagonal blocks xx, xy, xz of `upper` and yy, yz, zz of `lower`; computed by `finish`.
  const FloatVectors& upper() const { return upper_; }
  const FloatVectors& lower() const { return lower_; }
  /// Largest ‖block‖ / mass over free vertices.
  double stiffest() const { return stiffest_; }
  const std::uint8_t* fixed() const { return fixed_.data(); }
  std::span<const Couplings* const> sets() const { return sets_; }
  std::span<const BlockMatrix* const> matrices() const { return matrices_; }
  std::size_t bytes() const;

 private:
  struct General {
    const Potential* potential;
    std::size_t first;
    ConstVectors x;
  };
  std::span<const double> masses_;
  std::span<const std::uint8_t> fixed_;
  double scale_ = 1;
  double stiffest_ = 0;
  Buffer<float> identity_;
  std::vector<std::unique_ptr<Couplings>> storage_;  // reused from step to step
  std::vector<const Couplings*> sets_;               // of this x
  std::vector<std::unique_ptr<BlockMatrix>> matrix_storage_;
  std::vector<const BlockMatrix*> matrices_;
  std::vector<General> generals_;
  std::vector<std::shared_ptr<const Potential>> owned_;  // of generals_
  FloatVectors upper_, lower_;
  std::vector<Vec3> p_, y_;  // for products in double
  std::vector<Mat3> blocks_;
};

}  // namespace muslin
