#include <cmath>

#include <fmt/format.h>

#include "muslin/schema/publish.hpp"
#include "muslin/schema/value.hpp"
#include "muslin/schema/walk.hpp"

namespace muslin::schema {
namespace {

// Range ends beyond these only keep products finite.
constexpr double tiny = 1e-5;
constexpr double huge = 1e5;

std::string range_cell(const Key& key) {
  const auto& [min, max, open_min] = key.range;
  const bool has_max = max < huge;
  if (min == -max && !has_max) return "";
  if (min > 0 && min < tiny) return has_max ? fmt::format("> 0, ≤ {}", max) : "> 0";
  if (!std::isfinite(min)) return has_max ? fmt::format("≤ {}", max) : "";
  if (!has_max) return fmt::format("{} {}", open_min ? ">" : "≥", min);
  return open_min ? fmt::format("> {}, ≤ {}", min, max) : fmt::format("{} to {}", min, max);
}

std::string default_cell(const Table& table, const Key& key) {
  if (key.required && key.unless.empty()) return "must be given";
  if (key.required) {
    std::string others;
    for (const std::string& other : key.unless)
      others += fmt::format("{}`{}`", others.empty() ? "" : " or ", other);
    return fmt::format("must be given without {}", others);
  }
  if (!key.otherwise.empty()) return key.otherwise;
  const auto value = default_of(table, key);
  if (!value) return "none";
  const bool plain = value->type == TomlValue::Type::real || value->type == TomlValue::Type::integer;
  return plain ? to_toml(*value) : fmt::format("`{}`", to_toml(*value));
}

/// [time] and [[body]] are shown in their brackets.
std::string key_cell(const Key& key) {
  const bool bracketed = key.table != nullptr && key.table().name.starts_with('[');
  return fmt::format("`{}`{}", bracketed ? key.table().name : key.name, key.may_change_on_resume ? " ↻" : "");
}

std::string meaning_cell(const Key& key) {
  if (!key.forms.any()) return key.meaning;
  return fmt::format("{}; may be {}{}{}", key.meaning, key.forms.map ? "[a map](maps.md)" : "",
                     key.forms.map && key.forms.keyframes ? " or " : "",
                     key.forms.keyframes ? "[keyframes](keyframes.md)" : "");
}

struct Row {
  std::string key, unit, range, fallback, meaning;
  std::vector<std::string> words;  ///< of the variants that have it

  bool is_like(const Row& other) const {
    return key == other.key && unit == other.unit && range == other.range && fallback == other.fallback &&
           meaning == other.meaning;
  }
};

/// Merges the rows of all variants: those of one alone stand before the next row that others have too.
std::vector<Row> rows_of(const Table& table) {
  std::vector<Row> rows;
  const auto place_of = [&](const Row& row) {
    return std::find_if(rows.begin(), rows.end(), [&](const Row& other) { return row.is_like(other); });
  };
  for (const Shape& shape : shapes_of(table)) {
    std::vector<Row> own;  // not yet among the rows
    for (const Key* key : shape.keys()) {
      own.push_back({key_cell(*key),
                     key->unit,
                     range_cell(*key),
                     default_cell(table, *key),
                     meaning_cell(*key),
                     {shape.word()}});
      const auto at = place_of(own.back());
      if (at == rows.end()) continue;
      at->words.push_back(shape.word());
      own.pop_back();
      rows.insert(at, own.begin(), own.end());
      own.clear();
    }
    rows.insert(rows.end(), own.begin(), own.end());
  }
  return rows;
}

std::string words_cell(const Row& row, const Table& table) {
  if (row.words.size() == table.variants.size()) return "all";
  std::string text;
  for (const std::string& word : row.words) text += fmt::format("{}{}", text.empty() ? "" : ", ", word);
  return text;
}

std::string block(const Table& table) {
  const std::vector<Row> rows = rows_of(table);
  const auto any = [&](std::string Row::* cell) {
    return std::any_of(rows.begin(), rows.end(), [&](const Row& row) { return !(row.*cell).empty(); });
  };
  const bool units = any(&Row::unit), ranges = any(&Row::range), variants = !table.variants.empty();
  std::string text = fmt::format("<!-- schema: {} -->\n| key |", plain_name(table)), rule = "|---|";
  const auto column = [&](const std::string& title) {
    text += fmt::format(" {} |", title);
    rule += "---|";
  };
  if (units) column("unit");
  if (ranges) column("range");
  if (variants) column(table.keys[table.chooser].name);
  column("default");
  column("meaning");
  text += fmt::format("\n{}\n", rule);
  for (const Row& row : rows) {
    text += fmt::format("| {} |", row.key);
    if (units) text += fmt::format(" {} |", row.unit.empty() ? "–" : row.unit);
    if (ranges) text += fmt::format(" {} |", row.range);
    if (variants) text += fmt::format(" {} |", words_cell(row, table));
    text += fmt::format(" {} | {} |\n", row.fallback, row.meaning);
  }
  return text + "<!-- end -->\n";
}

}  // namespace

std::string markdown(const Table& table) {
  std::string text;
  for (const Table* inner : tables_in(table))
    text += fmt::format("{}{}", text.empty() ? "" : "\n", block(*inner));
  return text;
}

}  // namespace muslin::schema
