#include "muslin/scene/read_collider.hpp"

#include <fmt/format.h>

#include "muslin/core/nearest_name.hpp"
#include "muslin/geometry/inspect.hpp"
#include "muslin/scene/names.hpp"
#include "muslin/scene/read_parts.hpp"
#include "muslin/scene/vocabulary.hpp"

namespace muslin {
namespace {

using Shape = ColliderSettings::Shape;

constexpr double smallest = 1e-6;  // length of a shape [m]

/// The shape decides which keys are known.
Shape read_shape(const TomlValue& value, const std::string& title) {
  const TomlValue* shape = value.find("shape");
  if (value.type != TomlValue::Type::table || shape == nullptr) {
    throw Error(ErrorKind::input, value.place, title + " has no `shape`",
                "add `shape = …`, one of " + name_list(collider_shape_names()));
  }
  TomlValue shape_only;
  shape_only.keys = {"shape"};
  shape_only.items = {*shape};
  return static_cast<Shape>(
      TomlTable(shape_only, title, {"shape"}).choice("shape", collider_shape_names(), 0));
}

void read_points(const TomlTable& table, ColliderSettings& collider) {
  const TomlValue* points = table.find("points");
  const bool two = points != nullptr && points->type == TomlValue::Type::array && points->items.size() == 2;
  if (!two)
    throw table.error("points", table.title() + " has no two `points`",
                      "give the ends of its axis, [[x, y, z], [x, y, z]]");
  for (std::size_t i = 0; i < 2; ++i)
    collider.points[i] = to_vector(points->items[i], "a point of `points`", "m");
  if (!((collider.points[1] - collider.points[0]).stableNorm() >= smallest))
    throw table.error("points", "the two `points` are one", "use `shape = \"sphere\"` for a ball");
}

void read_geometry(const TomlTable& table, ColliderSettings& collider) {
  collider.center = table.has("center") ? table.vector("center", "m") : Vec3(Vec3::Zero());
  switch (collider.shape) {
    case Shape::plane:
      if (table.has("normal")) collider.normal = read_direction(table, "normal", "[0, 1, 0]");
      break;
    case Shape::sphere:
      collider.radius = table.number("radius", "m", {smallest, largest_coordinate, false});
      break;
    case Shape::capsule:
      read_points(table, collider);
      collider.radius = table.number("radius", "m", {smallest, largest_coordinate, false});
      break;
    case Shape::box: {
      const TomlValue* size = table.find("size");
      if (size == nullptr) collider.size = table.vector("size", "m");  // says what is missing
      collider.size =
          to_vector(*size, "`size` of " + table.title(), "m", {smallest, largest_coordinate, false});
      collider.rotate = table.vector("rotate", "degrees", Vec3::Zero());
      break;
    }
    case Shape::mesh:
      collider.mesh = read_path(table, "mesh");
      collider.mesh_place = table.place("mesh");
      collider.translate = table.vector("translate", "m", Vec3::Zero());
      collider.rotate = table.vector("rotate", "degrees", Vec3::Zero());
      collider.scale = read_scale(table);
      break;
  }
}

void read_sequence(const TomlTable& table, ColliderSettings& collider) {
  for (const char* key : {"frame_rate", "start"}) {
    if (table.has(key) && !table.has("sequence"))
      throw table.error(key, fmt::format("`{}` stands without `sequence`", key), "take it out");
  }
  if (!table.has("sequence")) return;
  for (const char* key : {"keyframes", "density"}) {
    if (table.has(key))
      throw table.error(key, fmt::format("`{}` stands beside `sequence`, which says how it moves", key),
                        "keep one of them");
  }
  collider.sequence = read_path(table, "sequence");
  collider.sequence_place = table.place("sequence");
  if (table.has("frame_rate") && collider.sequence.ends_with(".mdd"))
    throw table.error("frame_rate", "an .mdd stores its own frame times", "take `frame_rate` out");
  if (table.has("frame_rate")) collider.frame_rate = table.number("frame_rate", "1/s", {1e-6, 1e6, false});
  if (table.has("start")) collider.start = table.number("start", "s", {-1e9, 1e9, false});
}

void read_motion(const TomlTable& table, ColliderSettings& collider) {
  if (collider.shape == Shape::mesh) read_sequence(table, collider);
  collider.motion.keys = read_motion(table, "collider.keyframes");
  if (table.has("pivot")) collider.pivot = table.vector("pivot", "m");
  if (table.has("density")) collider.density = table.number("density", "kg/m³", {1e-6, 1e9, false});
  if (collider.is_free() && !collider.motion.keys.empty()) {
    throw table.error("density", "`density` makes a body that moves by itself, `keyframes` say how it moves",
                      "keep one of them; a [[pin]] holds or moves a body for a while");
  }
  if (table.has("pivot") && collider.motion.keys.empty())
    throw table.error("pivot", "`pivot` stands without `keyframes`", "take it out");
  for (const char* key : {"velocity", "angular_velocity"}) {
    if (table.has(key) && !collider.is_free())
      throw table.error(key, fmt::format("`{}` stands without `density`", key),
                        "give a `density` to let it move by itself, or `keyframes`");
  }
  if (!collider.is_free()) return;
  collider.velocity = table.vector("velocity", "m/s", Vec3::Zero());
  collider.angular_velocity = table.vector("angular_velocity", "degrees/s", Vec3::Zero());
}

}  // namespace

ColliderSettings read_collider(const TomlValue& value, std::size_t index) {
  const std::string title = title_of("collider", value, index);
  ColliderSettings collider;
  collider.shape = read_shape(value, title);
  const std::string& shape = name_of(collider_shape_names(), collider.shape);
  const TomlTable table(value, title + " of shape " + shape, known_keys("collider." + shape));
  collider.place = table.place();
  read_geometry(table, collider);
  const std::string stem = std::filesystem::path(collider.mesh).stem().string();
  collider.name = read_name(table, stem.empty() ? fmt::format("{}{}", shape, index) : stem);
  read_motion(table, collider);
  collider.contact = table.boolean("contact", true);
  collider.friction = read_friction(table);
  collider.colour = read_colour(table);
  return collider;
}

namespace {

/// Refuses `contact.mode`, a key of earlier versions.
void refuse_mode(const TomlTable& top) {
  const TomlValue* contact = top.find("contact");
  if (contact == nullptr || contact->type != TomlValue::Type::table) return;
  const TomlValue* mode = contact->find("mode");
  if (mode == nullptr) return;
  throw Error(ErrorKind::input, mode->key_place,
              "contact.mode is gone: every scene is solved in one way",
              "take it out, and set solver.effort = \"draft\", \"normal\" or \"exact\" if it matters");
}

}  // namespace

ContactSettings read_contact(const TomlTable& top) {
  ContactSettings contact;
  refuse_mode(top);
  const auto table = top.table("contact", known_keys("contact"));
  if (!table) return contact;
  contact.given = true;
  contact.place = table->place();
  if (table->has("distance")) contact.distance = table->number("distance", "m", {1e-9, 1e6, false});
  contact.friction = read_friction(*table).value_or(contact.friction);
  return contact;
}

}  // namespace muslin
