// ForceKind describes a kind of [[force]], which its `type` names: the keys of its settings, and what it adds
// to a model. scene/force_kinds.cpp lists the kinds.
#pragma once

#include <utility>
#include <vector>

#include "muslin/scene/model.hpp"
#include "muslin/schema/declare.hpp"

namespace muslin {

struct ForceKind {
  const char* name;                ///< the value of `type`
  const schema::Table& (*keys)();  ///< its keys, of ForceSettings
  bool on_one_body = false;        ///< false: without a `body` it acts on every body
  /// Throws subject.error(…) if the settings do not fit the scene; null: they always do. The name of their
  /// body is known to be one of the scene, or empty.
  void (*check)(const ForceSettings& force, const Scene& scene, const schema::Subject& subject) = nullptr;
  /// Adds potentials or loads to the model, whose components, rest positions and masses exist. Errors: input,
  /// with the place in the scene.
  void (*add)(Model& model, const ForceSettings& force);
};

/// Returns the masses of all vertices of the model [kg], 0 where the force does not act.
std::vector<double> masses_acted_on(const Model& model, const ForceSettings& force);

/// The key `body`.
schema::Declaration force_body_key(const char* otherwise, const char* meaning);

/// A vector that a force has, constant or over time.
struct ForceValue {
  const char* key;  ///< of the constant
  const char* unit;
  const char* meaning;
  const schema::Table& (*keyframes)();  ///< made by force_keyframe_table
  const char* otherwise = nullptr;      ///< the default, in words; null: there is none
};
schema::Table force_keyframe_table(const char* kind, const char* key, const char* unit);

/// Adds the keys of the value, and `from` and `until`.
void add_value_keys(schema::Table& table, const ForceValue& value);

/// Adds keys of the kind's own settings, of type Own, and a rule of several of them.
template <class Own>
void add_own_keys(schema::Table& table, std::vector<schema::Key> keys,
                  void (*rule)(const Own&, const schema::Subject&) = nullptr) {
  schema::Table own = schema::table_of<Own>(table.name, std::move(keys));
  if (rule != nullptr) schema::add_rule<Own>(own, rule);
  schema::include<ForceSettings>(
      table, [](auto& force) -> auto& { return force.own.template as<Own>(); }, own);
}

}  // namespace muslin
