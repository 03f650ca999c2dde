// CurvatureRows are curvatures B d of the triangles of a shell against rest, as sums over the deviations d of
// the hinges (energy/hinge_angles.hpp): those for which the matrix K of energy/hinge_coupling.hpp, whose
// functions make them, is that of a plate. PlateCurvatures are κ_uu along warp and κ_vv along weft.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "muslin/core/index.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

template <class Curvature>
struct CurvatureRows {
  using Square = Eigen::Matrix<double, Curvature::SizeAtCompileTime, Curvature::SizeAtCompileTime>;

  std::size_t hinge_count = 0;
  /// Triangle t has entries first[t] ≤ k < first[t + 1].
  std::vector<int> first, hinges;
  std::vector<Curvature> weights;  ///< by entry [1/m per radian]

  /// An entry of a hinge. Hinge h has uses[k] for first_use[h] ≤ k < first_use[h + 1].
  struct Use {
    int triangle = 0, entry = 0;
  };
  std::vector<int> first_use;
  std::vector<Use> uses;

  /// Fills first_use and uses.
  void find_uses();

  /// Returns the curvatures of a triangle [1/m].
  Curvature of(std::size_t triangle, std::span<const double> deviations) const {
    Curvature sum = Curvature::Zero();
    for (int k = first[triangle]; k < first[triangle + 1]; ++k)
      sum += deviations[at(hinges[at(k)])] * weights[at(k)];
    return sum;
  }
  /// Returns those of all triangles.
  std::vector<Curvature> of_all(std::span<const double> deviations) const;
  /// moments += Bᵀ `of_triangle`
  void add_transposed(std::span<const Curvature> of_triangle, std::span<double> moments) const;
  /// Returns Bᵀ `of_triangle`, by hinge.
  std::vector<double> transposed(std::span<const Curvature> of_triangle) const {
    std::vector<double> moments(hinge_count, 0.0);
    add_transposed(of_triangle, moments);
    return moments;
  }
  /// Returns the diagonal of a matrix Λ with Bᵀ C B ≤ 2 Λ, C diagonal: `of_triangle` ≥ 0.
  std::vector<double> lumped(std::span<const Curvature> of_triangle) const;
  /// Returns that of C = PᵀP, one P for each triangle.
  std::vector<double> lumped_by(std::span<const Square> roots) const;
};

using PlateCurvatures = CurvatureRows<Vec2>;

}  // namespace muslin
