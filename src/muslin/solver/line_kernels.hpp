// The arithmetic of lattice lines on stretches of vertices: vector code behind LinePreconditioner.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "muslin/potential/float_vectors.hpp"

namespace muslin::line_kernels {

inline constexpr int lanes = 16;

/// Couplings of consecutive vertices with their neighbours along a line: B = q s sᵀ + max(t, 0) I.
struct CouplingStretch {
  const std::uint16_t* sx = nullptr;
  const std::uint16_t* sy = nullptr;
  const std::uint16_t* sz = nullptr;
  const std::uint16_t* t = nullptr;
  float q = 0;
};
/// Six arrays m00, m10, m20, m11, m21, m22 of the lower triangular M, in units.
struct PivotStretch {
  std::array<const std::int16_t*, 6> m;
  const float* unit;
};

/// w = MᵀM r, or with neighbours w = MᵀM (r + B w_neighbour).
void forward(int n, PivotStretch pivots, Floats r, Floats w);
void forward(int n, PivotStretch pivots, Floats r, CouplingStretch b, Floats neighbour, Floats w);
/// With neighbours w += MᵀM B w_neighbour; then z += w.
void backward(int n, Floats w, Floats z);
void backward(int n, PivotStretch pivots, CouplingStretch b, Floats neighbour, Floats w, Floats z);
/// As backward; returns rᵀz.
double dot(int n, Floats r, Floats z);

/// M of D = A − B D_neighbour⁻¹ B, with D_neighbour⁻¹ = NᵀN (none: D = A), zero where fixed. Matrices are
/// six components in two triples; M may overwrite A.
void factor(int n, Floats a_upper, Floats a_lower, const std::uint8_t* fixed, Floats m_upper, Floats m_lower);
void factor(int n, Floats a_upper, Floats a_lower, const std::uint8_t* fixed, CouplingStretch b,
            Floats n_upper, Floats n_lower, Floats m_upper, Floats m_lower);
float largest_entry(int n, const float* m);
void quantise(int n, const float* m, float per_unit, std::int16_t* out);

/// One bundle of chains, `steps` long. Arrays by step, component, lane. buffer holds r (3 by 16) and
/// receives z; pivots 6 by 16, couplings 4 by 16 (to the next step); units: 6 by 16 of the pivots, then 16 of
/// s.
void solve_bundle(int steps, const std::int16_t* pivots, const std::uint16_t* couplings, const float* units,
                  float* buffer);
/// One step of factoring: a (6 by 16), b (s by √q and max(t, 0): 4 by 16) to the step before, its M, and M
/// out.
void factor_lanes(const float* a, const float* b, const float* before, float* m);

/// Stores pivots and couplings of a bundle in units, 7 by 16 of which `per_unit` is the inverse.
void quantise_bundle(int steps, const float* pivots, const float* couplings, const float* per_unit,
                     std::int16_t* pivots_out, std::uint16_t* couplings_out);
/// The float whose upper half these bits are.
inline float cut_float(std::uint16_t bits) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(bits) << 16);
}
/// One vertex by itself: r −= alpha q, z = MᵀM r; returns rᵀz.
double update_and_solve(float alpha, const std::array<float, 6>& m, Floats q, Floats r, Floats z);

/// Chains to lanes and back: to[(step·3 + c)·16 + lane].
void gather(int steps, int lane, Floats r, float* to);
void update_and_gather(int steps, int lane, float alpha, Floats q, Floats r, float* to);
void scatter(int steps, int lane, const float* from, Floats z);

}  // namespace muslin::line_kernels
