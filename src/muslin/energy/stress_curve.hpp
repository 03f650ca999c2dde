// StressCurve is a stress over strain through points: strictly increasing, with a continuous slope, so that
// its integral is a strictly convex energy with continuous second derivatives.
//
// Between two points, with s the slope of the chord and p, q > 0 those of the curve at the points, the slope
// is linear on two pieces, p → m → q. The first takes the share u of the interval, and the curve meets the
// second point if
//
//   m = 2 s − u p − (1 − u) q
//
// (a quadratic spline with one knot between points: Schumaker, On shape preserving quadratic spline
// interpolation, 1983). Slopes p, q ≤ 3/2 s leave m ≥ s/2. The curve goes on linearly with its last slope,
// and with its first one to negative strain. docs/theory/shells.md.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>

#include "muslin/core/vector_code.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

class StressCurve {
 public:
  static constexpr int most_points = 10;

  /// A straight line of this slope ≥ 0 [N/m].
  explicit StressCurve(double slope = 0);
  /// From the origin through 1 to most_points points (strain, stress [N/m]). The strains and the stresses
  /// are positive and ascend strictly.
  explicit StressCurve(std::span<const Vec2> points);

  /// This curve plus a straight line of that slope [N/m].
  StressCurve plus(double slope) const;

  /// Return the integral of the stress from 0 [N/m], the stress [N/m] and its slope [N/m] at a strain.
  MUSLIN_INLINE double energy(double strain) const {
    const double r = strain < 0 ? strain : 0;
    return pieces_[0].half_slope * (r * r) + sum(strain, [](const Piece& p, double t) {
             return t * (p.stress + t * (p.half_slope + t * p.sixth_growth));
           });
  }
  MUSLIN_INLINE double stress(double strain) const {
    return pieces_[0].slope * (strain < 0 ? strain : 0) +
           sum(strain, [](const Piece& p, double t) { return t * (p.slope + t * p.half_growth); });
  }
  MUSLIN_INLINE double slope(double strain) const {
    return pieces_[0].slope + sum(strain, [](const Piece& p, double t) { return p.growth * t; });
  }

  struct State {
    double energy, stress, slope;
  };
  /// Returns all three at a strain ≥ 0, for code that is not vectorised.
  State at(double strain) const;

  double least_slope() const;
  double greatest_slope() const;

 private:
  /// From one strain on, as far as `width`.
  struct Piece {
    double from, width, stress, slope, growth;
    double half_slope, half_growth, sixth_growth;

    void end(double at_width, double slope_there);
  };
  // Two between points, the end.
  static constexpr std::size_t piece_count = 2 * most_points + 1;

  /// The sum over all pieces of term(piece, t), t the part of the strain that lies in the piece. There are no
  /// branches, so that loops over elements vectorise.
  template <class Term>
  MUSLIN_INLINE double sum(double strain, const Term& term) const {
    return sum(strain, term, std::make_index_sequence<piece_count>());
  }
  template <class Term, std::size_t... I>
  MUSLIN_INLINE double sum(double strain, const Term& term, std::index_sequence<I...>) const {
    return (... + term(pieces_[I], part(strain, pieces_[I])));
  }
  MUSLIN_INLINE static double part(double strain, const Piece& p) {
    const double begun = strain - p.from, t = begun > 0 ? begun : 0;
    return t < p.width ? t : p.width;
  }

  static Piece straight(double from, double stress, double slope);
  void append(double width, double slope_at_end);

  std::array<Piece, piece_count> pieces_;  // in their order; those that are not used have no width
  std::size_t used_ = 1;
};

}  // namespace muslin
