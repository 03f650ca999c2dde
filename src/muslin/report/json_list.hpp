// Reads lists of JSON objects that another version may have written.
#pragma once

#include <nlohmann/json.hpp>

namespace muslin {

/// Returns the list `key` of an object; an empty one where there is none.
inline const nlohmann::ordered_json& json_list(const nlohmann::ordered_json& object, const char* key) {
  static const nlohmann::ordered_json empty = nlohmann::ordered_json::array();
  const auto found = object.is_object() ? object.find(key) : object.end();
  return found != object.end() && found->is_array() ? *found : empty;
}

}  // namespace muslin
