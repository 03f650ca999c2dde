// Joins a number of settings with the keyframes in its place.
#pragma once

#include <optional>
#include <string_view>

#include "muslin/core/keyed_number.hpp"
#include "muslin/schema/variation.hpp"

namespace muslin::schema {

/// Returns the number of a key over time: its keyframes, or else `number` at all times; nothing without one.
std::optional<KeyedNumber> over_time(const Variations& variations, std::string_view key,
                                     const std::optional<double>& number);

}  // namespace muslin::schema
