#include "muslin/scene/overrides.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

#include "muslin/core/nearest_name.hpp"

namespace muslin {
namespace {

void set_place(TomlValue& value, const Place& place) {
  value.place = place;
  value.key_place = place;
  for (TomlValue& item : value.items) set_place(item, place);
}

TomlValue text_value(std::string_view text) {
  TomlValue value;
  value.type = TomlValue::Type::string;
  value.string = text;
  return value;
}

TomlValue parse_value(std::string_view text, const Place& place) {
  const std::size_t first = text.find_first_not_of(" \t");
  const bool structured = first != std::string_view::npos &&
                          std::string_view("[{\"'").find(text[first]) != std::string_view::npos;
  std::string problem;
  try {
    TomlValue parsed = parse_toml("value = " + std::string(text), place.file);
    if (parsed.items.size() == 1 && parsed.keys.front() == "value") return std::move(parsed.items.front());
    problem = "the value is more than one value";
  } catch (const Error& error) {
    problem = error.problem();
  }
  if (structured) throw Error(ErrorKind::input, place, problem, "write the value as in the scene file");
  return text_value(text);
}

std::optional<std::size_t> number_in(std::string_view text) {
  std::size_t number = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (failure != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

/// Takes the first part of a dotted path off it.
std::string_view take_part(std::string_view& path) {
  const std::size_t dot = path.find('.');
  const std::string_view part = path.substr(0, dot);
  path = dot == std::string_view::npos ? std::string_view() : path.substr(dot + 1);
  return part;
}

const std::string* name_of(const TomlValue& item) {
  const TomlValue* name = item.find("name");
  return name != nullptr && name->type == TomlValue::Type::string ? &name->string : nullptr;
}

/// Returns the list entry that the path begins with. Names may contain dots, so the longest match wins.
TomlValue& take_entry(TomlValue& list, std::string_view& path, const Place& place) {
  TomlValue* best = nullptr;
  std::size_t letters = 0;
  std::vector<std::string> names;
  for (TomlValue& item : list.items) {
    const std::string* name = name_of(item);
    if (name == nullptr) continue;
    names.push_back(*name);
    const bool fits = path.starts_with(*name) && (path.size() == name->size() || path[name->size()] == '.');
    if (fits && (best == nullptr || name->size() > letters)) {
      best = &item;
      letters = name->size();
    }
  }
  if (best != nullptr) {
    path = letters == path.size() ? std::string_view() : path.substr(letters + 1);
    return *best;
  }
  const std::string_view part = take_part(path);
  const auto number = number_in(part);
  if (number && *number < list.items.size()) return list.items[*number];
  if (number || names.empty()) {
    throw Error(ErrorKind::input, place,
                "there is no entry " + std::string(part) + " among " + std::to_string(list.items.size()),
                "count from 0");
  }
  throw Error(ErrorKind::input, place, "nothing here is called `" + std::string(part) + "`",
              name_advice(part, names));
}

}  // namespace

void apply_override(TomlValue& scene, const std::string& setting) {
  const Place place{"--set " + setting, 0, 0};
  const std::size_t equals = setting.find('=');
  std::string_view path = std::string_view(setting).substr(0, equals);
  while (path.ends_with(' ')) path.remove_suffix(1);
  const bool broken = path.starts_with('.') || path.ends_with('.') || path.find("..") != path.npos ||
                      std::count(path.begin(), path.end(), '.') > 64;
  if (equals == std::string::npos || path.empty() || broken) {
    throw Error(ErrorKind::usage, place, "this is not KEY=VALUE", "write for example time.duration=2");
  }
  TomlValue value = parse_value(std::string_view(setting).substr(equals + 1), place);
  set_place(value, place);

  TomlValue* at = &scene;
  while (!path.empty()) {
    if (at->type == TomlValue::Type::array) {
      at = &take_entry(*at, path, place);
    } else if (at->type == TomlValue::Type::table) {
      const std::string_view part = take_part(path);
      TomlValue* next = at->find(part);
      if (next == nullptr) {
        at->keys.emplace_back(part);
        next = &at->items.emplace_back();
        set_place(*next, place);
      }
      at = next;
    } else {
      throw Error(ErrorKind::input, place,
                  "`" + std::string(path) + "` is below a single value, which has no keys",
                  "shorten the key, or set a table, such as material={base=\"cotton\",density=300}");
    }
  }
  const Place key_place = at->key_place;
  *at = std::move(value);
  at->key_place = key_place.file.empty() ? place : key_place;
}

}  // namespace muslin
