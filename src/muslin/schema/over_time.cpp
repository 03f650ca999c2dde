#include "muslin/schema/over_time.hpp"

namespace muslin::schema {

std::optional<KeyedNumber> over_time(const Variations& variations, std::string_view key,
                                     const std::optional<double>& number) {
  if (!number) return std::nullopt;
  KeyedNumber result = *number;
  const Variation* variation = find_variation(variations, key);
  if (variation != nullptr && !variation->is_map()) result.keys = variation->keyframes;
  return result;
}

}  // namespace muslin::schema
