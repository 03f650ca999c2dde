// Declares keys that several tables of a scene have, and resolves names, including the name of the body that
// a table refers to.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "muslin/component/component_keys.hpp"
#include "muslin/scene/scene.hpp"
#include "muslin/schema/declare.hpp"

namespace muslin {

/// `from` and `until`; `otherwise` states the end where it is not given. check_window is their rule.
template <class S>
std::vector<schema::Key> window_keys(double S::* from, double S::* until, const char* from_means,
                                     const char* until_means, const char* otherwise) {
  schema::Key end = schema::number("until", until).unit("s").otherwise(otherwise).means(until_means);
  end.check = nullptr;  // may be infinite
  return {schema::number("from", from).unit("s").means(from_means), end};
}
/// Throws subject.error(…) unless until > from.
void check_window(double from, double until, const schema::Subject& subject);

/// A number, or `{ keyframes = [{ time, value, interpolation }, …] }`: a number over time.
const schema::Table& keyed_number_table();  ///< of KeyedNumber
void read_keyed_number(const schema::Key& key, const TomlTable& table, KeyedNumber& number);
void write_keyed_number(const schema::Key& key, const KeyedNumber& number, TomlValue& out);
void check_keyed_number(const schema::Key& key, const KeyedNumber& number, const schema::Subject& subject);
template <class S>
schema::Declaration keyed_number_key(std::string name, KeyedNumber S::* member, Range range) {
  schema::Key key = schema::custom<S>(
      std::move(name), {schema::Type::number, schema::Type::table},
      [=](const schema::Key& k, const TomlTable& table, S& s) { read_keyed_number(k, table, s.*member); },
      [=](const schema::Key& k, const S& s, TomlValue& out) { write_keyed_number(k, s.*member, out); });
  key.range = range;
  key.table = keyed_number_table;
  key.check = [=](const schema::Key& k, const void* s, const schema::Subject& subject) {
    check_keyed_number(k, static_cast<const S*>(s)->*member, subject);
  };
  return schema::Declaration(std::move(key));
}

/// Returns the names of all that have mass: bodies, and colliders with a density.
std::vector<std::string> movable_names(const Scene& scene);
/// Returns the names of all bodies and colliders.
std::vector<std::string> all_names(const Scene& scene);
/// True if a collider has this name.
bool is_rigid(const Scene& scene, const std::string& name);
/// Throws Error(input) if the scene has nothing that moves.
void require_movable(const Scene& scene);
/// Replaces an empty name by the name of the only body or, if `all_allowed`, leaves it empty, which means all
/// bodies. Errors: input.
void resolve_body(const TomlTable& table, const Scene& scene, bool all_allowed, std::string& body);

/// Gives the item a default name if it has none. Throws Error(input) if one of `others` has the same name.
void complete_name(const TomlTable& table, const std::string& fallback, std::string& name);
[[noreturn]] void refuse_name(const TomlTable& table, const std::string& other_kind, const std::string& kind,
                              const std::string& name);
template <class T>
void require_new_name(const TomlTable& table, const std::vector<T>& others, const std::string& other_kind,
                      const std::string& kind, const std::string& name) {
  for (const T& other : others)
    if (other.name == name) refuse_name(table, other_kind, kind, name);
}

}  // namespace muslin
