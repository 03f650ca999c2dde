// Computes the arc tangent of a quotient in straight-line code, so that loops over it vectorise.
#pragma once

#include <numbers>

#include "muslin/core/vector_code.hpp"

namespace muslin {

/// atan2(y, x) in −π … π, within 4e-16 of its size (absolutely where it is above 1); 0 for x = y = 0. The
/// sign of a zero counts as plus. NaN gives NaN.
///
/// The quotient is brought to 0 … tan π/8, where the 13 terms of atan(t)/t in t² (a minimax fit) err by
/// 5e-20.
MUSLIN_INLINE double arc_tangent(double y, double x) {
  constexpr double tan_of_eighth = 0.41421356237309503;  // of half a turn
  constexpr double half = std::numbers::pi / 2, quarter = std::numbers::pi / 4;
  const double ay = y < 0 ? -y : y, ax = x < 0 ? -x : x;
  const bool steep = ay > ax;
  const double big = steep ? ay : ax, small = steep ? ax : ay;
  const bool turned = small > tan_of_eighth * big;
  const double below = turned ? big + small : big;
  const double t = (turned ? small - big : small) / (below > 0 || below != below ? below : 1);
  const double z = t * t;
  double s = 0.01511237643149516949;
  s = s * z - 0.033386452259033168958;
  s = s * z + 0.044994415067496043881;
  s = s * z - 0.052172979196550592472;
  s = s * z + 0.058768317098427496904;
  s = s * z - 0.066662050231780916616;
  s = s * z + 0.076922810836789009203;
  s = s * z - 0.090909080582984095118;
  s = s * z + 0.1111111108530123871;
  s = s * z - 0.14285714285329358709;
  s = s * z + 0.19999999999997010881;
  s = s * z - 0.33333333333333324196;
  const double first = t + t * (z * s);
  const double angle = turned ? quarter + first : first;
  const double of_half = steep ? half - angle : angle;
  const double of_turn = x < 0 ? std::numbers::pi - of_half : of_half;
  return y < 0 ? -of_turn : of_turn;
}

}  // namespace muslin
