// MappedNumber is a number of a component that varies from vertex to vertex by a map.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "muslin/schema/variation.hpp"

namespace muslin {

struct MappedNumber {
  schema::Variation variation;  ///< of the key
  std::string unit;             ///< empty: none
  std::size_t index = 0;        ///< of the variation among those of its settings
  std::vector<double> weights;  ///< #vertices, 0 to 1
  bool may_change_on_resume = false;

  double at(std::size_t vertex) const { return variation.at_weight(weights[vertex]); }
  /// Returns the numbers at all vertices.
  std::vector<double> numbers() const {
    std::vector<double> all;
    all.reserve(weights.size());
    for (const double weight : weights) all.push_back(variation.at_weight(weight));
    return all;
  }
  /// Returns the number where the weight is the mean of those of some vertices.
  template <class Vertices>
  double mean(const Vertices& vertices) const {
    double sum = 0, count = 0;
    for (const int v : vertices) sum += weights[static_cast<std::size_t>(v)], ++count;
    return variation.at_weight(sum / count);
  }
};

/// Returns the one of this key; null if there is none.
inline const MappedNumber* find_map(const std::vector<MappedNumber>& maps, std::string_view key) {
  const auto at = std::find_if(maps.begin(), maps.end(),
                               [&](const MappedNumber& map) { return map.variation.key == key; });
  return at != maps.end() ? &*at : nullptr;
}

}  // namespace muslin
