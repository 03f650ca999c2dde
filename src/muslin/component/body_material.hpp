// Declares and reads `material` of a [[body]]: a name, a file, or a table.
#pragma once

#include <filesystem>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "muslin/component/body_settings.hpp"
#include "muslin/schema/declare.hpp"

namespace muslin {

/// The use of materials by one kind of body.
struct MaterialUse {
  const char* kind;  ///< in messages, such as "shell"
  const char* plural;
  const char* quantities;          ///< the first that a table must have, for messages
  const char* remedy;              ///< where a program's material has no numbers for the kind
  const schema::Table& (*keys)();  ///< of `material` as a table
  bool (*has_numbers)(const Material& material);
  /// Reads the opened table of a body, whose other settings have been read, over the numbers of its `base`.
  Material (*read)(const TomlTable& table, const BodySettings& body, const std::filesystem::path& folder);
  TomlValue (*write)(const Material& material);  ///< only numbers
  void (*check)(const Material& material, const schema::Subject& subject);
};

/// Throws Error(input) for a material that a file could not have set.
void check_material(const MaterialUse& use, const schema::Key& key, const Material& material,
                    const schema::Subject& subject);
/// Appends the material with its name and numbers, if it has any for the kind.
void write_material(const MaterialUse& use, const schema::Key& key, const Material& material, TomlValue& out);

/// The key `material`. It checks and writes the material; material_of reads it. `use` must be static.
template <class S>
schema::Declaration material_key(const MaterialUse& use, Material S::* member) {
  schema::Key key = schema::custom<S>(
      "material", {schema::Type::text, schema::Type::table}, [](const schema::Key&, const TomlTable&, S&) {},
      [&use, member](const schema::Key& k, const S& s, TomlValue& out) {
        write_material(use, k, s.*member, out);
      });
  key.table = use.keys;
  key.check = [&use, member](const schema::Key& k, const void* s, const schema::Subject& subject) {
    check_material(use, k, static_cast<const S*>(s)->*member, subject);
  };
  return schema::Declaration(std::move(key))
      .required(
          fmt::format("name one (`muslin materials` lists them) or give a table with {}, …", use.quantities))
      .means("a name (`muslin materials` lists them), the path of a material file (`.toml`), or a table");
}

/// Returns the material under `material` of a table of a body, whose other settings have been read. `folder`
/// is that of the scene file. Errors: input, file.
Material material_of(const MaterialUse& use, const TomlTable& table, const BodySettings& body,
                     const std::filesystem::path& folder);

/// Returns the material under `base` of a table of numbers. Errors: input, file; also if it has no numbers
/// for the kind.
Material base_material(const MaterialUse& use, const TomlTable& table, const std::filesystem::path& folder);

}  // namespace muslin
