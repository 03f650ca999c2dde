#include "muslin/schema/value.hpp"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace muslin::schema {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const TomlValue& value) {
  Json json;
  switch (value.type) {
    case TomlValue::Type::boolean:
      return value.boolean;
    case TomlValue::Type::integer:
      return value.integer;
    case TomlValue::Type::real:
      return value.real;  // written as null where it is not finite
    case TomlValue::Type::string:
    case TomlValue::Type::date:
      return value.string;
    case TomlValue::Type::array:
      json = Json::array();
      for (const TomlValue& item : value.items) json.push_back(json_of(item));
      return json;
    case TomlValue::Type::table:
      json = Json::object();
      for (std::size_t i = 0; i < value.keys.size(); ++i) json[value.keys[i]] = json_of(value.items[i]);
      return json;
  }
  return json;
}

}  // namespace

TomlValue real(double x) {
  TomlValue value;
  value.type = TomlValue::Type::real;
  value.real = x;
  return value;
}

TomlValue whole(std::int64_t x) {
  TomlValue value;
  value.type = TomlValue::Type::integer;
  value.integer = x;
  return value;
}

TomlValue truth_value(bool x) {
  TomlValue value;
  value.type = TomlValue::Type::boolean;
  value.boolean = x;
  return value;
}

TomlValue words(std::string text) {
  TomlValue value;
  value.type = TomlValue::Type::string;
  value.string = std::move(text);
  return value;
}

TomlValue list(std::vector<TomlValue> items) {
  TomlValue value;
  value.type = TomlValue::Type::array;
  value.items = std::move(items);
  return value;
}

TomlValue vector_value(const Vec3& v) { return list({real(v.x()), real(v.y()), real(v.z())}); }

void append(TomlValue& table, std::string key, TomlValue value) {
  table.keys.push_back(std::move(key));
  table.items.push_back(std::move(value));
}

std::string to_json(const TomlValue& value) {
  return json_of(value).dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string to_toml(const TomlValue& value) {
  std::string text;
  switch (value.type) {
    case TomlValue::Type::boolean:
      return value.boolean ? "true" : "false";
    case TomlValue::Type::integer:
      return fmt::format("{}", value.integer);
    case TomlValue::Type::real:
      text = fmt::format("{}", value.real);
      if (const std::size_t at = text.find("e-0"); at != std::string::npos) text.erase(at + 2, 1);
      return text;
    case TomlValue::Type::string:
    case TomlValue::Type::date:
      return fmt::format("\"{}\"", value.string);
    case TomlValue::Type::array:
      for (const TomlValue& item : value.items)
        text += fmt::format("{}{}", text.empty() ? "" : ", ", to_toml(item));
      return fmt::format("[{}]", text);
    case TomlValue::Type::table:
      for (std::size_t i = 0; i < value.keys.size(); ++i)
        text += fmt::format("{}{} = {}", i == 0 ? " " : ", ", value.keys[i], to_toml(value.items[i]));
      return text.empty() ? "{}" : fmt::format("{{{} }}", text);
  }
  return text;
}

}  // namespace muslin::schema
