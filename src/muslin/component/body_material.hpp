// Declares and reads `material` of a [[body]]: a name, a file, or a table.
#pragma once

#include <filesystem>
#include <string>

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

/// The key, of BodySettings. It checks and writes the material; read_body_material reads it. `use` must be
/// static.
schema::Declaration material_key(const MaterialUse& use);

/// Reads the material under `material` of a body, whose other settings have been read. `folder` is that of
/// the scene file. Errors: input, file.
void read_body_material(const MaterialUse& use, const TomlTable& table, const std::filesystem::path& folder,
                        BodySettings& body);

/// Returns the material under `base` of a table of numbers. Errors: input, file; also if it has no numbers
/// for the kind.
Material base_material(const MaterialUse& use, const TomlTable& table, const std::filesystem::path& folder);

}  // namespace muslin
