#include "muslin/scene/points_key.hpp"

namespace muslin {

std::vector<Vec3> read_points(const schema::Key& key, const TomlTable& table) {
  std::vector<Vec3> points;
  for (const TomlValue& item : *table.array(key.name, "points, [[x, y, z], …]"))
    points.push_back(to_vector(item, fmt::format("a point of `{}`", key.name), key.unit));
  return points;
}

void write_points(const schema::Key& key, const std::vector<Vec3>& points, TomlValue& out) {
  TomlValue items = schema::list({});
  for (const Vec3& point : points) items.items.push_back(schema::vector_value(point));
  schema::append(out, key.name, std::move(items));
}

std::pair<Vec3, Vec3> read_corners(const schema::Key& key, const TomlTable& table) {
  const auto& corners = *table.array(key.name, "two corners, [[x, y, z], [x, y, z]]");
  if (corners.size() != 2) {
    throw table.error(key.name, fmt::format("`{}` is a list of {}", key.name, corners.size()),
                      "give its two corners, [[x, y, z], [x, y, z]]");
  }
  const Vec3 min = to_vector(corners[0], fmt::format("the first corner of `{}`", key.name), key.unit);
  const Vec3 max = to_vector(corners[1], fmt::format("the second corner of `{}`", key.name), key.unit);
  if ((min.array() > max.array()).any()) {
    throw table.error(
        key.name, fmt::format("the first corner of `{}` is not below the second along every axis", key.name),
        "give the corner of the smallest coordinates first");
  }
  return {min, max};
}

}  // namespace muslin
