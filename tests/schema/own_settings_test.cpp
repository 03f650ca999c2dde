// Settings of a kind that only the kind knows: held by value, read and checked through the common settings.
#include "muslin/schema/own_settings.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/schema/declare.hpp"
#include "muslin/schema/publish.hpp"

namespace muslin::schema {
namespace {

struct Sail {
  double area = 4;
};
struct Oars {
  int count = 2;
};
struct Boat {
  std::string drive = "sail";
  OwnSettings own;
};

template <class Own>
Table lifted(const char* name, Key key) {
  Table table = table_of<Boat>(name, {});
  include<Boat>(
      table, [](auto& boat) -> auto& { return boat.own.template as<Own>(); },
      table_of<Own>(name, {std::move(key)}));
  return table;
}
const Table& sail_table() {
  static const Table table = [] {
    Table sail = lifted<Sail>("sail", number("area", &Sail::area).unit("m²").range({0, 100, true}));
    sail.complete = [](const TomlTable& given, void* boat) {
      if (!given.has("area")) static_cast<Boat*>(boat)->own.as<Sail>().area = 5;
    };
    return sail;
  }();
  return table;
}
const Table& oar_table() {
  static const Table table = lifted<Oars>("oars", whole_number("count", &Oars::count).range({1, 8, false}));
  return table;
}
const Table& boat_table() {
  static const Table table = [] {
    Table boat = table_of<Boat>("boat", {word("drive", &Boat::drive, {"sail", "oars"})});
    choose(boat, "drive", &Boat::drive, {{"sail", "", sail_table}, {"oars", "", oar_table}});
    return boat;
  }();
  return table;
}

Boat read(const std::string& text) {
  const TomlValue file = parse_toml(text, "boat.toml");
  Boat boat;
  boat_table().read(boat_table().open(file, "the boat"), boat);
  return boat;
}

TEST(OwnSettings, HaveTheDefaultsOfEveryTypeUntilTheyAreSet) {
  OwnSettings own;
  EXPECT_EQ(std::as_const(own).as<Sail>().area, 4);
  own.as<Sail>().area = 7;
  const OwnSettings copy = own;
  own.as<Sail>().area = 8;
  EXPECT_EQ(copy.as<Sail>().area, 7);
  EXPECT_EQ(copy.as<Oars>().count, 2) << "another kind has its defaults";
  own.as<Oars>().count = 3;
  EXPECT_EQ(own.as<Sail>().area, 4) << "settings of another type are lost";
}

TEST(OwnSettings, AreReadCompletedWrittenAndCheckedWhereTheirWordIsChosen) {
  EXPECT_EQ(read("area = 9").own.as<Sail>().area, 9);
  EXPECT_EQ(read("").own.as<Sail>().area, 5);
  Boat boat = read("drive = 'oars'\ncount = 4");
  EXPECT_EQ(boat.drive, "oars");
  EXPECT_EQ(boat.own.as<Oars>().count, 4);
  EXPECT_EQ(to_toml(boat_table().write(boat)), "{ drive = \"oars\", count = 4 }");
  const Subject subject("boat", {});
  boat_table().check(boat, subject);
  boat.own.as<Oars>().count = 9;
  EXPECT_THROW(boat_table().check(boat, subject), Error);
  boat = {};
  boat.drive = "motor";
  try {
    boat_table().check(boat, subject);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("boat: `drive` is not one of its choices"));
  }
  EXPECT_THROW(read("drive = 'oars'\narea = 1"), Error);
}

}  // namespace
}  // namespace muslin::schema
