// The object `contact` of run.json: it reads as it was written, and damage is an error that says what to do.
#include "muslin/cache/contact_record.hpp"

#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

using Json = nlohmann::ordered_json;

Json intact() {
  return Json::parse(R"({"distance": 0.001, "bodies": [
    {"name": "cloth", "points": 49, "radius": 0.0005, "self_contact": true, "fixed": false},
    {"name": "arm", "points": 2, "radius": 0.1, "self_contact": false, "fixed": true,
     "axis": [[0, 1, 0], [0, 2, 0.5]]}]})");
}

TEST(ContactRecord, ReadsBodiesInTheirOrder) {
  const ContactRecord record = read_contact_record(intact());
  EXPECT_EQ(record.distance, 0.001);
  ASSERT_EQ(record.bodies.size(), 2U);
  EXPECT_EQ(record.bodies[0].name, "cloth");
  EXPECT_EQ(record.bodies[0].points, 49U);
  EXPECT_TRUE(record.bodies[0].self_contact);
  EXPECT_TRUE(record.bodies[0].axis.empty());
  EXPECT_EQ(record.bodies[1].radius, 0.1);
  EXPECT_TRUE(record.bodies[1].fixed);
  EXPECT_THAT(record.bodies[1].axis, testing::ElementsAre(Vec3(0, 1, 0), Vec3(0, 2, 0.5)));
}

TEST(ContactRecord, KeepsTheRulesOfPairs) {
  ContactRule rule;
  rule.sides[0] = {0, 1, 2, 4};
  rule.sides[1] = {5};
  rule.touches = false;
  rule.thickness = 0.002;
  rule.until = 0.5;
  ContactModel model;
  model.surface = std::make_shared<ContactSurface>(
      std::vector<Vec3i>{{0, 1, 2}, {2, 3, 4}}, std::vector<int>{0, 0, 0, 0, 0, 1},
      std::vector<ContactBody>(2), std::vector<ContactPlane>(), ContactRules({rule, ContactRule()}, 6));
  model.rest.resize(6);
  const Json written = contact_record_json(model);
  EXPECT_EQ(written["rules"][0]["points"], Json::parse("[[[0, 2], [4, 4]], [[5, 5]]]"));
  const ContactRecord record = read_contact_record(written);
  ASSERT_EQ(record.rules.size(), 2U);
  EXPECT_EQ(record.rules[0].sides, rule.sides);
  EXPECT_FALSE(record.rules[0].touches);
  EXPECT_EQ(record.rules[0].thickness, 0.002);
  EXPECT_EQ(record.rules[0].until, 0.5);
  EXPECT_FALSE(record.rules[1].thickness);
  EXPECT_EQ(record.rules[1].until, ContactRule().until);
  Json far = written;
  far["rules"][0]["points"][1] = Json::parse("[[5, 1000000000]]");
  EXPECT_THROW(read_contact_record(far), Error);
}

TEST(ContactRecord, KeepsRadiiThatVary) {
  ContactModel model;
  model.surface = std::make_shared<ContactSurface>(
      std::vector<Vec3i>{{1, 2, 3}}, std::vector<int>{0, 1, 1, 1}, std::vector<ContactBody>{{}, {0.003}},
      std::vector<ContactPlane>(), ContactRules(), ContactPointNumbers{{}, {-1, 0.001, 0.002, 0.003}});
  model.rest.resize(4);
  const Json written = contact_record_json(model);
  const ContactRecord record = read_contact_record(written);
  EXPECT_TRUE(record.bodies[0].radii.empty());
  EXPECT_EQ(record.bodies[1].radius, 0.003);
  EXPECT_THAT(record.bodies[1].radii, testing::ElementsAre(0.001, 0.002, 0.003));
  Json shorter = written;
  shorter["bodies"][1]["radii"].erase(0);
  EXPECT_THROW(read_contact_record(shorter), Error);
}

TEST(ContactRecord, RefusesDamage) {
  const auto message = [](const Json& contact) {
    try {
      read_contact_record(contact);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("read");
  };
  const std::string damaged = "the object `contact` is damaged; run the scene again";
  ASSERT_EQ(message(intact()), "read");
  EXPECT_EQ(message(Json()), damaged);
  EXPECT_EQ(message(Json::array()), damaged);
  for (const char* key : {"distance", "bodies"}) {
    Json without = intact(), other = intact();
    without.erase(key);
    other[key] = "far";
    EXPECT_EQ(message(without), damaged) << key;
    EXPECT_EQ(message(other), damaged) << key;
  }
  for (const char* key : {"name", "points", "radius", "self_contact", "fixed"}) {
    Json without = intact(), other = intact();
    without["bodies"][1].erase(key);
    other["bodies"][1][key] = Json::array();
    EXPECT_EQ(message(without), damaged) << key;
    EXPECT_EQ(message(other), damaged) << key;
  }
  for (const char* axis : {"[[0, 1]]", "[0, 1, 0]", "[[0, 1, null]]", "7", "[{}]"}) {
    Json contact = intact();
    contact["bodies"][1]["axis"] = Json::parse(axis);
    EXPECT_EQ(message(contact), damaged) << axis;
  }
}

}  // namespace
}  // namespace muslin
