// The object `contact` of run.json: it reads as it was written, and damage is an error that says what to do.
#include "muslin/cache/contact_record.hpp"

#include <string>

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
