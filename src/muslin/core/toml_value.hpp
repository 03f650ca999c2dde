// TomlValue is a TOML document as a tree in which every key and value stores its place in the file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "muslin/core/error.hpp"

namespace muslin {

struct TomlValue {
  enum class Type { boolean, integer, real, string, date, array, table };

  Type type = Type::table;
  bool boolean = false;
  std::int64_t integer = 0;
  double real = 0;
  std::string string;             ///< of a string; of a date, as TOML writes it
  std::vector<TomlValue> items;   ///< of an array or a table, in the order of the file
  std::vector<std::string> keys;  ///< of a table, one per item
  Place place;                    ///< where the value begins
  Place key_place;                ///< where its key is, if it is in a table

  TomlValue* find(std::string_view key);
  const TomlValue* find(std::string_view key) const;
};

/// Parses TOML 1.0; `file` is the name that places carry. Errors: input with file, line and column; also for
/// keys of more than 16 parts and values nested deeper than 256.
TomlValue parse_toml(std::string_view text, const std::string& file);

/// Returns the whole file as text. Errors: file, if it cannot be read or is larger than 64 MiB.
std::string read_text(const std::filesystem::path& file);

}  // namespace muslin
