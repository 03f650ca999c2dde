// PairDistances computes the distances of all candidate pairs at one position, once for all users: contact
// energy, step limiter, diagnostics.
//
// Most candidates are far apart, and remain so while points move: a pair that was d apart when it was found
// is at least d − max |δᵢ − δⱼ| apart now, over the displacements δ of the points i of one feature and j of
// the other since then. The closest points are computed only where this bound does not suffice.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "muslin/contact/contact_candidates.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

class PairDistances {
 public:
  /// The geometry is known for all pairs whose gap is less than this multiple of the longest contact
  /// distance of any pair.
  static constexpr double ranges_known = 1.5;

  /// `candidates` must outlive this.
  explicit PairDistances(const ContactCandidates& candidates) : candidates_(&candidates) {}

  /// Updates to points x (#P by 3, [m]); does nothing if x is unchanged.
  void update(ConstVectors x);
  /// Call when the candidates have changed: the next update recomputes all pairs.
  void forget() { x_.clear(); }

  const ContactCandidates& candidates() const { return *candidates_; }
  ConstVectors points() const { return x_; }
  /// Geometry of pair i: `weights` and `normal` only where `is_known(i)`, else only `distance`, a lower
  /// bound.
  const PairGeometry& operator[](std::size_t i) const { return geometry_[i]; }
  bool is_known(std::size_t i) const { return known_[i] != 0; }
  /// Computes the geometry of pair i if not known; several threads may call it, each for its own pairs.
  const PairGeometry& find(std::size_t i);

  /// Returns the smallest gap of all pairs [m]; infinity if it is not below the longest contact distance. A
  /// gap below it is the smallest one of the whole surface.
  double smallest_gap() const;

 private:
  const ContactCandidates* candidates_;
  std::vector<Vec3> x_;
  std::vector<PairGeometry> geometry_;
  std::vector<std::uint8_t> known_;
};

}  // namespace muslin
