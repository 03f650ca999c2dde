// Reading TOML: places, types, ranges, units and unknown keys.
#include "muslin/core/toml_table.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/core/nearest_name.hpp"

namespace muslin {
namespace {

using testing::HasSubstr;

template <class Action>
std::string message(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.what();
  }
  return "no error";
}

TEST(NearestName, CountsInsertionsDeletionsReplacementsAndSwaps) {
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  EXPECT_EQ(edit_distance("duratoin", "duration"), 1);
  EXPECT_EQ(edit_distance("Mesh", "mesh"), 0);
}

TEST(NearestName, OffersTheNearestNameOrAllNames) {
  const std::vector<std::string> names = {"duration", "frame_rate", "steps_per_frame"};
  EXPECT_EQ(name_advice("duraton", names), "did you mean `duration`?");
  EXPECT_EQ(name_advice("x", names), "use one of `duration`, `frame_rate`, `steps_per_frame`");
  EXPECT_EQ(nearest_name("a", {}), std::nullopt);
}

TEST(TomlValue, KeepsTheOrderAndPlacesOfTheFile) {
  const TomlValue root = parse_toml("z = 1\na = [1.5, 'x']\n\n[t]\n  k = true\n", "f.toml");
  ASSERT_EQ(root.keys, (std::vector<std::string>{"z", "a", "t"}));
  EXPECT_EQ(root.items[1].place.line, 2);
  EXPECT_EQ(root.items[1].place.column, 5);
  EXPECT_EQ(root.find("a")->items[0].real, 1.5);
  EXPECT_EQ(root.find("t")->find("k")->key_place.line, 5);
  EXPECT_EQ(root.find("t")->find("k")->key_place.column, 3);
  EXPECT_EQ(root.find("missing"), nullptr);
}

TEST(TomlValue, NamesThePlaceOfASyntaxError) {
  EXPECT_THAT(message([] { parse_toml("a = 1\nb = = 2\n", "f.toml"); }), HasSubstr("f.toml:2:"));
}

TEST(TomlValue, NumbersTooLargeForADoubleAreRefused) {
  EXPECT_THAT(message([] { parse_toml("f = 1e400\n", "f.toml"); }), HasSubstr("f.toml:1:"));
}

TEST(TomlValue, RefusesKeysAndNestingThatOverflowTheStack) {
  std::string key = "a";
  for (int i = 0; i < 200'000; ++i) key += ".a";
  EXPECT_THAT(message([&] { parse_toml("x = 1\n" + key + " = 1\n", "f.toml"); }), HasSubstr("f.toml:2"));
  EXPECT_NE(message([] { parse_toml("x = " + std::string(100'000, '['), "f.toml"); }), "no error");
}

TEST(TomlValue, DotsInTextsAndCommentsAreNotKeys) {
  const std::string dots(1000, '.');
  EXPECT_EQ(message([&] {
              parse_toml("a = \"" + dots + "\\\"" + dots + "\" # " + dots + "\nb = '" + dots +
                             "'\nc = \"\"\"\n" + dots + "\n\"\"\"\nd = [0.1, 0.2]\n",
                         "f.toml");
            }),
            "no error");
}

TEST(TomlTable, UnknownKeysNameTheNearestKnownKeyAtTheirPlace) {
  const TomlValue root = parse_toml("duraton = 2\n", "f.toml");
  EXPECT_EQ(message([&] { TomlTable(root, "[time]", {"duration", "frame_rate"}); }),
            "f.toml:1:1: unknown key `duraton` in [time]; did you mean `duration`?");
}

TEST(TomlTable, NumbersAreCheckedForTypeRangeAndFiniteness) {
  const TomlValue root = parse_toml("a = -2\nb = 'x'\nc = nan\nd = inf\ne = 3\n", "f.toml");
  const TomlTable table(root, "[time]", root.keys);
  EXPECT_EQ(message([&] { table.number("a", "s", Range::positive()); }),
            "f.toml:1:5: `a` of [time] is -2; give a number greater than 0 [s]");
  EXPECT_THAT(message([&] { table.number("b", "s", Range::any()); }), HasSubstr("is \"x\"; give a number"));
  EXPECT_THAT(message([&] { table.number("c", "s", Range::any()); }), HasSubstr("is nan"));
  EXPECT_THAT(message([&] { table.number("d", "s", Range::positive()); }), HasSubstr("is inf"));
  EXPECT_EQ(table.number("e", "s", Range::positive()), 3);
  EXPECT_EQ(table.number("missing", "s", Range::positive(), 7), 7);
  EXPECT_THAT(message([&] { table.number("missing", "s", Range::positive()); }),
              HasSubstr("[time] has no `missing`; add `missing = …`"));
}

TEST(TomlTable, VectorsHaveThreeFiniteNumbers) {
  const TomlValue root = parse_toml("a = [1, 2]\nb = [1, 2.5, 3]\nc = [1, nan, 3]\n", "f.toml");
  const TomlTable table(root, "t", root.keys);
  EXPECT_THAT(message([&] { table.vector("a", "m"); }), HasSubstr("a list of 2; give a list of three"));
  EXPECT_EQ(table.vector("b", "m"), Vec3(1, 2.5, 3));
  EXPECT_THAT(message([&] { table.vector("c", "m"); }), HasSubstr("f.toml:3:9: y of `c` of t is nan"));
}

TEST(TomlTable, ChoicesAndIntegersAreChecked) {
  const TomlValue root = parse_toml("a = 'two'\nb = 'tow'\nc = 2.5\nd = 5\n", "f.toml");
  const TomlTable table(root, "t", root.keys);
  EXPECT_EQ(table.choice("a", {"one", "two"}, 0), 1u);
  EXPECT_EQ(table.choice("missing", {"one", "two"}, 0), 0u);
  EXPECT_THAT(message([&] { table.choice("b", {"one", "two"}, 0); }), HasSubstr("did you mean `two`?"));
  EXPECT_THAT(message([&] { table.integer("c", 1, 9, 1); }), HasSubstr("whole number from 1 to 9"));
  EXPECT_THAT(message([&] { table.integer("d", 1, 4, 1); }), HasSubstr("whole number from 1 to 4"));
}

}  // namespace
}  // namespace muslin
