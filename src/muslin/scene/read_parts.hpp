// Reads settings common to several tables of a scene: names, paths, scales, colours, keyframes.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "muslin/constraint/pin.hpp"
#include "muslin/core/toml_table.hpp"

namespace muslin {

/// Returns the table's name in messages: `[[body]] flag`, or with its number among its kind.
std::string title_of(const std::string& kind, const TomlValue& value, std::size_t index);

/// Throws Error(input) unless `name` is valid in file names and paths: not empty, no separators or control
/// characters.
void require_name(const std::string& name, const Place& place);

// Errors of all: input, with the place.
std::string read_name(const TomlTable& table, const std::string& fallback);
std::string read_path(const TomlTable& table, const char* key);
/// Reads a number or one per axis, all positive.
Vec3 read_scale(const TomlTable& table);
/// Reads `friction`, Coulomb's coefficient, 0 to 100.
std::optional<double> read_friction(const TomlTable& table);

std::optional<Vec3> read_colour(const TomlTable& table);
/// Returns the direction under the key, of length 1.
Vec3 read_direction(const TomlTable& table, const char* key, const char* example);

/// Calls read(key, time) for the tables under `keyframes`, each with a time after the one before.
template <class Read>
void read_keyframes(const TomlTable& owner, const std::vector<std::string>& known, const Read& read) {
  const auto* items = owner.array("keyframes", "tables such as { time = 0, … }");
  if (items == nullptr) return;
  if (items->empty()) throw owner.error("keyframes", "`keyframes` is empty", "take it out or give keys");
  double last = -std::numeric_limits<double>::infinity();
  for (const TomlValue& item : *items) {
    const TomlTable key(item, "a keyframe of " + owner.title(), known);
    const double time = key.number("time", "s", Range::any());
    if (time <= last) {
      throw key.error("time",
                      fmt::format("the keyframe at {} s does not come after that at {} s", time, last),
                      "order keyframes by time, one at a time");
    }
    last = time;
    read(key, time);
  }
}

/// Reads `keyframes` of `time`, `translate` and `rotate`; their known keys are those of the table
/// `vocabulary`.
std::vector<Motion::Key> read_motion(const TomlTable& owner, const char* vocabulary);

}  // namespace muslin
