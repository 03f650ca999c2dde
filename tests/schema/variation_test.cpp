// A number may vary by a map or by keyframes.
#include "muslin/schema/variation.hpp"

#include <optional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/schema/declare.hpp"
#include "muslin/schema/publish.hpp"

namespace muslin::schema {
namespace {

using testing::HasSubstr;

struct Tyre {
  std::optional<double> grip;
  double load = 1, radius = 1;
  Variations variations;
};

const Table& tyre_table() {
  static const Table table = table_of<Tyre>(
      "[tyre]", {number("grip", &Tyre::grip)
                     .unit("N")
                     .range({0, 9, false})
                     .varies(&Tyre::variations, {.map = true})
                     .means("how it holds"),
                 number("load", &Tyre::load).range({0, 1e9, true}).varies(&Tyre::variations, {true, true}),
                 number("radius", &Tyre::radius).steady("a tyre keeps its size")});
  return table;
}

Tyre read(const std::string& toml) {
  const TomlValue root = parse_toml(toml, "tyre.toml");
  Tyre tyre;
  tyre_table().read(tyre_table().open(root, "[tyre]"), tyre);
  return tyre;
}
std::string message(const std::string& toml) {
  try {
    read(toml);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Variation, IsAMapBetweenTwoValuesOrKeyframes) {
  const Tyre tyre = read(
      "grip = { map = 'worn', from = 1, to = 4, highest = 2, curve = [[0, 1], [1, 0]] }\n"
      "load = { keyframes = [{ time = 1, value = 2 }, { time = 3, value = 6, interpolation = 'smooth' }, "
      "{ time = 5, value = 8, interpolation = 'step' }, { time = 6, value = 9 }] }\n");
  EXPECT_EQ(tyre.grip, 2.5) << "nominal";
  EXPECT_EQ(tyre.load, 2) << "nominal";
  const Variation& grip = *find_variation(tyre.variations, "grip");
  EXPECT_EQ(grip.map, "worn");
  EXPECT_EQ(grip.highest, 2);
  EXPECT_EQ(grip.at_weight(0), 4);
  EXPECT_EQ(grip.at_weight(0.25), 3.25);
  EXPECT_EQ(grip.at_weight(1), 1);
  const auto& keyframes = find_variation(tyre.variations, "load")->keyframes;
  EXPECT_EQ(value_at(keyframes, 0), 2);
  EXPECT_EQ(value_at(keyframes, 2), 4);
  EXPECT_EQ(value_at(keyframes, 3.5), 6 + 2 * 0.15625);
  EXPECT_EQ(value_at(keyframes, 5.9), 8);
  EXPECT_EQ(value_at(keyframes, 7), 9);

  const TomlValue written = tyre_table().write(tyre);
  std::string lines;
  for (std::size_t i = 0; i < written.keys.size(); ++i)
    lines += written.keys[i] + " = " + to_toml(written.items[i]) + "\n";
  EXPECT_EQ(to_json(tyre_table().write(read(lines))), to_json(written)) << "the resolved form reads back";
}

TEST(Variation, OfOneValueIsThatValue) {
  const Tyre tyre = read("grip = { map = 'worn', from = 0.1, to = 0.1 }\n");
  EXPECT_EQ(tyre.grip, 0.1);
  for (const double weight : {0.0, 0.3, 1.0}) EXPECT_EQ(tyre.variations.front().at_weight(weight), 0.1);
}

TEST(Variation, ANumberThatFollowsTakesItsPlace) {
  Tyre tyre = read("grip = { map = 'worn', from = 1, to = 2 }\n");
  const TomlValue later = parse_toml("grip = 3\n", "later.toml");
  tyre_table().read(tyre_table().open(later, "[tyre]"), tyre);
  EXPECT_EQ(tyre.grip, 3);
  EXPECT_TRUE(tyre.variations.empty());
}

TEST(Variation, IsCheckedAtEachOfItsValues) {
  EXPECT_THAT(message("grip = { map = 'a', from = 1, to = 10 }"),
              HasSubstr("tyre.toml:1:8: `grip` is 10 at the `to` of its map; give a number from 0 to 9 [N]"));
  EXPECT_THAT(message("load = { keyframes = [{ time = 0, value = 0 }] }"),
              HasSubstr("`load` is 0 at 0 s; give a number above 0"));
  EXPECT_THAT(message("grip = { keyframes = [{ time = 0, value = 1 }] }"),
              HasSubstr("`grip` cannot vary by keyframes; give a number from 0 to 9 [N] or a map"));
  EXPECT_THAT(message("grip = { map = 'a', from = 1 }"), HasSubstr("has no `to`"));
  EXPECT_THAT(message("grip = {}"), HasSubstr("has no `map`"));
  EXPECT_THAT(message("grip = { map = 'a', from = 1, to = 2, curve = [[1, 0], [0.5, 1]] }"),
              HasSubstr("`curve` has the point [0.5, 1]"));
  EXPECT_THAT(message("grip = { map = 'a', from = 1, to = 2, lowest = 1 }"),
              HasSubstr("`highest` = 1 is not above 1"));
  EXPECT_THAT(message("load = { map = 'a', keyframes = [{ time = 0, value = 1 }], from = 1, to = 2 }"),
              HasSubstr("by a map or in time, not both"));
  EXPECT_THAT(message("radius = { map = 'a', from = 1, to = 2 }"), HasSubstr("is a table; give a number"));
  EXPECT_THAT(
      message("radius = { keyframes = [{ time = 0, value = 1 }] }"),
      HasSubstr("tyre.toml:1:10: `radius` cannot vary by keyframes: a tyre keeps its size; give a number"));

  Tyre tyre = read("grip = { map = 'a', from = 1, to = 2 }");
  tyre.variations.front().from = -1;
  try {
    tyre_table().check(tyre, Subject("the tyre", {}));
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("the tyre: `grip` is -1 at the `from` of its map"));
  }
}

TEST(Variation, IsPublishedBesideTheNumber) {
  EXPECT_THAT(json_schema(tyre_table(), "tyres"), HasSubstr("#/$defs/a_number_that_varies"));
  EXPECT_THAT(python_types(tyre_table()), HasSubstr("Optional[Union[float, \"ANumberThatVaries\"]]"));
  EXPECT_THAT(markdown(tyre_table()), HasSubstr("| how it holds; may be [a map](maps.md) |"));
  EXPECT_THAT(markdown(tyre_table()), HasSubstr("; may be [a map](maps.md) or [keyframes](keyframes.md) |"));
}

}  // namespace
}  // namespace muslin::schema
