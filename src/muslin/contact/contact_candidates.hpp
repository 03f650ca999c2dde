// ContactCandidates finds the candidate pairs: feature pairs that may touch while all points stay in their
// boxes. The candidates are kept for several iterations; contact energy and step limiter use them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "muslin/contact/contact_exemptions.hpp"
#include "muslin/contact/contact_surface.hpp"
#include "muslin/contact/distance.hpp"
#include "muslin/contact/pair_culling.hpp"
#include "muslin/contact/pair_search.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

struct ContactPair {
  std::array<int, 4> points{};  ///< vertex, triangle · a₀, a₁, b₀, b₁ · point, plane's point,
                                ///< its span (−1, −1 if it does not turn)
  int first = 0, second = 0;    ///< the features: point, triangle · edges · point, plane
  PairKind kind = PairKind::vertex_triangle;
  std::int8_t rule = -1;  ///< of the surface's rules; −1: none
  double thickness = 0;  ///< the distance of the two midsurfaces when they touch [m]
  double range = 0;      ///< the contact distance d̂ of this pair [m]: contact energy acts below this gap

  /// Returns a key that identifies the features, independent of the order of the pairs.
  std::uint64_t key() const { return key_of(kind, first, second); }
  static std::uint64_t key_of(PairKind kind, int first, int second) {
    return static_cast<std::uint64_t>(kind) << 62 | static_cast<std::uint64_t>(first) << 31 |
           static_cast<std::uint64_t>(second);
  }
  int point_count() const { return points[2] < 0 ? 2 : 4; }
};

/// The distance of a pair's features and its derivative: ∂d/∂xᵢ = weights[i] · normal.
struct PairGeometry {
  Vec3 normal = Vec3::Zero();  ///< from the second feature to the first; zero if d = 0
  double distance = 0;         ///< [m]; signed for planes
  std::array<double, 4> weights{};
};
PairGeometry pair_geometry(const ContactSurface& surface, const ContactPair& pair, ConstVectors x);

/// Returns the closest point on the feature of the thinner body [m], for messages: the centre of a ball is
/// not visible.
Vec3 visible_point(const ContactSurface& surface, const ContactPair& pair, const PairGeometry& geometry,
                   ConstVectors x);

class ContactCandidates {
 public:
  /// `rest` (#P by 3, [m]): features of one body that are closer at rest than thickness and range get smaller
  /// ones, so that a body at rest is not in contact with itself. `contact_distance`: d̂ of bodies without
  /// their own [m]. Errors: usage, if it is not positive or sizes do not fit.
  ContactCandidates(std::shared_ptr<const ContactSurface> surface, ConstVectors rest,
                    double contact_distance);

  /// Excludes pairs between features of triangle first and triangle second, and those that joints free of
  /// contact, from the next update on, instead of those of the last call; by default none are excluded.
  void ignore_pairs(std::span<const std::array<int, 2>> triangles, const ContactExemptions& joints);

  /// Excludes pairs of features with points that are free of each other, from the next update on.
  void ignore_parts(FreeParts parts) { free_parts_ = std::move(parts); }
  /// Sets the surface's rules that are in force from the next update on; by default none.
  void apply_rules(ContactRules::Set active) { active_rules_ = active; }

  /// Finds the pairs that may come within range while all points move linearly in time from `begin` to `end`
  /// (#P by 3, [m]), each within ± `margin` [m] along every axis. If no displacement exceeds `long_way` [m],
  /// each point may be anywhere between `begin` and `end` at any time; this search is faster for short
  /// displacements.
  void update(ConstVectors begin, ConstVectors end, double margin,
              double long_way = std::numeric_limits<double>::infinity());
  /// Updates only pairs with a point whose `moved` (#P) is not zero. Such a point may be anywhere between
  /// `begin` and `end` at any time; the others keep their boxes.
  void renew(std::span<const std::uint8_t> moved, ConstVectors begin, ConstVectors end, double margin);

  const ContactSurface& surface() const { return *surface_; }
  std::shared_ptr<const ContactSurface> shared_surface() const { return surface_; }
  /// Returns the largest d̂ of a pair [m].
  double longest_range() const { return longest_range_; }
  std::span<const ContactPair> pairs() const { return pairs_; }
  /// #pairs: lower bound of the distance of each pair at `found_at` [m]; 0 for planes.
  std::span<const float> least_distances() const { return least_distances_; }
  /// Positions at which those bounds hold, #P by 3 [m]: the `begin` of the last update.
  ConstVectors found_at() const { return found_at_; }
  /// The boxes for which the pairs are complete, #P: all points must be in their boxes at the same time.
  const MovingBoxes& boxes() const { return boxes_; }

 private:
  void limit_by_rest(ContactPair& pair) const;
  ContactPair make_pair(PairKind kind, int first, int second) const;
  void follow_rule(ContactPair& pair) const;
  bool passes(const ContactPair& pair) const {
    return pair.rule >= 0 && !surface_->rules()[pair.rule].touches;
  }
  bool is_free(PairKind kind, int first, int second) const;
  bool has_free_points(PairKind kind, const std::array<int, 4>& points) const;
  void free_edges(int e, int f);
  struct Near {
    std::vector<ContactPair> pairs;
    std::vector<float> distances;
  };
  /// Appends the pairs that may come into range.
  template <class Pair>
  void add_near(PairKind kind, std::span<const Pair> found, Near& out) const;
  void add_near_pairs();
  void add_near_plane(int plane);
  void add_near_turning_plane(int plane);

  std::shared_ptr<const ContactSurface> surface_;
  double contact_distance_;
  double longest_range_;  ///< of all pairs [m]
  double reach_;          ///< beyond the radii, within which the search finds pairs [m]
  ContactRules::Set active_rules_ = 0;
  PairSearch search_;
  PairCulling culling_;
  FeaturePairs found_;
  std::vector<Vec3> found_at_;
  MovingBoxes boxes_;
  std::vector<ContactPair> pairs_;
  std::vector<float> least_distances_;
  struct RestDistance {
    std::uint64_t key;
    double distance;
  };
  std::vector<RestDistance> rest_distances_;  // by key, of the close pairs alone
  std::vector<std::uint64_t> free_;           // ascending keys
  FreeParts free_parts_;                      // empty: none
};

}  // namespace muslin
