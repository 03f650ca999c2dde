// Makes TomlValues, which hold the settings of a resolved scene, and converts them to text.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "muslin/core/toml_value.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin::schema {

/// A number that is not finite is null in JSON.
TomlValue real(double x);
TomlValue whole(std::int64_t x);
TomlValue truth_value(bool x);
TomlValue words(std::string text);
TomlValue list(std::vector<TomlValue> items);
TomlValue vector_value(const Vec3& v);
inline TomlValue null() { return real(std::numeric_limits<double>::quiet_NaN()); }

/// Appends an entry to a table.
void append(TomlValue& table, std::string key, TomlValue value);

/// Returns the value as JSON, indented by two spaces. Bytes that are not UTF-8 become U+FFFD.
std::string to_json(const TomlValue& value);

/// Returns the value as TOML, on one line.
std::string to_toml(const TomlValue& value);

}  // namespace muslin::schema
