// BarStencil is a bar between two vertices. Its measure is the strain ε = |z|/r − 1, z from vertex 0 to
// vertex 1, r the length at rest. Laws give, with the weight of the element in their constants,
//
//   energy     ψ(ε) [J]
//   tension    ψ'(ε) [J]
//   slope      ψ''(ε) [J]
//
// and with n = z/|z| the stiffness is ψ''/r² n nᵀ + ψ'/(r |z|) (I − n nᵀ); projected it is without a negative
// second term. A bar shorter than 1e-12 r has no direction and exerts no force.
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "muslin/core/vector_code.hpp"
#include "muslin/energy/element_energy.hpp"
#include "muslin/energy/element_slabs.hpp"
#include "muslin/energy/law.hpp"

namespace muslin {

class BarStencil {
 public:
  static constexpr int corners = 2;

  /// `lengths` at rest by element [m].
  BarStencil(const ElementSlabs<2>& slabs, std::span<const double> lengths)
      : rest_(slabs.by_entry<double>([&](std::size_t e) { return lengths[e]; })) {}
  /// r of a batch.
  const double* at(int first) const { return rest_.data() + first; }

  /// Bars use no masses.
  void find_held(int, int, std::span<const double>, const std::vector<std::array<int, 2>>&,
                 MassBound&) const {}

  /// The stiffness `across` I + `turned` n nᵀ.
  template <class Law>
  struct Stiff {
    double n[3][element_lanes], turned[element_lanes], across[element_lanes];
  };

  template <class Law>
  MUSLIN_VECTOR_CODE static bool energies(const LawLanes<Law>& law, const double* rest, const Batch<2>& x,
                                          double* w) {
    Direction d;
    find_direction(rest, x, d);
    double energy[element_lanes];
    for (int l = 0; l < element_lanes; ++l) energy[l] = Law::energy(law[l], d.strain[l]);
    for (int l = 0; l < element_lanes; ++l) w[l] = energy[l];
    return true;
  }

  template <class Law>
  MUSLIN_VECTOR_CODE static bool forces(const LawLanes<Law>& law, const double* rest, const Batch<2>& x,
                                        Batch<2>& force, double* w) {
    Direction d;
    find_direction(rest, x, d);
    double energy[element_lanes], pull[element_lanes];
    for (int l = 0; l < element_lanes; ++l) {
      energy[l] = Law::energy(law[l], d.strain[l]);
      pull[l] = Law::tension(law[l], d.strain[l]) / rest[l];
    }
    for (int l = 0; l < element_lanes; ++l) w[l] = energy[l];
    for (int k = 0; k < 3; ++k) {
      for (int l = 0; l < element_lanes; ++l) {
        force[1][k][l] = pull[l] * d.n[k][l];
        force[0][k][l] = -force[1][k][l];
      }
    }
    return true;
  }

  template <class Law>
  MUSLIN_VECTOR_CODE static bool stiffen(Stiffness kind, const LawLanes<Law>& law, const double* rest,
                                         const MassBound&, const Batch<2>& x, Stiff<Law>& out) {
    Direction d;
    find_direction(rest, x, d);
    for (int l = 0; l < element_lanes; ++l) {
      const double along = Law::slope(law[l], d.strain[l]) / (rest[l] * rest[l]);
      const double turning = Law::tension(law[l], d.strain[l]) * d.over_length[l] / rest[l];
      const bool kept = kind == Stiffness::exact || (kind != Stiffness::material && turning > 0);
      out.across[l] = kept ? turning : 0;
      out.turned[l] = along - out.across[l];
      for (int k = 0; k < 3; ++k) out.n[k][l] = d.n[k][l];
    }
    return true;
  }

  template <class Law>
  MUSLIN_VECTOR_CODE static void multiply(const LawLanes<Law>&, const double*, const Stiff<Law>& stiff,
                                          const Batch<2>& p, Batch<2>& y) {
    for (int l = 0; l < element_lanes; ++l) {
      double d[3], along = 0;
      for (int k = 0; k < 3; ++k) {
        d[k] = p[1][k][l] - p[0][k][l];
        along += stiff.n[k][l] * d[k];
      }
      for (int k = 0; k < 3; ++k) {
        y[1][k][l] = stiff.across[l] * d[k] + stiff.turned[l] * along * stiff.n[k][l];
        y[0][k][l] = -y[1][k][l];
      }
    }
  }

  template <class Law>
  static void add_corner_block(const LawLanes<Law>&, const double*, const Stiff<Law>& stiff, int l, int,
                               Mat3& block) {
    const Vec3 n(stiff.n[0][l], stiff.n[1][l], stiff.n[2][l]);
    block += stiff.turned[l] * n * n.transpose();
    block.diagonal().array() += stiff.across[l];
  }

  /// For rows of corners with a bit in `rows`. The blocks are symmetric.
  template <class Law>
  static void add_pair_blocks(const LawLanes<Law>& law, const double* rest, const Stiff<Law>& stiff,
                              double scale, int count, const unsigned* rows,
                              const ElementSlabs<2>::Slots* slots, Float4* blocks) {
    for (int l = 0; l < count; ++l) {
      Mat3 block = Mat3::Zero();
      add_corner_block(law, rest, stiff, l, 0, block);
      const int* slot = slots[l].data();
      for (int i = 0; i < 2; ++i) {
        for (int j = i; j < 2; ++j, ++slot) {
          const int row = *slot >= 0 ? i : j;
          if ((rows[l] >> row & 1U) == 0) continue;
          Float4* const into = blocks + 3 * static_cast<std::ptrdiff_t>(*slot >= 0 ? *slot : ~*slot);
          const double sign = i == j ? scale : -scale;
          for (int k = 0; k < 3; ++k)
            into[k] += Float4{static_cast<float>(sign * block(0, k)), static_cast<float>(sign * block(1, k)),
                              static_cast<float>(sign * block(2, k)), 0};
        }
      }
    }
  }

 private:
  struct Direction {
    double n[3][element_lanes], strain[element_lanes];
    double over_length[element_lanes];  // 1/|z|
  };

  MUSLIN_INLINE static void find_direction(const double* rest, const Batch<2>& x, Direction& d) {
    for (int l = 0; l < element_lanes; ++l) {
      double z[3], square = 0;
      for (int k = 0; k < 3; ++k) {
        z[k] = x[1][k][l] - x[0][k][l];
        square += z[k] * z[k];
      }
      const double length = std::sqrt(square);
      d.over_length[l] = length > 1e-12 * rest[l] ? 1 / length : 0;
      d.strain[l] = length / rest[l] - 1;
      for (int k = 0; k < 3; ++k) d.n[k][l] = d.over_length[l] * z[k];
    }
  }

  std::vector<double> rest_;  // by entry [m]
};

}  // namespace muslin
