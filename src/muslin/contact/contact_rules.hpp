// ContactRules change how pairs of features of a contact surface meet, in place of what their bodies say.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "muslin/core/keyed_number.hpp"

namespace muslin {

/// How the features of one set of points meet those of another. A feature belongs to a set if any of its
/// points does. What has no value here is as the bodies say.
struct ContactRule {
  std::array<std::vector<int>, 2> sides;  ///< points of the surface; both may be the same
  bool touches = true;                    ///< false: they pass through each other
  /// Distance of the midsurfaces when they touch [m]; balls and capsules add their radius.
  std::optional<double> thickness;
  std::optional<double> range;                                       ///< d̂ [m]
  std::optional<KeyedNumber> friction;                               ///< Coulomb's μ
  std::optional<double> stiffness;                                   ///< [N/m]
  double from = 0, until = std::numeric_limits<double>::infinity();  ///< [s]
};

/// Immutable.
class ContactRules {
 public:
  /// Rules of which those in force have their bit.
  using Set = std::uint64_t;
  static constexpr std::size_t most = 64;

  ContactRules() = default;
  /// For points 0 … point_count − 1. Errors: usage, if there are more than `most` rules, a point does not
  /// exist, a thickness or friction is negative, or a range or stiffness not positive.
  ContactRules(std::vector<ContactRule> rules, std::size_t point_count);

  bool empty() const { return rules_.empty(); }
  std::span<const ContactRule> all() const { return rules_; }
  const ContactRule& operator[](int rule) const { return rules_[static_cast<std::size_t>(rule)]; }
  /// Returns the rules whose time it is [s].
  Set in_force(double time) const;
  /// Returns the last rule of `active` for two features, given by their points; −1: none.
  int find(std::span<const int> first, std::span<const int> second, Set active) const;
  /// True if the two features pass through each other.
  bool parts(std::span<const int> first, std::span<const int> second, Set active) const {
    const int rule = rules_.empty() ? -1 : find(first, second, active);
    return rule >= 0 && !(*this)[rule].touches;
  }
  /// Returns a number that other rules, or rules for other points, do not have.
  std::uint64_t hash() const { return hash_; }
  /// Returns the largest thickness of a rule [m]; 0: none has one.
  double thickest() const { return thickest_; }

 private:
  std::vector<ContactRule> rules_;
  std::array<std::vector<Set>, 2> sides_;  ///< by point: the rules to whose side it belongs
  double thickest_ = 0;
  std::uint64_t hash_ = 0;
};

}  // namespace muslin
