#include "muslin/scene/read_parts.hpp"

#include <algorithm>

#include "muslin/scene/placement.hpp"
#include "muslin/scene/vocabulary.hpp"

namespace muslin {

std::string title_of(const std::string& kind, const TomlValue& value, std::size_t index) {
  const TomlValue* name = value.find("name");
  const bool has_name = name != nullptr && name->type == TomlValue::Type::string;
  return "[[" + kind + "]] " + (has_name ? name->string : std::to_string(index));
}

void require_name(const std::string& name, const Place& place) {
  const bool bad = name.empty() || name.size() > 100 || name.front() == '.' ||
                   name.find_first_of("/\\:*?\"<>|,") != std::string::npos ||
                   std::any_of(name.begin(), name.end(),
                               [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; });
  if (bad) {
    throw Error(ErrorKind::input, place, "`" + name.substr(0, 40) + "` cannot be a name",
                "use 1 to 100 letters, digits, `_`, `-`, `.` or spaces, not starting with a dot");
  }
}

std::string read_name(const TomlTable& table, const std::string& fallback) {
  const std::string name = table.string("name", fallback);
  require_name(name, table.place("name"));
  return name;
}

std::string read_path(const TomlTable& table, const char* key) {
  const std::string path = table.string(key);
  if (path.empty() || path.find('\0') != std::string::npos)
    throw table.error(key, fmt::format("`{}` is no path", key), "name a mesh file");
  return path;
}

Vec3 read_scale(const TomlTable& table) {
  const TomlValue* value = table.find("scale");
  if (value == nullptr) return Vec3::Ones();
  const std::string name = "`scale` of " + table.title();
  if (value->type == TomlValue::Type::array) return to_vector(*value, name, "", Range::positive());
  return Vec3::Constant(to_number(*value, name, "", Range::positive()));
}

std::optional<double> read_friction(const TomlTable& table) {
  if (!table.has("friction")) return std::nullopt;
  return table.number("friction", "", {0, 100, false});
}

std::optional<Vec3> read_colour(const TomlTable& table) {
  if (!table.has("colour")) return std::nullopt;
  const Vec3 colour = table.vector("colour", "sRGB 0 to 1");
  if (colour.minCoeff() < 0 || colour.maxCoeff() > 1)
    throw table.error("colour", "a colour is red, green and blue from 0 to 1",
                      "write for example [0.2, 0.5, 0.2]");
  return colour;
}

Vec3 read_direction(const TomlTable& table, const char* key, const char* example) {
  const Vec3 direction = table.vector(key, "");
  const double length = direction.stableNorm();
  if (!(length > 0))
    throw table.error(key, fmt::format("`{}` has no direction", key),
                      fmt::format("give for example {}", example));
  return direction / length;
}

std::vector<Motion::Key> read_motion(const TomlTable& owner, const char* vocabulary) {
  std::vector<Motion::Key> keys;
  read_keyframes(owner, known_keys(vocabulary), [&](const TomlTable& key, double time) {
    keys.push_back({time, key.vector("translate", "m", Vec3::Zero()),
                    rotation_from_degrees(key.vector("rotate", "degrees", Vec3::Zero()))});
  });
  return keys;
}

}  // namespace muslin
