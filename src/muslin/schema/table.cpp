#include "muslin/schema/table.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "muslin/core/nearest_name.hpp"

namespace muslin::schema {
namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void add_name(std::vector<std::string>& names, const std::string& name) {
  if (!contains(names, name)) names.push_back(name);
}

/// ", or `a` or `b`": the keys that excuse the absence of `key`, of those that the table may have.
std::string or_others(const Key& key, const std::vector<const Key*>& keys) {
  std::string words;
  for (const std::string& other : key.unless)
    if (std::any_of(keys.begin(), keys.end(), [&](const Key* k) { return k->name == other; }))
      words += fmt::format("{} `{}`", words.empty() ? ", or" : " or", other);
  return words;
}

void refuse_keyframes(const Key& key, const TomlTable& table) {
  const TomlValue* value = table.find(key.name);
  if (key.steady.empty() || value == nullptr || value->find("keyframes") == nullptr) return;
  throw table.error(key.name, fmt::format("`{}` cannot vary by keyframes: {}", key.name, key.steady),
                    fmt::format("give {}", described(key)));
}

/// Checks which keys are given beside which.
void check_presence(const Key& key, const std::vector<const Key*>& keys, const TomlTable& table) {
  if (!table.has(key.name)) {
    const bool excused = std::any_of(key.unless.begin(), key.unless.end(),
                                     [&](const std::string& other) { return table.has(other); });
    if (!key.required || excused) return;
    throw Error(ErrorKind::input, table.place(), fmt::format("{} has no `{}`", table.title(), key.name),
                key.missing.empty()
                    ? fmt::format("add `{} = …`, {}{}", key.name, described(key), or_others(key, keys))
                    : key.missing);
  }
  for (const Key::Need& need : key.needs) {
    if (!table.has(need.other))
      throw table.error(key.name, fmt::format("`{}` needs `{}`", key.name, need.other), need.remedy);
  }
  for (const Key::Conflict& conflict : key.conflicts)
    if (table.has(conflict.other)) throw table.error(key.name, conflict.problem, conflict.remedy);
}

/// Settings of a program: a key that has a value is given.
void check_conflicts(const Key& key, const std::vector<const Key*>& keys, const void* settings,
                     const Subject& subject) {
  if (!key.given || !key.given(settings)) return;
  for (const Key::Conflict& conflict : key.conflicts) {
    for (const Key* other : keys) {
      if (other->name == conflict.other && other->given && other->given(settings))
        throw subject.error(key.name, conflict.problem, conflict.remedy);
    }
  }
}

}  // namespace

std::string described(const Key& key) {
  switch (key.types.front()) {
    case Type::number:
      return fmt::format("a number{}", range_text(key.range, key.unit));
    case Type::whole_number:
      return fmt::format("a whole number{}", range_text(key.range, key.unit));
    case Type::truth:
      return "true or false";
    case Type::text:
    case Type::path:
      return "a text in quotes";
    case Type::texts:
      return "a list of texts in quotes";
    case Type::word:
      return fmt::format("one of {}", name_list(key.choices));
    case Type::vector:
      return key.unit.empty() ? "three numbers [x, y, z]"
                              : fmt::format("three numbers [x, y, z] [{}]", key.unit);
    case Type::points:
      return "points [[x, y, z], …]";
    case Type::curve:
      return "points [[x, y], …]";
    case Type::table:
    case Type::tables:
      return "a table";
  }
  return {};
}

void require_path(const std::string& path, const Key& key, const TomlTable& table) {
  if (path.empty() || path.find('\0') != std::string::npos)
    throw table.error(key.name, fmt::format("`{}` is no path", key.name), "name a file");
}

TomlTable Table::open(const TomlValue& value, const std::string& title) const {
  if (variants.empty()) return {value, title, names()};
  const Key& key = keys[chooser];
  const bool is_table = value.type == TomlValue::Type::table;
  const TomlValue* word = is_table ? value.find(key.name) : nullptr;
  if (word == nullptr && key.required) {
    throw Error(ErrorKind::input, value.place, fmt::format("{} has no `{}`", title, key.name),
                fmt::format("add `{} = …`, {}", key.name, described(key)));
  }
  std::size_t chosen_variant = 0;
  if (word != nullptr) {
    TomlValue only;
    only.keys = {key.name};
    only.items = {*word};
    chosen_variant = TomlTable(only, title, only.keys).choice(key.name, key.choices, 0);
  }
  const Variant& variant = variants[chosen_variant];
  std::vector<std::string> known;
  for (const Key* active : keys_of(chosen_variant)) known.push_back(active->name);
  if (variant.plural.empty())
    return {value, fmt::format("{} of {} {}", title, key.name, variant.word), known};
  const TomlTable table(value, title, names());
  for (const Variant& other : variants) {
    for (const Key& foreign : other.table().keys) {
      if (!table.has(foreign.name) || contains(known, foreign.name)) continue;
      throw table.error(foreign.name, fmt::format("`{}` is a setting of {}", foreign.name, other.plural),
                        fmt::format("remove it, or set `{} = \"{}\"`", key.name, other.word));
    }
  }
  return table;
}

