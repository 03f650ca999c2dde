// Kernels holds the arithmetic of EisenstatPcg on groups of 16 vertices, compiled for several instruction
// sets. All versions give the same bits.
#pragma once

#include <cstdint>
#include <span>

#include "muslin/solver/elimination_order.hpp"
#include "muslin/solver/float_vectors.hpp"
#include "muslin/solver/full_couplings.hpp"

namespace muslin::sweep_kernels {

inline constexpr int lanes = EliminationOrder::lanes;
inline constexpr int vector_size = 3 * lanes;  ///< floats of a group in a vector: 16 x, 16 y, 16 z
inline constexpr int matrix_size = 6 * lanes;  ///< xx, yx, zx, yy, zy, zz by 16
inline constexpr int packed_size = 4 * lanes;  ///< words of the same as integers of 21 bits

/// 3×3 matrices of 16 lanes by group, integers times a unit of the group.
struct PackedMatrices {
  std::uint32_t* words = nullptr;
  float* units = nullptr;
};

/// Couplings as SpringHessian or as FullCouplings stores them.
enum class Couplings : std::uint8_t { central, full };

/// Groups group_begin … group_end − 1 of a pattern. Vectors by group, `flat` by position.
struct Sweep {
  int group_begin = 0, group_end = 0;
  const EliminationOrder::Group* groups = nullptr;
  const EliminationOrder::Block* blocks = nullptr;
  const EliminationOrder::Link* links = nullptr;
  const std::uint32_t* coefficients = nullptr;
  const float* units = nullptr;
  PackedMatrices pivots;  ///< M, lower triangular
  PackedMatrices excess;  ///< A − D, D = (MᵀM)⁻¹ of the M that is stored
  Floats flat;            ///< read by neighbours
};

struct Diagonal {
  const float* identity = nullptr;      ///< by position
  const std::uint16_t* free = nullptr;  ///< by group, bit l: lane l has a vertex that is free to move
  const float* rest = nullptr;          ///< by group, further diagonal blocks; null if none
};

struct Kernels {
  /// Computes M and A − D of each group, in ascending order; `upper` (m00, m10, m20) and `lower` (m11, m21,
  /// m22), by position, receive M for the later groups, if couplings are central. Returns the largest
  /// ‖A‖² / identity² of a free vertex.
  float (*factor)(const Sweep& sweep, const Diagonal& diagonal, Floats upper, Floats lower);
  /// r = F⁻¹ r; returns rᵀr.
  double (*solve_forward)(const Sweep& sweep, float* r);
  /// x += alpha p, p = r + beta p, flat = t = F⁻ᵀ p, c = g + M e with g = p + M u and e = (A − D) t − u, u
  /// the product of the later neighbours' couplings with t. Returns pᵀg + tᵀe = tᵀH t.
  double (*direction)(const Sweep& sweep, float alpha, float beta, const float* r, float* x, float* p,
                      float* c);
  /// r −= alpha (g + F⁻¹ (e + further)) after `direction`; returns rᵀr. `further` by group, null if zero.
  double (*residual)(const Sweep& sweep, float alpha, float* c, const float* further, float* r);
  /// flat = F⁻ᵀ (x + alpha p).
  void (*solve_backward)(const Sweep& sweep, float alpha, const float* x, const float* p);
  /// As `residual`, and then c = F r; `other` is room by position, which receives Mᵀ r.
  double (*residual_and_product)(const Sweep& sweep, float alpha, float* c, const float* further, float* r,
                                 Floats other);
  /// As `direction` with p = r + Fᵀ of `correction` (by position) + beta p.
  double (*corrected_direction)(const Sweep& sweep, float alpha, float beta, const float* r, float* x,
                                float* p, float* c, Floats correction);
};

/// Returns the best kernels for this processor.
const Kernels& kernels(Couplings kind);
/// Returns all kernels that this processor can run, the most basic first: tests compare their bits.
std::span<const Kernels* const> all_kernels(Couplings kind);

}  // namespace muslin::sweep_kernels
