// StretchLimitLaw puts a barrier on the principal stretches λ₁ ≥ λ₂ of a triangle,
//
//   κ (ψ(λ₁) + ψ(λ₂)),
//
// with ψ and the eigenvalues of the Hessian as given in stretch_limit.hpp.
#pragma once

#include <algorithm>
#include <cmath>

#include "muslin/core/vector_code.hpp"
#include "muslin/energy/law.hpp"
#include "muslin/energy/triangle_stencil.hpp"

namespace muslin {

/// ψ.
class StretchBarrier {
 public:
  /// s₁ > 1. Errors: usage.
  explicit StretchBarrier(double limit);

  struct Numbers {
    double limit, onset, width;
    double stiff;                    ///< the stretch where the parabola begins
    double value, slope, curvature;  ///< of ψ there
  };
  explicit StretchBarrier(const Numbers& numbers) : n_(numbers) {}

  struct Law {
    double value = 0, slope = 0, curvature = 0;  ///< ψ, ψ', ψ''
  };
  Law at(double stretch) const {
    if (!(stretch > n_.onset)) return {};
    if (stretch < n_.stiff) return barrier((stretch - n_.onset) / n_.width);
    const double beyond = stretch - n_.stiff;
    return {n_.value + beyond * (n_.slope + 0.5 * n_.curvature * beyond), n_.slope + n_.curvature * beyond,
            n_.curvature};
  }

  double onset() const { return n_.onset; }
  double limit() const { return n_.limit; }
  const Numbers& numbers() const { return n_; }

 private:
  Law barrier(double u) const {  // at u < 1
    const double log = std::log(1 - u), steep = u / (1 - u);
    return {-n_.width * n_.width * u * u * log, n_.width * u * (steep - 2 * log),
            steep * (4 + steep) - 2 * log};
  }

  Numbers n_;
};

struct StretchLimitLaw {
  struct Constants {
    double stiffness;  // κ [N/m]
    StretchBarrier::Numbers barrier;
  };
  static constexpr bool principal = true;

  /// mean + radius > onset², without the root.
  MUSLIN_INLINE static double excess(const Constants& c, const Metric& m) {
    const double square = c.barrier.onset * c.barrier.onset;
    const double half = 0.5 * (m.aa - m.bb), room = square - 0.5 * (m.aa + m.bb);
    const double radius_squared = half * half + m.ab * m.ab;
    return room < 0 ? 1 : radius_squared - room * room;
  }
  MUSLIN_INLINE static double energy(const Constants& c, double area, const Metric& m) {
    const Principal p = principal_of(c, m);
    return c.stiffness * area * (p.law[0].value + p.law[1].value);
  }
  MUSLIN_INLINE static PlaneStress stress(const Constants& c, double area, const Metric& m) {
    const Principal p = principal_of(c, m);
    const double force = c.stiffness * area, high = pull(p, 0), low = pull(p, 1);
    const double mean = 0.5 * (high + low), deviator = 0.5 * (high - low);
    return {force * (mean + deviator * p.cosine), force * (mean - deviator * p.cosine),
            force * (deviator * p.sine)};
  }
  /// With δᵢ = dF vᵢ and fᵢ = F vᵢ,
  ///
  ///   d²W/(A κ) = Σ (hᵢ (fᵢ·δᵢ)² + gᵢ δᵢ²) + G (f₁·δ₂ + f₂·δ₁)²,   gᵢ = ψ'ᵢ/λᵢ,   hᵢ = (ψ''ᵢ − gᵢ)/λᵢ².
  MUSLIN_INLINE static PrincipalStiffness principal_stiffness(const Constants& c, double area,
                                                              const Metric& m, bool material) {
    const Principal p = principal_of(c, m);
    double along[2], of_pull[2];
    for (int i = 0; i < 2; ++i) {
      of_pull[i] = material ? 0 : pull(p, i);
      const double change = p.law[i].curvature - of_pull[i], square = p.stretch[i] * p.stretch[i];
      along[i] = p.law[i].curvature > 0 ? c.stiffness * change / square : 0;
    }
    const double across = material ? 0 : c.stiffness * shear_stiffness(c, p);
    return {p.cosine,
            p.sine,
            {along[0], 0, along[1], across},
            {c.stiffness * area * of_pull[0], c.stiffness * area * of_pull[1], 0}};
  }

 private:
  /// The energy of a triangle in its principal directions, κ = 1 and per area.
  struct Principal {
    StretchBarrier::Law law[2];  // of the larger stretch and of the smaller one
    double stretch[2];
    double cosine, sine;  // of twice the angle from warp to the larger stretch
    double radius;        // half the difference of the squares of the stretches
  };
  /// Stretches closer to each other than this share of the range from onset to limit count as equal where
  /// their difference is a divisor.
  static constexpr double equal = 1e-6;

  MUSLIN_INLINE static Principal principal_of(const Constants& c, const Metric& m) {
    const StretchBarrier barrier(c.barrier);
    const double mean = 0.5 * (m.aa + m.bb), half = 0.5 * (m.aa - m.bb);
    Principal p;
    p.radius = std::sqrt(half * half + m.ab * m.ab);
    p.cosine = p.radius > 0 ? half / p.radius : 1;
    p.sine = p.radius > 0 ? m.ab / p.radius : 0;
    p.stretch[0] = std::sqrt(mean + p.radius);
    p.stretch[1] = std::sqrt(std::max(mean - p.radius, 0.0));
    p.law[0] = barrier.at(p.stretch[0]);
    p.law[1] = barrier.at(p.stretch[1]);
    return p;
  }
  /// ψ'/λ: the stress in a principal direction. Below the onset it is zero.
  MUSLIN_INLINE static double pull(const Principal& p, int i) {
    return p.law[i].slope > 0 ? p.law[i].slope / p.stretch[i] : 0;
  }
  /// G = (ψ'(λ₁)/λ₁ − ψ'(λ₂)/λ₂) / (λ₁² − λ₂²). Where the stretches are all but equal, a difference of
  /// rounded numbers is meaningless; there it is the derivative of ψ'/λ halfway between them, over 2 λ.
  MUSLIN_INLINE static double shear_stiffness(const Constants& c, const Principal& p) {
    const double high = p.stretch[0], low = p.stretch[1];
    if (2 * p.radius > equal * (c.barrier.limit - c.barrier.onset) * (high + low))
      return (pull(p, 0) - pull(p, 1)) / (2 * p.radius);
    const double middle = 0.5 * (high + low);
    const StretchBarrier::Law law = StretchBarrier(c.barrier).at(middle);
    if (law.curvature == 0) return 0;
    return (law.curvature - law.slope / middle) / (2 * middle * middle);
  }
};

}  // namespace muslin
