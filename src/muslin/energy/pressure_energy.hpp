// PressureEnergy is the potential of a gas inside a closed surface,
//
//   W = −∫ p dV.
//
// With a constant excess pressure p over the atmosphere W = −p V; with a fixed amount of gas at a constant
// temperature
//
//   p = (p_a + p₀) V₀/V − p_a,   W = −(p_a + p₀) V₀ ln(V/V₀) + p_a (V − V₀).
//
// Below a hundredth of V₀, p continues along its tangent, so that W is finite even for a surface turned
// inside out. The Hessian is −p ∇²V − p' ∇V ∇Vᵀ: blocks along the edges, and one rank-one term.
//
// The blocks of the linear system are the positive part of −p ∇²V, edge by edge. An edge couples its ends by
// the block K = −p [e]ₓ/6, where e joins the corners opposite to the edge. The positive part is ½ K between
// the ends and ½ |p||e|/6 (1 − ê êᵀ) at both ends. The centre of a hole counts as fixed there.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "muslin/geometry/enclosed_volume.hpp"
#include "muslin/potential/potential.hpp"
#include "muslin/potential/symmetric_pattern.hpp"

namespace muslin {

/// Pressure of the gas as a function of the volume [Pa], with W and the slope of p.
struct Gas {
  double pressure = 0;     ///< p₀, excess over the atmosphere [Pa]
  double atmosphere = 0;   ///< p_a ≥ 0 [Pa]
  double rest_volume = 0;  ///< V₀ > 0 [m³]; 0: the pressure is constant

  struct At {
    double energy, pressure, slope;  ///< W [J], p [Pa], ∂p/∂V [Pa/m³]
  };
  At at(double volume) const;
};

class PressureEnergy : public Potential {
 public:
  /// Errors: usage, if the gas has a negative amount, or numbers that are not finite.
  PressureEnergy(std::shared_ptr<const EnclosedVolume> surface, const Gas& gas);

  double value(ConstVectors x) const override;
  void add_gradient(ConstVectors x, Vectors g) const override;
  void add_hessian_product(ConstVectors x, ConstVectors p, Vectors y) const override;
  void add_diagonal_blocks(ConstVectors x, std::span<Mat3> blocks) const override;
  void linearize(ConstVectors x, HessianSink& into, std::size_t first) const override;

 private:
  friend class Pressure;
  PressureEnergy(const PressureEnergy& other, const Gas& gas);

  std::shared_ptr<const EnclosedVolume> surface_;
  Gas gas_;
  std::shared_ptr<const SymmetricPattern> pattern_;
  std::shared_ptr<const std::vector<int>> slots_;  // by edge: its block; −1: of a hole
};

/// A gas that changes over time.
class Pressure : public Load {
 public:
  /// Returns the gas in a step from `begin` to `end` [s]; none if no pressure acts.
  using GasOfStep = std::function<std::optional<Gas>(double begin, double end)>;
  Pressure(std::shared_ptr<const EnclosedVolume> surface, GasOfStep gas);
  std::unique_ptr<Potential> potential(const StepContext& step) const override;

 private:
  PressureEnergy none_;
  GasOfStep gas_;
};

}  // namespace muslin
