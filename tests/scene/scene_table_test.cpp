// The declaration of the scene file is complete, and its JSON Schema is closed.
#include "muslin/scene/scene_table.hpp"

#include <functional>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "muslin/component/kinds.hpp"
#include "muslin/scene/force_kinds.hpp"
#include "muslin/schema/publish.hpp"
#include "muslin/schema/walk.hpp"

namespace muslin {
namespace {

using nlohmann::json;

/// Every object of a JSON document, with the path to it.
void visit(const json& value, const std::string& path,
           const std::function<void(const json&, const std::string&)>& see) {
  if (value.is_object()) see(value, path);
  if (!value.is_structured()) return;
  for (const auto& [key, item] : value.items()) visit(item, path + "/" + key, see);
}

TEST(SceneTable, EveryKeyIsDescribedReadAndUnique) {
  std::set<std::string> tables;
  for (const schema::Table* table : schema::tables_in(scene_table())) {
    EXPECT_TRUE(tables.insert(schema::plain_name(*table)).second) << table->name;
    for (const schema::Shape& shape : schema::shapes_of(*table)) {
      std::set<std::string> names;
      for (const schema::Key* key : shape.keys()) {
        EXPECT_TRUE(names.insert(key->name).second) << key->name << " of " << table->name;
        EXPECT_FALSE(key->meaning.empty()) << key->name << " of " << table->name;
        EXPECT_TRUE(key->read && key->write) << key->name << " of " << table->name;
      }
    }
  }
  EXPECT_GT(tables.size(), 15u);
}

TEST(SceneTable, ColoursTitlesStiffnessAndSettingsOutsideBodiesMayChangeOnResume) {
  for (const char* path : {"title", "time.duration", "time.steps_per_frame", "solver.effort",
                           "contact.distance", "pin.0.where.nearest.1", "pin.-", "force.1", "probe.0.at.2",
                           "body.0.colour.2", "body.1.friction", "body.1.stretch_limit",
                           "body.0.material.edge_modulus", "body.0.material.bending_warp.keyframes.1.value",
                           "collider.0.keyframes.0.time", "collider.0.friction", "collider.2.colour"})
    EXPECT_TRUE(schema::may_change_on_resume(scene_table(), path)) << path;
  for (const char* path :
       {"time.frame_rate", "body.0.mesh", "body.0.material.density", "body.0.material.areal_density",
        "body.0.material.law", "body.0.voxel_width", "body.2", "body.-", "collider.0.density", "collider.1",
        "collider.0.pivot.0", "nothing"})
    EXPECT_FALSE(schema::may_change_on_resume(scene_table(), path)) << path;
}

TEST(SceneTable, JsonSchemaIsClosedAndDescribed) {
  const json document = json::parse(schema::json_schema(scene_table(), "muslin scene"));
  int objects = 0;
  visit(document, "", [&](const json& value, const std::string& path) {
    if (value.contains("$ref")) {
      const std::string pointer = value["$ref"].get<std::string>().substr(1);
      EXPECT_TRUE(document.contains(json::json_pointer(pointer))) << path;
    }
    if (!value.contains("properties")) return;
    ++objects;
    EXPECT_EQ(value["additionalProperties"], false) << path;
    for (const auto& [key, property] : value["properties"].items())
      EXPECT_TRUE(property.contains("description")) << path << " " << key;
    for (const json& key : value.value("required", json::array()))
      EXPECT_TRUE(value["properties"].contains(key.get<std::string>())) << path << " " << key;
  });
  EXPECT_GT(objects, 20);
  EXPECT_EQ(document["$defs"]["body"]["oneOf"].size(), body_kinds().size());
  EXPECT_EQ(document["$defs"]["collider"]["oneOf"].size(), 5u);
  EXPECT_EQ(document["$defs"]["force"]["oneOf"].size(), force_kinds().size());
  EXPECT_EQ(document["$defs"]["time"]["properties"]["duration"]["default"], 2);
}

}  // namespace
}  // namespace muslin
