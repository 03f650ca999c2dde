// Declares keys whose value is a list of points, and the shapes that selections and regions share.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "muslin/schema/declare.hpp"

namespace muslin {

/// Errors: input, unless the value is a list of points.
std::vector<Vec3> read_points(const schema::Key& key, const TomlTable& table);
void write_points(const schema::Key& key, const std::vector<Vec3>& points, TomlValue& out);

/// Errors: input, unless the value is a list of two points, the smaller coordinates first.
std::pair<Vec3, Vec3> read_corners(const schema::Key& key, const TomlTable& table);

/// `box = [[x, y, z], [x, y, z]]`. The member is a shape with `min` and `max`.
template <class S, class Shape>
schema::Declaration box_key(std::optional<Shape> S::* member) {
  schema::Key key = schema::custom<S>(
      "box", {schema::Type::points},
      [=](const schema::Key& k, const TomlTable& table, S& s) {
        const auto [min, max] = read_corners(k, table);
        s.*member = Shape{min, max};
      },
      [=](const schema::Key& k, const S& s, TomlValue& out) {
        if (s.*member) write_points(k, {(s.*member)->min, (s.*member)->max}, out);
      });
  key.unit = "m";
  key.count = 2;
  return schema::Declaration(std::move(key));
}

/// The keys of a ball: of a shape with `center` and `radius`.
template <class Sphere>
schema::Table sphere_keys(std::string table) {
  return schema::table_of<Sphere>(
      std::move(table), {schema::vector("center", &Sphere::center).unit("m").required().means("its centre"),
                         schema::number("radius", &Sphere::radius)
                             .unit("m")
                             .range(Range::positive())
                             .required()
                             .means("its radius")});
}

}  // namespace muslin
