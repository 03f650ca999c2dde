// Finds and describes crossings, from which contact cannot start: surfaces that cross or are closer than
// their thickness allows.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "muslin/core/error.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

struct ContactModel;

struct Crossing {
  enum class Kind {
    crossing,   ///< two triangles meet, by the exact test
    too_close,  ///< within their thicknesses, or a vertex inside a ball or capsule
    beneath,    ///< a vertex beneath a plane
  };
  Kind kind = Kind::crossing;
  int first_body = 0, second_body = 0;  ///< of the surface
  /// Triangles of the surface; −1 for a plane, or for a vertex that belongs to no triangle.
  int first_triangle = -1, second_triangle = -1;
  Vec3 at = Vec3::Zero();  ///< where [m]

  friend bool operator==(const Crossing&, const Crossing&) = default;
};

/// Returns the first `limit` crossings at q (#V by 3, [m]) under the rules in force at `time` [s]: first
/// triangles that meet, in ascending order, then pairs that are too close; each pair of triangles once. Pairs
/// of bodies that may not touch are left out. Errors: usage, if a position is not finite.
std::vector<Crossing> find_crossings(const ContactModel& model, ConstVectors q, double time = 0,
                                     std::size_t limit = 1000000);

/// Returns the first crossing of each pair of faces. Two polygons of the user's mesh may cross in several
/// pairs of their triangles.
std::vector<Crossing> one_of_each_pair(const ContactModel& model, std::span<const Crossing> found);

/// Returns one line, such as: face 12 of "cloth" crosses face 3 of "table" near (0.1, 0.2, 0.3) m.
std::string describe(const ContactModel& model, const Crossing& crossing);

/// Returns the bodies with their numbers of crossings, such as: 60 of "shirt" and "arm", 2 of "shirt" with
/// itself.
std::string describe_bodies(const ContactModel& model, std::span<const Crossing> found);

/// Returns advice on removing the crossings: move bodies apart, or weld a mesh with coincident vertices.
std::string advice(const ContactModel& model, ConstVectors q, std::span<const Crossing> found);

/// Throws Error(input) at `place` that lists the first few crossings, if there are any.
void refuse_crossings(const ContactModel& model, ConstVectors q, double time = 0, const Place& place = {});

}  // namespace muslin
