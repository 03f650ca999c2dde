// Variation is a number that varies over a body, by a map, or in time, by keyframes:
//
//   bending_warp = { map = "stiff", from = 1e-6, to = 1e-4 }
//   bending_warp = { keyframes = [{ time = 0, value = 1e-6 }, { time = 2, value = 1e-4 }] }
//
// A key that allows it is declared with `varies`, which names the list of Variations of its settings. The
// key's own member then holds the nominal value.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/keyframes.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin::schema {

struct MUSLIN_API Variation {
  std::string key;  ///< that varies
  // A map: weight (v − lowest)/(highest − lowest), v the map's value, stands for from + (to − from) curve.
  std::string map;  ///< its name; empty: none
  double from = 0, to = 0;
  double lowest = 0, highest = 1;
  std::vector<Vec2> curve;  ///< (weight, share), both 0 to 1, ascending weights; empty: share = weight
  std::vector<NumberKeyframe> keyframes;  ///< not empty without a map
  Place place;

  bool is_map() const { return !map.empty(); }
  /// Returns the map's value at a weight from 0 to 1.
  double at_weight(double weight) const;
  /// Returns the number that stands for all others: the middle of a map, the first keyframe.
  double nominal() const;
  /// Returns the greatest number of a map.
  double greatest() const { return std::max(from, to); }
};
using Variations = std::vector<Variation>;

/// Returns the variation of a key; null if it has one value.
MUSLIN_API const Variation* find_variation(const Variations& variations, std::string_view key);
/// Removes the variation of a key, if there is one.
MUSLIN_API void forget_variation(Variations& variations, std::string_view key);
/// Lets `key` vary as `model` does, or not if that has one value.
MUSLIN_API void copy_variation(Variations& variations, std::string_view model, const std::string& key);

}  // namespace muslin::schema
