#include "muslin/core/toml_table.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "muslin/core/nearest_name.hpp"

namespace muslin {
namespace {

std::string shown(const TomlValue& value) {
  switch (value.type) {
    case TomlValue::Type::boolean:
      return value.boolean ? "true" : "false";
    case TomlValue::Type::integer:
      return fmt::format("{}", value.integer);
    case TomlValue::Type::real:
      return fmt::format("{}", value.real);
    case TomlValue::Type::string:
      return value.string.size() <= 40 ? "\"" + value.string + "\""
                                       : "a text of " + std::to_string(value.string.size()) + " letters";
    case TomlValue::Type::date:
      return "the date " + value.string;
    case TomlValue::Type::array:
      return "a list of " + std::to_string(value.items.size());
    case TomlValue::Type::table:
      return "a table";
  }
  return {};
}

std::optional<double> number_in(const TomlValue& value) {
  if (value.type == TomlValue::Type::integer) return static_cast<double>(value.integer);
  if (value.type == TomlValue::Type::real) return value.real;
  return std::nullopt;
}

Error wrong_type(const TomlValue& value, const std::string& name, const std::string& remedy) {
  return {ErrorKind::input, value.place, name + " is " + shown(value), remedy};
}

}  // namespace

std::string range_text(const Range& range, std::string_view unit) {
  std::string text;
  if (std::isfinite(range.min) && std::isfinite(range.max)) {
    text = fmt::format(" {} {} to {}", range.open_min ? "above" : "from", range.min, range.max);
  } else if (std::isfinite(range.min)) {
    text = fmt::format(" {} {}", range.open_min ? "greater than" : "of at least", range.min);
  } else if (std::isfinite(range.max)) {
    text = fmt::format(" of at most {}", range.max);
  }
  if (!unit.empty()) text += fmt::format(" [{}]", unit);
  return text;
}

bool fits(double x, const Range& range) {
  return std::isfinite(x) && x <= range.max && (range.open_min ? x > range.min : x >= range.min);
}

double to_number(const TomlValue& value, const std::string& name, std::string_view unit, const Range& range) {
  const auto x = number_in(value);
  if (!x || !fits(*x, range)) throw wrong_type(value, name, "give a number" + range_text(range, unit));
  return *x;
}

Vec3 to_vector(const TomlValue& value, const std::string& name, std::string_view unit, const Range& range) {
  const bool any = range.min == -largest_component && range.max == largest_component;
  const std::string remedy =
      "give a list of three numbers [x, y, z]" + range_text(any ? Range::any() : range, unit);
  if (value.type != TomlValue::Type::array || value.items.size() != 3) {
    throw wrong_type(value, name, remedy);
  }
  Vec3 result;
  for (int i = 0; i < 3; ++i) {
    const TomlValue& item = value.items[static_cast<std::size_t>(i)];
    const auto x = number_in(item);
    if (!x || !fits(*x, range)) {
      throw wrong_type(item, fmt::format("{} of {}", "xyz"[i], name),
                       x && std::isfinite(*x) ? "give numbers" + range_text(range, unit) : remedy);
    }
    result[i] = *x;
  }
  return result;
}

TomlTable::TomlTable(const TomlValue& value, std::string title, const std::vector<std::string>& known)
    : value_(&value), title_(std::move(title)) {
  if (value.type != TomlValue::Type::table) {
    throw wrong_type(value, title_, "give a table of " + name_list(known));
  }
  for (std::size_t i = 0; i < value.keys.size(); ++i) {
    if (std::find(known.begin(), known.end(), value.keys[i]) != known.end()) continue;
    throw Error(ErrorKind::input, value.items[i].key_place,
                "unknown key `" + value.keys[i] + "` in " + title_, name_advice(value.keys[i], known));
  }
}

const Place& TomlTable::place(std::string_view key) const {
  const TomlValue* value = find(key);
  return value == nullptr ? value_->place : value->place;
}

std::string TomlTable::name_of(std::string_view key) const { return fmt::format("`{}` of {}", key, title_); }

const TomlValue& TomlTable::require(std::string_view key, std::string_view what) const {
  const TomlValue* value = find(key);
  if (value != nullptr) return *value;
  throw Error(ErrorKind::input, value_->place, fmt::format("{} has no `{}`", title_, key),
              fmt::format("add `{} = …`, {}", key, what));
}

double TomlTable::number(std::string_view key, std::string_view unit, const Range& range) const {
  return to_number(require(key, "a number" + range_text(range, unit)), name_of(key), unit, range);
}

double TomlTable::number(std::string_view key, std::string_view unit, const Range& range,
                         double fallback) const {
  return has(key) ? number(key, unit, range) : fallback;
}

std::int64_t TomlTable::integer(std::string_view key, std::int64_t min, std::int64_t max,
                                std::int64_t fallback) const {
  const TomlValue* value = find(key);
  if (value == nullptr) return fallback;
  if (value->type != TomlValue::Type::integer || value->integer < min || value->integer > max) {
    throw wrong_type(*value, name_of(key), fmt::format("give a whole number from {} to {}", min, max));
  }
  return value->integer;
}

bool TomlTable::boolean(std::string_view key, bool fallback) const {
  const TomlValue* value = find(key);
  if (value == nullptr) return fallback;
  if (value->type != TomlValue::Type::boolean) throw wrong_type(*value, name_of(key), "write true or false");
  return value->boolean;
}

Vec3 TomlTable::vector(std::string_view key, std::string_view unit) const {
  return to_vector(require(key, fmt::format("three numbers [x, y, z] [{}]", unit)), name_of(key), unit);
}

Vec3 TomlTable::vector(std::string_view key, std::string_view unit, const Vec3& fallback) const {
  return has(key) ? vector(key, unit) : fallback;
}

std::string TomlTable::string(std::string_view key) const {
  const TomlValue& value = require(key, "a text in quotes");
  if (value.type != TomlValue::Type::string) throw wrong_type(value, name_of(key), "give a text in quotes");
  return value.string;
}

std::string TomlTable::string(std::string_view key, const std::string& fallback) const {
  return has(key) ? string(key) : fallback;
}

std::size_t TomlTable::choice(std::string_view key, const std::vector<std::string>& names,
                              std::size_t fallback) const {
  const TomlValue* value = find(key);
  if (value == nullptr) return fallback;
  const std::string remedy = "use one of " + name_list(names);
  if (value->type != TomlValue::Type::string) throw wrong_type(*value, name_of(key), remedy);
  const auto at = std::find(names.begin(), names.end(), value->string);
  if (at == names.end()) throw wrong_type(*value, name_of(key), name_advice(value->string, names));
  return static_cast<std::size_t>(at - names.begin());
}

std::optional<TomlTable> TomlTable::table(std::string_view key, const std::vector<std::string>& known) const {
  const TomlValue* value = find(key);
  if (value == nullptr) return std::nullopt;
  return TomlTable(*value, name_of(key), known);
}

const std::vector<TomlValue>* TomlTable::array(std::string_view key, std::string_view what) const {
  const TomlValue* value = find(key);
  if (value == nullptr) return nullptr;
  if (value->type != TomlValue::Type::array) {
    throw wrong_type(*value, name_of(key), fmt::format("give a list of {}", what));
  }
  return &value->items;
}

Error TomlTable::error(std::string_view key, std::string problem, std::string remedy) const {
  return {ErrorKind::input, place(key), std::move(problem), std::move(remedy)};
}

}  // namespace muslin
