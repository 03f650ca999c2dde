// BodyKind describes a kind of [[body]], which its `model` names: the keys of its settings, and how a
// component is made of them. component/kinds.cpp lists the kinds.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "muslin/component/body_settings.hpp"
#include "muslin/component/component_source.hpp"
#include "muslin/core/toml_table.hpp"
#include "muslin/schema/declare.hpp"

namespace muslin {

struct BodyKind {
  const char* name;                ///< the value of `model`
  const char* plural;              ///< in messages, such as "shells"
  const char* meaning;             ///< in the guide: into what the mesh is made
  const schema::Table& (*keys)();  ///< its keys, of BodySettings
  /// Completes settings that were read from `table`: from files beside the scene, which is in `folder`.
  /// Appends warnings about settings that are legal but probably unintended. Errors: input, file. Null:
  /// nothing is to be done.
  void (*finish)(const TomlTable& table, const std::filesystem::path& folder, BodySettings& body,
                 std::vector<std::string>& warnings) = nullptr;
  std::shared_ptr<Component> (*build)(const BodySettings& settings, const ComponentInputs& inputs);
  /// Returns the paths of meshes of the same polygons, vertex for vertex those of the component, whose edges
  /// a cut opens; null: it cannot be cut.
  std::vector<std::string*> (*cut_meshes)(BodySettings& settings) = nullptr;
};

/// Returns the table of a kind: keys of its own settings, of type Own, then those of BodySettings.
template <class Own>
schema::Table kind_table(const std::string& name, std::vector<schema::Key> own,
                         const std::vector<schema::Key>& shared = {}) {
  schema::Table table = schema::table_of<BodySettings>(name, {});
  schema::include<BodySettings>(
      table, [](auto& body) -> auto& { return body.own.template as<Own>(); },
      schema::table_of<Own>(name, std::move(own)));
  table.keys.insert(table.keys.end(), shared.begin(), shared.end());
  return table;
}

}  // namespace muslin
