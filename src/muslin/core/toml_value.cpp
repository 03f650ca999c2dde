#include "muslin/core/toml_value.hpp"

#include <algorithm>
#include <sstream>
#include <tuple>

#include <toml++/toml.h>

#include "muslin/core/input_file.hpp"

namespace muslin {
namespace {

constexpr int max_key_parts = 16;
constexpr std::uintmax_t max_bytes = std::uintmax_t{64} << 20;

/// toml++ recurses once per part of a dotted key and has no bound on them: a long enough key overflows the
/// stack. Counted here before parsing; strings and comments do not count.
void require_shallow_keys(std::string_view text, const std::string& file) {
  int parts = 1, line = 1;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '#') {
      i = std::min(text.find('\n', i), text.size()) - 1;
    } else if (c == '"' || c == '\'') {
      const bool many_lines = text.substr(i, 3) == std::string(3, c);
      const std::string_view end = text.substr(i, many_lines ? 3 : 1);
      std::size_t j = i + end.size();
      while (j < text.size() && text.substr(j, end.size()) != end && (many_lines || text[j] != '\n')) {
        if (text[j] == '\n') ++line;
        j += c == '"' && text[j] == '\\' ? 2 : 1;
      }
      i = j < text.size() && text[j] == '\n' ? j - 1 : j + end.size() - 1;
    } else if (c == '.') {
      if (++parts > max_key_parts) {
        throw Error(ErrorKind::input, Place{file, line, 0},
                    "a key has more than " + std::to_string(max_key_parts) + " dotted parts",
                    "no key here needs more than three");
      }
    } else if (c == '\n' || c == ',' || c == '=' || c == '[' || c == ']' || c == '{' || c == '}') {
      parts = 1;
      if (c == '\n') ++line;
    }
  }
}

Place place_of(const toml::source_region& source, const std::string& file) {
  return {file, static_cast<int>(source.begin.line), static_cast<int>(source.begin.column)};
}

template <class Date>
TomlValue date(const Date& value) {
  std::ostringstream text;
  text << value;
  TomlValue result;
  result.type = TomlValue::Type::date;
  result.string = text.str();
  return result;
}

TomlValue convert(const toml::node& node, const std::string& file);

TomlValue convert_table(const toml::table& table, const std::string& file) {
  std::vector<std::pair<const toml::key*, const toml::node*>> entries;
  for (auto&& [key, value] : table) entries.emplace_back(&key, &value);
  std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
    const auto& p = a.first->source().begin;
    const auto& q = b.first->source().begin;
    return std::tie(p.line, p.column) < std::tie(q.line, q.column);
  });
  TomlValue result;
  result.items.reserve(entries.size());
  for (const auto& [key, value] : entries) {
    result.keys.emplace_back(key->str());
    result.items.push_back(convert(*value, file));
    result.items.back().key_place = place_of(key->source(), file);
  }
  return result;
}

TomlValue convert(const toml::node& node, const std::string& file) {
  TomlValue result;
  if (const toml::table* table = node.as_table()) {
    result = convert_table(*table, file);
  } else if (const toml::array* array = node.as_array()) {
    result.type = TomlValue::Type::array;
    result.items.reserve(array->size());
    for (const toml::node& item : *array) result.items.push_back(convert(item, file));
  } else if (const auto* boolean = node.as_boolean()) {
    result.type = TomlValue::Type::boolean;
    result.boolean = boolean->get();
  } else if (const auto* integer = node.as_integer()) {
    result.type = TomlValue::Type::integer;
    result.integer = integer->get();
  } else if (const auto* real = node.as_floating_point()) {
    result.type = TomlValue::Type::real;
    result.real = real->get();
  } else if (const auto* string = node.as_string()) {
    result.type = TomlValue::Type::string;
    result.string = string->get();
  } else if (const auto* day = node.as_date()) {
    result = date(day->get());
  } else if (const auto* time = node.as_time()) {
    result = date(time->get());
  } else if (const auto* moment = node.as_date_time()) {
    result = date(moment->get());
  }
  result.place = place_of(node.source(), file);
  return result;
}

}  // namespace

TomlValue* TomlValue::find(std::string_view key) {
  const auto at = std::find(keys.begin(), keys.end(), key);
  return at == keys.end() ? nullptr : &items[static_cast<std::size_t>(at - keys.begin())];
}

const TomlValue* TomlValue::find(std::string_view key) const {
  return const_cast<TomlValue*>(this)->find(key);
}

TomlValue parse_toml(std::string_view text, const std::string& file) {
  require_shallow_keys(text, file);
  try {
    return convert(toml::parse(text, std::string_view(file)), file);
  } catch (const toml::parse_error& error) {
    throw Error(ErrorKind::input, place_of(error.source(), file), std::string(error.description()),
                "correct the TOML there (texts need quotes, lists need brackets)");
  }
}

std::string read_text(const std::filesystem::path& file) { return read_file(file, max_bytes); }

}  // namespace muslin
