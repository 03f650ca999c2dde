// EisenstatPcg applies the Hessian between the halves of an incomplete factorisation, for conjugate gradients
// without a separate preconditioner.
//
// H = L + A + Lᵀ + K in the elimination order of an EliminationOrder: A the diagonal blocks, L the couplings
// with earlier vertices, K the rest without couplings. With D_v = A⁺_v − Σ B⁺ D_u⁻¹ B⁺ over the earlier
// neighbours u of v (A⁺ and B⁺ projected to positive semidefinite: the D of a diagonal incomplete
// factorisation; Pommerell 1992, Saad 2003, § 10.3) and D = G Gᵀ, the matrix F = (D + L) G⁻ᵀ makes F Fᵀ ≈ H,
// exactly so on a line. Since H = (D + L) + (D + Lᵀ) + (A − 2D) + K, the product with
//
//   Ĥ = F⁻¹ H F⁻ᵀ,   Ĥ p = g + F⁻¹ ((A − D) t − u + K t),   t = F⁻ᵀ p,
//
// costs one sweep backwards (t, u = −Lᵀ t, g = Gᵀ t) and one forwards, hardly more than a product with H
// (Eisenstat 1981). docs/theory/eisenstat-pcg.md has the derivation. Held vertices have G⁻¹ = 0 and are
// excluded. Full couplings, which are not central forces, have D = A (symmetric Gauss-Seidel).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "muslin/solver/linearization.hpp"
#include "muslin/solver/sweep_kernels.hpp"

namespace muslin {

/// All calls refer to the Linearization passed to the last `factor`, which must not change until the next
/// `factor`.
class EisenstatPcg {
 public:
  /// Returns the largest ‖A⁺_v‖ / (mass and drag of v) over free vertices.
  double factor(Linearization& h);

  /// r̂ = F⁻¹ (scale · b), x̂ = p̂ = 0; b is #V by 3. Returns r̂ᵀr̂ = scale² bᵀ (F Fᵀ)⁻¹ b.
  double start(ConstVectors b, double scale);
  /// x̂ += alpha p̂, then p̂ = r̂ + beta p̂; returns p̂ᵀĤp̂.
  double direction(double alpha, double beta);
  /// r̂ −= alpha Ĥp̂; returns r̂ᵀr̂.
  double residual(double alpha);

  /// For another preconditioner, P⁻¹ = (F Fᵀ)⁻¹ + C. `residual`, and then r = F r̂ for C: in groups of 16 x, y
  /// and z by position, valid until the next direction.
  double residual_and_product(double alpha);
  const float* product() const { return c_; }
  /// C r, by position, to be written before the next `corrected_direction`: p̂ = r̂ + Fᵀ C r + beta p̂.
  Floats correction() const { return other_.data(); }
  double corrected_direction(double alpha, double beta);
  /// r = F r̂ after `start` or `residual`.
  void find_product();

  /// After `start`: z = scale · F⁻ᵀ r̂, #V by 3.
  void precondition(double scale, Vectors z);

  /// s = scale · F⁻ᵀ (x̂ + alpha p̂), #V by 3.
  void solution(double alpha, double scale, Vectors s);

  std::size_t bytes() const;

 private:
  /// One set of couplings and its first group among all.
  struct Part {
    const SpringHessian* couplings = nullptr;
    const FullCouplings* full = nullptr;  ///< replaces them, if not null
    std::size_t first_group = 0;
    const sweep_kernels::Kernels& kernels() const {
      return sweep_kernels::kernels(full ? sweep_kernels::Couplings::full
                                         : sweep_kernels::Couplings::central);
    }
  };
  sweep_kernels::Sweep sweep(const Part& part, int task) const;
  template <class Body>
  double forward(const Body& body) const;
  template <class Body>
  double backward(const Body& body) const;
  template <class Value, class Body>
  void for_each_vertex(const Value* by_vertex, const Body& body) const;
  double add_remainder_product();
  void solve_backward(double alpha, const float* p, double scale, Vectors s);
  void arrange_identity();

  Linearization* h_ = nullptr;
  std::vector<Part> parts_;
  std::size_t group_count_ = 0;
  Buffer<float> identity_, rest_;
  // Sources of identity_ and free_, and their patterns: usually the same from step to step.
  std::vector<float> identity_by_vertex_;
  std::vector<std::uint8_t> fixed_by_vertex_;
  std::vector<std::shared_ptr<const EliminationOrder>> patterns_;
  Buffer<std::uint32_t> pivots_, excess_;
  Buffer<float> pivot_units_, excess_units_;
  std::vector<std::uint16_t> free_;
  /// Vectors by group, in memory of h_: c = Gᵀ t + G⁻¹ ((A − D) t − u), `further_` = K t.
  float *r_ = nullptr, *p_ = nullptr, *x_ = nullptr, *c_ = nullptr, *further_ = nullptr;
  FloatVectors flat_;
  FloatVectors other_;          // beside flat_, for corrections
  Buffer<Float4> t_, product_;  // t and K t by vertex
};

}  // namespace muslin
