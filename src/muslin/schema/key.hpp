// Key declares a key of a scene or material file: name, type, unit, range, default, meaning, and whether it
// may change when a run is resumed. Reading, checking, writing, the JSON Schema, the guide and the Python
// types come from this one declaration (schema/declare.hpp makes keys, schema/table.hpp uses them).
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "muslin/core/toml_table.hpp"
#include "muslin/core/toml_value.hpp"
#include "muslin/schema/subject.hpp"

namespace muslin::schema {

struct Table;

enum class Type {
  number,
  whole_number,
  truth,  ///< true or false
  text,
  texts,   ///< a list of texts; where the key has a table, any of them may be a table instead
  path,    ///< a text that names a file
  word,    ///< one of Key::choices
  vector,  ///< three numbers
  points,  ///< a list of vectors
  curve,   ///< a list of pairs of numbers, each ascending from 0
  table,
  tables,  ///< a list of tables
};

/// Forms beside a number in which a key may be given (schema/variation.hpp).
struct VaryingForms {
  bool map = false, keyframes = false;

  bool any() const { return map || keyframes; }
};

struct Key {
  std::string name;
  std::vector<Type> types;           ///< the value is one of these
  std::string unit;                  ///< empty: none
  Range range;                       ///< of numbers and of the components of vectors
  std::vector<std::string> choices;  ///< words
  std::size_t count = 0;             ///< of `points` and `texts`; 0: any. Of a curve: the most
  std::string meaning;
  std::string otherwise;  ///< the default in words if it is not a constant
  bool required = false;
  std::vector<std::string> unless;  ///< not required if any of these keys is given
  std::string missing;              ///< remedy if a required key is missing; empty: by the type
  bool may_change_on_resume = false;
  const Table& (*table)() = nullptr;  ///< the keys of a table, or of each table of a list
  VaryingForms forms;                 ///< of a number: in which it may vary
  std::string steady;                 ///< why a number has no keyframes, for messages; empty: nothing to say

  struct Need {
    std::string other, remedy;
  };
  std::vector<Need> needs;  ///< keys without which this one may not be given
  struct Conflict {
    std::string other, problem, remedy;
  };
  std::vector<Conflict> conflicts;  ///< keys that exclude this one

  // Each receives the key and the settings, of the type for which the key was declared.
  /// Stores the value of the table's key, which must be present. Errors: input, at its place.
  std::function<void(const Key&, const TomlTable&, void*)> read;
  /// Appends the value, if there is one, to a table.
  std::function<void(const Key&, const void*, TomlValue&)> write;
  /// Throws Error(input) if the settings hold a value that reading would refuse.
  std::function<void(const Key&, const void*, const Subject&)> check;
  std::function<void(double, void*)> set;  ///< stores a number; null: the value is no number
  std::function<bool(const void*)> given;  ///< true if there is a value; null: always
  std::function<bool(const void*)> shown;  ///< true if the resolved scene has the key; null: always
};

/// Returns the key's value in words, for messages: "a number above 0 [m]".
std::string described(const Key& key);

/// Throws Error(input) if the value of the key cannot name a file.
void require_path(const std::string& path, const Key& key, const TomlTable& table);

}  // namespace muslin::schema
