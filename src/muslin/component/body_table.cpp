#include "muslin/component/body_table.hpp"

#include <string>
#include <utility>
#include <vector>

#include "muslin/component/component_keys.hpp"
#include "muslin/component/kinds.hpp"
#include "muslin/schema/declare.hpp"

namespace muslin {
namespace {

/// The keys of every body that follow those of its kind.
std::vector<schema::Key> placed_keys() {
  return {
      schema::vector("translate", &BodySettings::translate).unit("m").means("displacement, applied last"),
      schema::vector("rotate", &BodySettings::rotate)
          .unit("degrees")
          .means("angles about the x axis, then y, then z"),
      scale_key(&BodySettings::scale),
      schema::number("weld", &BodySettings::weld)
          .unit("m")
          .range({0, 1, true})
          .otherwise("none are joined")
          .means("joins vertices of the mesh that lie nearer than this, after `scale`; files that are "
                 "written keep all vertices"),
      schema::vector("velocity", &BodySettings::velocity).unit("m/s").means("velocity at the start"),
      schema::truth("contact", &BodySettings::contact).means("`false` excludes the body from contact"),
      schema::truth("self_contact", &BodySettings::self_contact)
          .means("`false` excludes contact of the body with itself"),
      friction_key(&BodySettings::friction)
          .varies(&BodySettings::variations, {.map = true, .keyframes = true}),
      layer_key(&BodySettings::layer),
      schema::colour("colour", &BodySettings::colour)
          .may_change_on_resume()
          .otherwise("one of a palette")
          .means("colour of the body in pictures: red, green, blue"),
  };
}

schema::Table declare_body() {
  std::vector<std::string> models;
  std::vector<schema::Variant> variants;
  std::string meaning;
  for (const BodyKind& kind : body_kinds()) {
    models.emplace_back(kind.name);
    variants.push_back({kind.name, kind.plural, kind.keys});
    meaning += fmt::format("{}`\"{}\"`: {}", meaning.empty() ? "" : " · ", kind.name, kind.meaning);
  }
  schema::Table table = schema::table_of<BodySettings>(
      "[[body]]", {name_key<BodySettings>("the mesh's file name")
                       .means("used in file names, messages and by pins; different for each body"),
                   schema::path("mesh", &BodySettings::mesh, &BodySettings::mesh_place)
                       .required()
                       .means("`.obj`, `.ply`, `.stl`, `.gltf`, `.glb`, `.dae` or `.fbx`"),
                   schema::word("model", &BodySettings::model, models).means(meaning)});
  for (schema::Key& key : placed_keys()) table.keys.push_back(std::move(key));
  schema::choose(table, "model", &BodySettings::model, std::move(variants));
  return table;
}

}  // namespace

const schema::Table& body_table() {
  static const schema::Table table = declare_body();
  return table;
}

}  // namespace muslin
