// Table is a list of keys of one TOML table in a scene or material file, read into one struct of settings.
#pragma once

#include <cassert>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <typeinfo>
#include <vector>

#include "muslin/schema/key.hpp"

namespace muslin::schema {

/// Further keys of a table that apply if its choosing key is `word`.
struct Variant {
  std::string word;
  /// Names the objects of this variant, such as "shells". If given, a key of another variant is reported as
  /// such; otherwise it is an unknown key.
  std::string plural;
  const Table& (*table)();
};

struct Table {
  std::string name;  ///< in the guide, such as "[time]" or "`where`"
  std::vector<Key> keys;
  // The key keys[chooser] selects a variant, whose keys follow it.
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  std::size_t chooser = none;
  std::vector<Variant> variants;  ///< in the order of the chooser's choices

  // These describe the settings that the keys are read into.
  const std::type_info* type = nullptr;
  std::shared_ptr<const void> blank;                   ///< with the defaults
  std::function<void(const Place&, void*)> set_place;  ///< null: the settings have no place
  std::function<std::size_t(const void*)> chosen;      ///< the index of the variant
  std::function<void(const TomlTable&, void*)>
      complete;  ///< sets values derived from other keys; may be null
  std::vector<std::function<void(const void*, const Subject&)>> rules;  ///< of several keys

  /// Opens a table of a file; refuses unknown keys and keys of other variants. Errors: input.
  TomlTable open(const TomlValue& value, const std::string& title) const;
  /// Reads an opened table. Keys that are not given keep the values that `settings` has. Errors: input.
  template <class Settings>
  void read(const TomlTable& table, Settings& settings) const {
    assert(type == nullptr || *type == typeid(Settings));
    read_erased(table, &settings);
  }
  /// Throws Error(input) for the first setting that a file could not have set.
  template <class Settings>
  void check(const Settings& settings, const Subject& subject) const {
    assert(type == nullptr || *type == typeid(Settings));
    check_erased(&settings, subject);
  }
  /// Returns the settings with every default made explicit.
  template <class Settings>
  TomlValue write(const Settings& settings) const {
    assert(type == nullptr || *type == typeid(Settings));
    return write_erased(&settings);
  }

  /// Stores a number under its key, which is one of the table's numbers.
  template <class Settings>
  void set_number(std::string_view key, double x, Settings& settings) const {
    assert(type == nullptr || *type == typeid(Settings));
    find(key)->set(x, &settings);
  }

  /// Returns the names of all keys, those of all variants included.
  std::vector<std::string> names() const;
  /// Returns the keys that apply if this variant is chosen, in their order.
  std::vector<const Key*> keys_of(std::size_t variant) const;
  const Key* find(std::string_view name) const;  ///< in any variant; null: none

  void read_erased(const TomlTable& table, void* settings) const;
  void check_erased(const void* settings, const Subject& subject) const;
  TomlValue write_erased(const void* settings) const;
};

/// Returns the constant default of a key; nothing if it has none or is required.
std::optional<TomlValue> default_of(const Table& table, const Key& key);

/// True if a setting of the resolved scene may change when a run is resumed. `path` is dotted, such as
/// "body.0.colour.2", and begins in `table`.
bool may_change_on_resume(const Table& table, std::string_view path);

}  // namespace muslin::schema
