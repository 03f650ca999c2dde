#include "muslin/component/collider/collider_table.hpp"

#include <string>
#include <utility>
#include <vector>

#include "muslin/component/component_keys.hpp"
#include "muslin/component/kinds.hpp"
#include "muslin/geometry/inspect.hpp"
#include "muslin/schema/declare.hpp"

namespace muslin {
namespace {

using schema::Key;
using schema::Subject;
using Collider = ColliderSettings;
using Shape = ColliderSettings::Shape;

constexpr double smallest = 1e-6;  // length of a shape [m]
constexpr Range length{smallest, largest_coordinate, false};

Key center_key(const char* meaning) {
  return schema::vector("center", &Collider::center).unit("m").means(meaning);
}

Key radius_key() {
  return schema::number("radius", &Collider::radius).unit("m").range(length).required().means("its radius");
}

Key rotate_key(const char* meaning) {
  return schema::vector("rotate", &Collider::rotate).unit("degrees").means(meaning);
}

void read_points(const Key& key, const TomlTable& table, Collider& collider) {
  const TomlValue& points = *table.find(key.name);
  if (points.type != TomlValue::Type::array || points.items.size() != 2)
    throw table.error(key.name, fmt::format("{} has no two `points`", table.title()), key.missing);
  for (std::size_t i = 0; i < 2; ++i)
    collider.points[i] = to_vector(points.items[i], "a point of `points`", key.unit);
}

Key points_key() {
  Key key =
      schema::custom<Collider>("points", {schema::Type::points}, read_points,
                               [](const Key& k, const Collider& collider, TomlValue& out) {
                                 schema::append(out, k.name,
                                                schema::list({schema::vector_value(collider.points[0]),
                                                              schema::vector_value(collider.points[1])}));
                               })
          .unit("m")
          .required("give the ends of its axis, [[x, y, z], [x, y, z]]")
          .means("the two ends of its axis, `[[x, y, z], [x, y, z]]`; round caps reach a radius beyond");
  key.count = 2;
  return key;
}

/// The keys of a shape: its own, then those of each kind of component that it may be.
schema::Table shape_table(Shape shape, std::vector<Key> keys) {
  for (const ColliderKind& kind : collider_kinds())
    for (Key& key : kind.keys(shape)) keys.push_back(std::move(key));
  return schema::table_of<Collider>(name_of(shape), std::move(keys));
}

const schema::Table& plane_table() {
  static const schema::Table table = [] {
    schema::Table plane = shape_table(
        Shape::plane, {center_key("any point of the plane"),
                       schema::direction("normal", &Collider::normal, "[0, 1, 0]")
                           .means("points to the side where bodies are; they cannot reach the other side")});
    schema::add_rule<Collider>(plane, [](const Collider& collider, const Subject& subject) {
      if (!(std::abs(collider.normal.norm() - 1) <= 1e-9))
        throw subject.error("normal", "`normal` is not of length 1", "normalise it");
      if (collider.is_free())
        throw subject.error("density", "a plane has a `density`", "remove it: planes stand still");
    });
    return plane;
  }();
  return table;
}

const schema::Table& sphere_table() {
  static const schema::Table table = shape_table(Shape::sphere, {center_key("its centre"), radius_key()});
  return table;
}

const schema::Table& capsule_table() {
  static const schema::Table table = [] {
    schema::Table capsule = shape_table(Shape::capsule, {points_key(), radius_key()});
    schema::add_rule<Collider>(capsule, [](const Collider& collider, const Subject& subject) {
      if (!((collider.points[1] - collider.points[0]).stableNorm() >= smallest))
        throw subject.error("points", "the two `points` are one", "use `shape = \"sphere\"` for a ball");
    });
    return capsule;
  }();
  return table;
}

const schema::Table& box_table() {
  static const schema::Table table = shape_table(Shape::box, {center_key("its centre"),
                                                              schema::vector("size", &Collider::size)
                                                                  .unit("m")
                                                                  .range(length)
                                                                  .required()
                                                                  .means("lengths along x, y and z"),
                                                              rotate_key("as of a body, about its centre")});
  return table;
}

const schema::Table& mesh_table() {
  static const schema::Table table = [] {
    schema::Table mesh = shape_table(
        Shape::mesh,
        {schema::path("mesh", &Collider::mesh, &Collider::mesh_place)
             .required()
             .means("a file in a format of a body's mesh; open meshes stop bodies from both sides"),
         schema::vector("translate", &Collider::translate).unit("m").means("as of a body"),
         rotate_key("as of a body"), scale_key(&Collider::scale)});
    schema::add_rule<Collider>(mesh, [](const Collider& collider, const Subject& subject) {
      if (collider.frame_rate && collider.sequence.ends_with(".mdd"))
        throw subject.error("frame_rate", "an .mdd stores its own frame times", "take `frame_rate` out");
    });
    return mesh;
  }();
  return table;
}

schema::Table declare_collider() {
  const std::vector<schema::Variant> variants = {{name_of(Shape::plane), "", plane_table},
                                                 {name_of(Shape::sphere), "", sphere_table},
                                                 {name_of(Shape::capsule), "", capsule_table},
                                                 {name_of(Shape::box), "", box_table},
                                                 {name_of(Shape::mesh), "", mesh_table}};
  std::vector<std::string> shapes;
  for (const schema::Variant& variant : variants) shapes.push_back(variant.word);
  schema::Table table = schema::table_of<Collider>(
      "[[collider]]",
      {name_key<Collider>("`sphere0`, `box1`, …, the mesh's file name")
           .means("different for each body and collider"),
       schema::word("shape", &Collider::shape, shapes)
           .required()
           .means("`\"plane\"`, `\"sphere\"`, `\"capsule\"`, `\"box\"` or `\"mesh\"`"),
       schema::vector("pivot", &Collider::pivot)
           .unit("m")
           .otherwise("middle of the shape; `center` of a plane")
           .needs("keyframes", "remove it")
           .means("point about which `rotate` of the keyframes turns, before `translate`"),
       schema::within<Collider>(
           &Collider::motion,
           motion_key()
               .excludes("sequence", "`keyframes` stands beside `sequence`, which says how it moves")
               .may_change_on_resume()
               .means("motion relative to its initial position: a list of tables; times ascend")),
       schema::truth("contact", &Collider::contact)
           .means("`false` excludes it from contact; it is only drawn"),
       friction_key(&Collider::friction).varies(&Collider::variations, {.keyframes = true}),
       layer_key(&Collider::layer),
       schema::colour("colour", &Collider::colour)
           .may_change_on_resume()
           .otherwise("grey")
           .means("colour in pictures")});
  schema::choose(table, "shape", &Collider::shape, variants);
  schema::add_rule<Collider>(table, [](const Collider& collider, const Subject& subject) {
    if (collider.motion.scales())
      throw subject.error("keyframes", "a keyframe of a collider has a `scale`",
                          "colliders keep their size; scale the mesh in a `sequence`");
  });
  for (Key& key : table.keys) {
    if (key.name == "keyframes")  // a rigid body has none
      key.shown = [](const void* s) { return !static_cast<const Collider*>(s)->is_free(); };
  }
  return table;
}

}  // namespace

const schema::Table& collider_table() {
  static const schema::Table table = declare_collider();
  return table;
}

}  // namespace muslin
