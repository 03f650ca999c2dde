// TomlTable reads a TOML table with checks; errors name the key, its place, the problem and the unit.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "muslin/core/toml_value.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

/// Range of valid numbers. Infinity and NaN are never allowed, whatever the bounds.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool open_min = false;  ///< min itself is not allowed

  static Range any() { return {}; }
  static Range positive() { return {0, std::numeric_limits<double>::infinity(), true}; }
  static Range non_negative() { return {0, std::numeric_limits<double>::infinity(), false}; }
  static Range between(double min, double max) { return {min, max, false}; }
};

bool fits(double x, const Range& range);
/// Returns the range in words, to stand behind "a number": " from 0 to 1 [m]".
std::string range_text(const Range& range, std::string_view unit);

/// Return a value as numbers; `name` is its name in messages and `unit` may be empty. Errors: input.
double to_number(const TomlValue& value, const std::string& name, std::string_view unit,
                 const Range& range = {});
/// Largest component of points, velocities, directions; larger ones cannot be squared and summed safely.
inline constexpr double largest_component = 1e11;
Vec3 to_vector(const TomlValue& value, const std::string& name, std::string_view unit,
               const Range& range = Range::between(-largest_component, largest_component));

class TomlTable {
 public:
  /// `title` is the table's name in messages, such as "[time]". Keys other than `known` are errors that name
  /// the nearest known one. `value` must outlive the table. Errors: input.
  TomlTable(const TomlValue& value, std::string title, const std::vector<std::string>& known);

  bool has(std::string_view key) const { return find(key) != nullptr; }
  const TomlValue* find(std::string_view key) const { return value_->find(key); }
  /// Returns the place of the key's value; of the table if the key is missing.
  const Place& place(std::string_view key) const;
  const Place& place() const { return value_->place; }
  const std::string& title() const { return title_; }
  std::size_t size() const { return value_->items.size(); }

  // With a fallback the key may be missing; without, that is an error.
  double number(std::string_view key, std::string_view unit, const Range& range) const;
  double number(std::string_view key, std::string_view unit, const Range& range, double fallback) const;
  std::int64_t integer(std::string_view key, std::int64_t min, std::int64_t max, std::int64_t fallback) const;
  bool boolean(std::string_view key, bool fallback) const;
  Vec3 vector(std::string_view key, std::string_view unit) const;
  Vec3 vector(std::string_view key, std::string_view unit, const Vec3& fallback) const;
  std::string string(std::string_view key) const;
  std::string string(std::string_view key, const std::string& fallback) const;
  /// Returns the index of the string among `names`.
  std::size_t choice(std::string_view key, const std::vector<std::string>& names, std::size_t fallback) const;
  /// Returns a table below this one; nothing if the key is missing.
  std::optional<TomlTable> table(std::string_view key, const std::vector<std::string>& known) const;
  /// Returns the items of an array; null if the key is missing.
  const std::vector<TomlValue>* array(std::string_view key, std::string_view what) const;

  /// Returns an error about the key, at its place.
  Error error(std::string_view key, std::string problem, std::string remedy) const;

 private:
  const TomlValue& require(std::string_view key, std::string_view what) const;
  std::string name_of(std::string_view key) const;

  const TomlValue* value_;
  std::string title_;
};

}  // namespace muslin
