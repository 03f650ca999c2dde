#include "muslin/fit/measured_key.hpp"

#include <cmath>
#include <vector>

namespace muslin {
namespace {

Measured mean_of(const std::vector<double>& repeats) {
  double sum = 0, squares = 0;
  for (const double x : repeats) sum += x;
  const double n = static_cast<double>(repeats.size()), mean = sum / n;
  for (const double x : repeats) squares += (x - mean) * (x - mean);
  if (squares == 0) return {mean, std::nullopt};  // one, or finer than the numbers are written
  return {mean, std::sqrt(squares / (n - 1) / n)};
}

/// The number of this name over `divisor`. A number that may be 0 has no share of itself as its bound.
double uncertainty(const schema::Key& key, const TomlTable& given, const char* name, double value,
                   double divisor) {
  const double stated = given.number(name, key.unit, Range::positive()) / divisor;
  const double most = key.range.min > 0 || key.range.open_min ? value : key.range.max;
  if (stated > most)
    throw given.error(name, fmt::format("an uncertainty of {:.3g} is above 100 % of {:.3g}", stated, most),
                      "give the standard uncertainty in the unit of the number");
  return stated;
}

}  // namespace

Measured read_measured(const schema::Key& key, const TomlTable& table, double scale) {
  const TomlValue& value = *table.find(key.name);
  const std::string name = fmt::format("`{}` of {}", key.name, table.title());
  Measured result;
  if (value.type == TomlValue::Type::array) {
    std::vector<double> repeats;
    repeats.reserve(value.items.size());
    for (const TomlValue& item : value.items)
      repeats.push_back(to_number(item, "a number of " + name, key.unit, key.range));
    if (repeats.empty())
      throw table.error(key.name, name + " is empty",
                        "give " + schema::described(key) + ", once or repeated");
    result = mean_of(repeats);
  } else if (value.type == TomlValue::Type::table) {
    const TomlTable given(value, name, {"value", "plus_minus", "deviation", "count"});
    result.value = given.number("value", key.unit, key.range);
    if (given.has("plus_minus")) {
      result.plus_minus = uncertainty(key, given, "plus_minus", result.value, 1);
    } else if (given.has("deviation")) {
      const double count = static_cast<double>(given.integer("count", 1, 1000000, 1));
      result.plus_minus = uncertainty(key, given, "deviation", result.value, std::sqrt(count));
    }
  } else {
    result.value = to_number(value, name, key.unit, key.range);
  }
  result.value *= scale;
  if (result.plus_minus) *result.plus_minus *= scale;
  return result;
}

}  // namespace muslin