std::vector<std::string> Table::names() const {
  std::vector<std::string> result;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    add_name(result, keys[i].name);
    if (i != chooser) continue;
    for (const Variant& variant : variants)
      for (const Key& key : variant.table().keys) add_name(result, key.name);
  }
  return result;
}

std::vector<const Key*> Table::keys_of(std::size_t variant) const {
  std::vector<const Key*> result;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    result.push_back(&keys[i]);
    if (i != chooser || variant >= variants.size()) continue;
    for (const Key& key : variants[variant].table().keys) result.push_back(&key);
  }
  return result;
}

const Key* Table::find(std::string_view name) const {
  const auto at = std::find_if(keys.begin(), keys.end(), [&](const Key& key) { return key.name == name; });
  if (at != keys.end()) return &*at;
  for (const Variant& variant : variants)
    if (const Key* key = variant.table().find(name)) return key;
  return nullptr;
}

void Table::read_erased(const TomlTable& table, void* settings) const {
  if (set_place) set_place(table.place(), settings);
  // The chooser first: it decides which keys there are.
  if (chooser != none && table.has(keys[chooser].name)) keys[chooser].read(keys[chooser], table, settings);
  const std::size_t variant = chosen ? chosen(settings) : 0;
  const std::vector<const Key*> active = keys_of(variant);
  for (const Key* key : active) {
    check_presence(*key, active, table);
    refuse_keyframes(*key, table);
    if (table.has(key->name)) key->read(*key, table, settings);
  }
  if (complete) complete(table, settings);
  if (variant < variants.size() && variants[variant].table().complete)
    variants[variant].table().complete(table, settings);
  const Subject subject(table);
  for (const auto& rule : rules) rule(settings, subject);
  if (variant < variants.size())
    for (const auto& rule : variants[variant].table().rules) rule(settings, subject);
}

void Table::check_erased(const void* settings, const Subject& subject) const {
  const std::size_t variant = chosen ? chosen(settings) : 0;
  const std::vector<const Key*> active = keys_of(variant);
  for (const Key* key : active) {
    if (key->check) key->check(*key, settings, subject);
    check_conflicts(*key, active, settings, subject);
  }
  for (const auto& rule : rules) rule(settings, subject);
  if (variant < variants.size())
    for (const auto& rule : variants[variant].table().rules) rule(settings, subject);
}

TomlValue Table::write_erased(const void* settings) const {
  TomlValue result;
  for (const Key* key : keys_of(chosen ? chosen(settings) : 0))
    if (key->write && (!key->shown || key->shown(settings))) key->write(*key, settings, result);
  return result;
}

std::optional<TomlValue> default_of(const Table& table, const Key& key) {
  if (key.required || !key.otherwise.empty() || !key.write || !table.blank) return std::nullopt;
  TomlValue written;
  key.write(key, table.blank.get(), written);
  if (written.items.empty()) return std::nullopt;
  TomlValue value = std::move(written.items.front());
  const bool null = value.type == TomlValue::Type::real && !std::isfinite(value.real);
  const bool nested = key.types.front() == Type::table || key.types.front() == Type::tables;
  const bool empty = value.type == TomlValue::Type::string && value.string.empty();
  if (null || nested || empty) return std::nullopt;
  return value;
}

bool may_change_on_resume(const Table& table, std::string_view path) {
  const std::size_t dot = path.find('.');
  const std::string_view part = path.substr(0, dot);
  const std::string_view rest = dot == path.npos ? std::string_view() : path.substr(dot + 1);
  if (path.empty()) return false;
  const bool is_index = part.find_first_not_of("0123456789-") == part.npos;
  if (is_index) return may_change_on_resume(table, rest);
  const auto allows = [&](const Key& key) {
    return key.name == part &&
           (key.may_change_on_resume || (key.table != nullptr && may_change_on_resume(key.table(), rest)));
  };
  // Variants may have keys of one name with different tables.
  return std::any_of(table.keys.begin(), table.keys.end(), allows) ||
         std::any_of(table.variants.begin(), table.variants.end(), [&](const Variant& variant) {
           const std::vector<Key>& keys = variant.table().keys;
           return std::any_of(keys.begin(), keys.end(), allows);
         });
}

}  // namespace muslin::schema
