// Lattice lines: z = Σ_d T_d⁻¹ r over the three lattice axes.
//
// T_d has the projected 3×3 diagonal blocks A of the Hessian and, of its couplings, those along axis d: one
// block-tridiagonal matrix a line. A lattice's edges are much stiffer than its diagonals, so it is nearly a
// bundle of stiff lines, and what couples them is left to conjugate gradients. Along a line
//
//   D_0 = A_0,  D_i = A_i − B_{i−1} D_{i−1}⁻¹ B_{i−1},
//   w_i = D_i⁻¹ (r_i + B_{i−1} w_{i−1}),  z_i = w_i + D_i⁻¹ B_i z_{i+1},
//
// B ⪰ 0 the projected couplings. Stored is D⁻¹ = MᵀM with M lower triangular in 16-bit integers, whose
// rounding leaves it positive definite. Held vertices have M = 0: they break the lines. Each vertex that no
// lines cover has its own block only.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "muslin/potential/linearization.hpp"

namespace muslin {

class LinePreconditioner {
 public:
  /// Factors at `h`'s x. `scratch_upper` and `scratch_lower` (#V by 3 each) are overwritten.
  void factor(const Linearization& h, FloatVectors& scratch_upper, FloatVectors& scratch_lower);

  /// r −= alpha q, z = P⁻¹ r; returns rᵀz.
  double apply(float alpha, const FloatVectors& q, FloatVectors& r, FloatVectors& z) const;

  std::size_t bytes() const;

 private:
  /// The lines of one set of couplings.
  struct Body {
    const Couplings* couplings = nullptr;
    // Axis 0, 16 chains side by side: step by step the pivots (6 by 16) and couplings (4 by 16).
    std::vector<std::size_t> first_step;  // of each bundle; #bundles + 1
    Buffer<std::int16_t> chain_pivots;
    Buffer<std::uint16_t> chain_couplings;
    Buffer<float> chain_units;  // by bundle: 6 of pivots and 1 of s, by 16
    // Axes 1 and 2: six arrays in the order of the groups.
    Buffer<std::int16_t> pivots[2];
    std::vector<std::array<float, 6>> units[2];  // by group
  };
  static void factor_chains(const Linearization& h, Body& body);
  static void factor_lines(const Linearization& h, Body& body, int axis, Floats upper, Floats lower);
  static void solve_chains(const Body& body, float alpha, Floats q, Floats r, Floats z);
  double solve_lines(const Body& body, int axis, Floats r, Floats z) const;

  std::vector<Body> bodies_;
  std::vector<std::size_t> uncovered_;         // vertices
  std::vector<std::array<float, 6>> inverse_;  // M of each
  FloatVectors w_;
};

}  // namespace muslin
