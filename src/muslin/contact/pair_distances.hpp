// How far apart the features of all candidate pairs are at one place, found once for all who ask: contact
// energy, step limiter, diagnostics.
//
// Most candidates are far apart, and remain so while points move: a pair that was d apart when it was found
// is at least d − max |δᵢ − δⱼ| apart now, over the ways δ of the points i of one feature and j of the other
// since then. Only where that is not enough are the closest points found.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "muslin/contact/contact_candidates.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

class PairDistances {
 public:
  /// The geometry of all pairs is known whose gap is less than this share of the contact distance.
  static constexpr double ranges_known = 1.5;

  /// `candidates` must outlive this.
  explicit PairDistances(const ContactCandidates& candidates) : candidates_(&candidates) {}

  /// To points x (#P by 3, [m]); does nothing if they are there already.
  void update(ConstVectors x);
  /// The candidates have changed: the next update looks at all anew.
  void forget() { x_.clear(); }

  const ContactCandidates& candidates() const { return *candidates_; }
  ConstVectors points() const { return x_; }
  /// Of pair i: `weights` and `normal` only where `is_known(i)`, else `distance` is a lower bound alone.
  const PairGeometry& operator[](std::size_t i) const { return geometry_[i]; }
  bool is_known(std::size_t i) const { return known_[i] != 0; }
  /// Pair i, made known; several threads may ask, each for pairs of its own.
  const PairGeometry& find(std::size_t i);

  /// The smallest distance less thickness of all pairs, if that is below the contact distance: then it is
  /// that of the whole surface; infinite otherwise [m].
  double smallest_gap() const;

 private:
  const ContactCandidates* candidates_;
  std::vector<Vec3> x_;
  std::vector<PairGeometry> geometry_;
  std::vector<std::uint8_t> known_;
};

}  // namespace muslin
