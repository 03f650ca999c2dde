#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "muslin/schema/publish.hpp"
#include "muslin/schema/value.hpp"
#include "muslin/schema/walk.hpp"

namespace muslin::schema {
namespace {

using Json = nlohmann::ordered_json;

Json reference(const Table& table) { return {{"$ref", fmt::format("#/$defs/{}", plain_name(table))}}; }

Json number_schema(const char* type, const Range& range) {
  Json json = {{"type", type}};
  if (std::isfinite(range.min)) json[range.open_min ? "exclusiveMinimum" : "minimum"] = range.min;
  if (std::isfinite(range.max)) json["maximum"] = range.max;
  return json;
}

Json list_schema(Json items, std::size_t count) {
  Json json = {{"type", "array"}, {"items", std::move(items)}};
  if (count > 0) json["minItems"] = json["maxItems"] = count;
  return json;
}

/// A curve may begin with the origin, which does not count among its points.
Json curve_schema(const Key& key) {
  const Json point = {
      {"type", "array"},
      {"prefixItems", {number_schema("number", key.range), {{"type", "number"}, {"minimum", 0}}}},
      {"minItems", 2},
      {"maxItems", 2}};
  const Json origin = {
      {"prefixItems", Json::array({{{"const", {0, 0}}}})}, {"minItems", 2}, {"maxItems", key.count + 1}};
  return {{"type", "array"},
          {"items", point},
          {"minItems", 1},
          {"anyOf", Json::array({Json{{"maxItems", key.count}}, origin})}};
}

Json type_schema(const Key& key, Type type) {
  switch (type) {
    case Type::number:
      return number_schema("number", key.range);
    case Type::whole_number:
      return number_schema("integer", key.range);
    case Type::truth:
      return {{"type", "boolean"}};
    case Type::text:
      return {{"type", "string"}};
    case Type::texts: {
      Json item = {{"type", "string"}};
      if (key.table != nullptr) item = {{"anyOf", Json::array({item, reference(key.table())})}};
      return list_schema(item, key.count);
    }
    case Type::path:
      return {{"type", "string"}, {"minLength", 1}};
    case Type::word:
      return {{"enum", key.choices}};
    case Type::vector:
      return list_schema(number_schema("number", key.range), 3);
    case Type::points:
      return list_schema(list_schema(number_schema("number", key.range), 3), key.count);
    case Type::curve:
      return curve_schema(key);
    case Type::table:
      return reference(key.table());
    case Type::tables:
      return list_schema(reference(key.table()), 0);
  }
  return {};
}

Json value_schema(const Table& table, const Key& key) {
  Json json;
  if (key.types.size() == 1) {
    json = type_schema(key, key.types.front());
  } else {
    for (const Type type : key.types) json["anyOf"].push_back(type_schema(key, type));
  }
  std::string description = key.meaning;
  if (!key.unit.empty()) description += fmt::format(" [{}]", key.unit);
  if (!key.otherwise.empty()) description += ". Default: " + key.otherwise;
  if (key.may_change_on_resume) description += ". May change on --resume";
  json["description"] = description;
  if (const auto value = default_of(table, key)) json["default"] = Json::parse(to_json(*value));
  return json;
}

bool has(const std::vector<const Key*>& keys, const std::string& name) {
  return std::any_of(keys.begin(), keys.end(), [&](const Key* key) { return key->name == name; });
}

Json given(const std::vector<std::string>& keys) { return {{"required", keys}}; }

/// Adds which keys must, and which may not, be given beside which.
void add_presence(const Key& key, const std::vector<const Key*>& keys, Json& json) {
  if (key.required) {
    Json any = Json::array({given({key.name})});
    for (const std::string& other : key.unless)
      if (has(keys, other)) any.push_back(given({other}));
    if (any.size() > 1) {
      json["allOf"].push_back({{"anyOf", any}});
    } else {
      json["required"].push_back(key.name);
    }
  }
  for (const Key::Need& need : key.needs) json["dependentRequired"][key.name].push_back(need.other);
  for (const Key::Conflict& conflict : key.conflicts)
    if (has(keys, conflict.other)) json["allOf"].push_back({{"not", given({key.name, conflict.other})}});
}

Json object_schema(const Shape& shape) {
  Json json = {{"type", "object"}, {"additionalProperties", false}, {"properties", Json::object()}};
  const std::vector<const Key*> keys = shape.keys();
  for (const Key* key : keys) {
    Json& property = json["properties"][key->name] = value_schema(*shape.table, *key);
    const bool chooses = shape.variant != Table::none && key == &shape.table->keys[shape.table->chooser];
    add_presence(*key, keys, json);
    if (!chooses) continue;
    property["enum"] = {shape.word()};
    if (!key->required && shape.variant > 0) json["required"].push_back(key->name);
  }
  return json;
}

Json table_schema(const Table& table) {
  const std::vector<Shape> shapes = shapes_of(table);
  if (shapes.size() == 1) return object_schema(shapes.front());
  Json json;
  for (const Shape& shape : shapes) json["oneOf"].push_back(object_schema(shape));
  return json;
}

}  // namespace

std::string json_schema(const Table& table, const std::string& title) {
  Json json = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", title}};
  json.update(table_schema(table));
  for (const Table* inner : tables_in(table))
    if (inner != &table) json["$defs"][plain_name(*inner)] = table_schema(*inner);
  return json.dump(2) + "\n";
}

}  // namespace muslin::schema
