// CachedSurfaces puts the surfaces of a run together from its caches, as contact saw them, and examines them.
// Triangles that cross are found by contact/intersections.hpp, which shares no code with the step limiter.
//
// Positions come from the caches, in single precision: the report is about what was written. Their rounding,
// 6e-8 of a coordinate, is a hundred times below the gap that contact keeps in a scene of common size.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "muslin/cache/contact_record.hpp"
#include "muslin/cache/run_reader.hpp"
#include "muslin/contact/contact_model.hpp"
#include "muslin/contact/crossings.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

/// Two surfaces next to each other.
struct Gap {
  double size = 0;  ///< thickness taken off [m]
  std::string first_body, second_body;
  Vec3 at = Vec3::Zero();  ///< where, on the thinner body [m]
};

class CachedSurfaces {
 public:
  /// `run` must outlive this. Errors: input, if the record does not fit the caches.
  CachedSurfaces(const RunReader& run, const ContactRecord& record);

  std::size_t triangle_count() const { return contact_.surface->triangles().size(); }

  /// Returns the points of all surfaces at a frame [m]. Errors: file.
  std::vector<Vec3> points(int frame) const;
  /// Returns the triangles that cross by exact arithmetic at the points of a frame, and points inside of
  /// balls and capsules or beneath planes.
  std::vector<Crossing> crossings(int frame, ConstVectors points) const;
  /// Returns the smallest gap at the points of a frame; nothing if all are wider than the contact distance.
  std::optional<Gap> smallest_gap(int frame, ConstVectors points) const;

  /// Returns one line about a crossing: which faces of which bodies, and where.
  std::string describe(const Crossing& crossing) const { return muslin::describe(contact_, crossing); }

 private:
  double time(int frame) const { return frame / run_.frame_rate(); }

  const RunReader& run_;
  std::vector<ContactRecord::Body> bodies_;
  std::vector<std::vector<int>> origins_;  // the points of the caches, where not all are of the surface
  std::vector<int> places_;  ///< #bodies_, in the run
  ContactModel contact_;
};

}  // namespace muslin
