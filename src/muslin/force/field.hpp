// Field is a field of vectors over space and time: a velocity of the air [m/s] or an acceleration [m/s²],
// which its user decides. docs/theory/fields.md.
#pragma once

#include <memory>
#include <optional>

#include "muslin/api.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/force/falloff.hpp"
#include "muslin/force/keyed.hpp"
#include "muslin/force/region.hpp"

namespace muslin {

/// A point of a pattern.
struct FieldSample {
  Vec3 vector;      ///< of a field of strength 1 without falloff
  double distance;  ///< [m] counted by the falloff
};

/// Directions and relative sizes of a field.
class FieldPattern {
 public:
  virtual ~FieldPattern() = default;
  /// `place` is relative to the centre of the field [m], `time` in s. Safe to call from several threads.
  virtual FieldSample at(const Vec3& place, double time) const = 0;
};

/// Place, time and strength that all fields have.
struct FieldExtent {
  KeyedNumber strength = 1;
  Window window;
  Vec3 center = Vec3::Zero();  ///< [m], at time 0
  Vec3 travel = Vec3::Zero();  ///< velocity at which centre and pattern move; the region stays [m/s]
  Falloff falloff;
  std::optional<Region> region;

  /// Returns the strength during the step from `begin` to `end`: that at the time `sampled` of the step,
  /// times the share of the step in the window.
  double strength_in(double begin, double end) const;
  double sampled(double end) const { return window.sample(end); }
  /// Returns x relative to the centre at that time.
  Vec3 place_of(const Vec3& x, double time) const { return x - center - time * travel; }
  /// Returns the weight by falloff and region of the point x, at this distance in the pattern.
  double weight(const Vec3& x, double distance) const;
};

struct Field {
  FieldExtent extent;
  std::shared_ptr<const FieldPattern> pattern;

  /// Returns the vector at x for a strength of 1.
  Vec3 at(const Vec3& x, double time) const;
};

}  // namespace muslin
