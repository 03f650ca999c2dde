// HingeLaw is a linear elastic hinge: ψ = ½ k w².
#pragma once

#include <array>
#include <limits>

#include "muslin/core/vector_code.hpp"
#include "muslin/energy/law.hpp"

namespace muslin {

struct HingeLaw {
  struct Constants {
    double stiffness;  // k [N·m]
  };
  static constexpr bool linear = true;

  static constexpr double none = std::numeric_limits<double>::infinity();
  static constexpr std::array<LawParameter, 3> parameters = {{
      {"bending_warp", "N·m", 0, none, false, "Moment per width and curvature of warp threads that bend."},
      {"bending_weft", "N·m", 0, none, false, "Moment per width and curvature of weft threads that bend."},
      {"bending_bias", "N·m", 0, none, false, "Moment per width and curvature at 45° between them."},
  }};

  MUSLIN_INLINE static double energy(const Constants& c, double w) { return 0.5 * c.stiffness * w * w; }
  MUSLIN_INLINE static double moment(const Constants& c, double w) { return c.stiffness * w; }
  MUSLIN_INLINE static double curvature(const Constants& c, double) { return c.stiffness; }
};

}  // namespace muslin
