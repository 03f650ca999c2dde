// A declared table reads, checks, writes and publishes its keys.
#include "muslin/schema/table.hpp"

#include <limits>
#include <optional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "muslin/schema/declare.hpp"
#include "muslin/schema/publish.hpp"

namespace muslin::schema {
namespace {

using testing::HasSubstr;

struct Frame {
  double time = 0;
  Vec3 value = Vec3::Zero();
};
enum class Drive { motor, spring };
struct Wheel {
  std::string name;
  Place place;
  double radius = 0.5;
  std::optional<double> width;
  Drive drive = Drive::motor;
  double power = 2;      // of a motor
  double stiffness = 0;  // of a spring
  bool brake = true;
  Vec3 axis = Vec3::UnitX();
  std::vector<Frame> frames;
};
struct Cart {
  std::string title;
  std::vector<Wheel> wheels;
};

const Table& frame_table() {
  static const Table table = table_of<Frame>("frames", {number("time", &Frame::time).unit("s").required(),
                                                        vector("value", &Frame::value).required()});
  return table;
}
const Table& motor_table() {
  static const Table table = table_of<Wheel>(
      "motor",
      {number("power", &Wheel::power).unit("W").range(Range::non_negative()).may_change_on_resume()});
  return table;
}
const Table& spring_table() {
  static const Table table = table_of<Wheel>(
      "spring", {number("stiffness", &Wheel::stiffness).unit("N/m").range({0, 1e9, true}).required()});
  return table;
}
const Table& wheel_table() {
  static const Table table = [] {
    Table wheel = table_of<Wheel>(
        "[[wheel]]",
        {text("name", &Wheel::name).otherwise("`wheel0`"),
         number("radius", &Wheel::radius).unit("m").range({0.1, 10, false}).means("of the tread"),
         number("width", &Wheel::width).unit("m").range(Range::positive()).needs("radius", "give both"),
         word("drive", &Wheel::drive, {"motor", "spring"}).means("what turns it"),
         truth("brake", &Wheel::brake).excludes("frames", "`brake` stands beside `frames`"),
         direction("axis", &Wheel::axis, "[1, 0, 0]"), keyframes("frames", &Wheel::frames, frame_table)});
    choose(wheel, "drive", &Wheel::drive, {{"motor", "", motor_table}, {"spring", "", spring_table}});
    add_rule<Wheel>(wheel, [](const Wheel& w, const Subject& subject) {
      if (w.width && *w.width > w.radius) throw subject.error("width", "it is a roller", "make it narrower");
    });
    return wheel;
  }();
  return table;
}
const Table& cart_table() {
  static const Table table = table_of<Cart>(
      "the top of the file", {text("title", &Cart::title).may_change_on_resume(),
                              sections("wheel", &Cart::wheels, wheel_table,
                                       [](const TomlTable&, std::size_t index, Wheel& wheel, Cart&) {
                                         if (wheel.name.empty()) wheel.name = fmt::format("wheel{}", index);
                                       })});
  return table;
}

Cart read(const std::string& toml) {
  const TomlValue root = parse_toml(toml, "cart.toml");
  const TomlTable top = cart_table().open(root, "the cart");
  Cart cart;
  cart_table().read(top, cart);
  return cart;
}
std::string message(const std::string& toml) {
  try {
    read(toml);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}
std::string complaint(const Cart& cart) {
  try {
    cart_table().check(cart, Subject("the cart", {}));
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Schema, ReadsKeysOfTheTableAndOfItsVariant) {
  const Cart cart = read(
      "title = 'c'\n[[wheel]]\nradius = 2\nwidth = 1\ndrive = 'spring'\nstiffness = 3\naxis = [0, 2, 0]\n"
      "frames = [{ time = 0, value = [1, 0, 0] }, { time = 1, value = [2, 0, 0] }]\n[[wheel]]\n");
  ASSERT_EQ(cart.wheels.size(), 2u);
  const Wheel& wheel = cart.wheels.front();
  EXPECT_EQ(wheel.name, "wheel0");
  EXPECT_EQ(wheel.place.line, 2);
  EXPECT_EQ(wheel.width, 1);
  EXPECT_EQ(wheel.drive, Drive::spring);
  EXPECT_EQ(wheel.stiffness, 3);
  EXPECT_EQ(wheel.axis, Vec3::UnitY());
  EXPECT_EQ(wheel.frames.back().value, Vec3(2, 0, 0));
  EXPECT_EQ(cart.wheels.back().power, 2) << "default";
}

TEST(Schema, MistakesInAFileAreErrorsAtTheirPlace) {
  EXPECT_EQ(message("[[wheel]]\nradius = 20\n"),
            "cart.toml:2:10: `radius` of [[wheel]] 0 of drive motor is 20; give a number from 0.1 to 10 [m]");
  EXPECT_THAT(message("[[wheel]]\nradus = 2\n"), HasSubstr("did you mean `radius`?"));
  EXPECT_THAT(message("[[wheel]]\nstiffness = 2\n"), HasSubstr("unknown key `stiffness`"));
  EXPECT_THAT(message("[[wheel]]\ndrive = 'spring'\n"), HasSubstr("has no `stiffness`; add `stiffness = …`"));
  EXPECT_THAT(message("[[wheel]]\ndrive = 'sprin'\n"), HasSubstr("did you mean `spring`?"));
  EXPECT_THAT(message("[[wheel]]\nwidth = 1\n"), HasSubstr("`width` needs `radius`; give both"));
  EXPECT_THAT(message("[[wheel]]\nradius = 1\nwidth = 2\n"), HasSubstr("cart.toml:3:9: it is a roller"));
  EXPECT_THAT(message("[[wheel]]\nbrake = true\nframes = [{ time = 0, value = [0, 0, 0] }]\n"),
              HasSubstr("`brake` stands beside `frames`; keep one of them"));
  EXPECT_THAT(
      message("[[wheel]]\nframes = [{ time = 1, value = [0, 0, 0] }, { time = 1, value = [0, 0, 0] }]\n"),
      HasSubstr("does not come after"));
  EXPECT_THAT(message("[wheel]\n"), HasSubstr("write [[wheel]] in two brackets"));
}

TEST(Schema, MistakesOfAProgramAreErrorsThatNameTheTable) {
  Cart cart = read("[[wheel]]\nradius = 2\n");
  EXPECT_EQ(complaint(cart), "no error");
  const auto with = [&](const auto& change) {
    Cart wrong = cart;
    change(wrong.wheels.front());
    return complaint(wrong);
  };
  EXPECT_THAT(with([](Wheel& w) { w.radius = std::numeric_limits<double>::quiet_NaN(); }),
              HasSubstr("[[wheel]] `wheel0`: `radius` is nan; give a number from 0.1 to 10 [m]"));
  EXPECT_THAT(with([](Wheel& w) { w.power = -1; }), HasSubstr("`power` is -1"));
  EXPECT_EQ(with([](Wheel& w) { w.stiffness = -1; }), "no error") << "of the other variant";
  EXPECT_THAT(with([](Wheel& w) { w.width = 3; }), HasSubstr("it is a roller"));
  EXPECT_THAT(with([](Wheel& w) { w.frames.resize(2); }), HasSubstr("keyframe 1 is at 0 s"));
}

TEST(Schema, WritesEveryValueWithItsDefault) {
  const auto json = nlohmann::json::parse(to_json(cart_table().write(read("[[wheel]]\nradius = 2\n"))));
  EXPECT_EQ(json, nlohmann::json::parse(R"({"title": "", "wheel": [{"name": "wheel0", "radius": 2.0,
      "drive": "motor", "power": 2.0, "brake": true, "axis": [1.0, 0.0, 0.0], "frames": []}]})"));
}

TEST(Schema, StatesWhichKeysMayChangeOnResume) {
  EXPECT_TRUE(may_change_on_resume(cart_table(), "title"));
  EXPECT_TRUE(may_change_on_resume(cart_table(), "wheel.0.power"));
  EXPECT_FALSE(may_change_on_resume(cart_table(), "wheel.0.radius"));
  EXPECT_FALSE(may_change_on_resume(cart_table(), "wheel.1"));
  EXPECT_FALSE(may_change_on_resume(cart_table(), "wheel.0.gone"));
}

TEST(Schema, JsonSchemaHasAnObjectForEachVariant) {
  const auto json = nlohmann::json::parse(json_schema(cart_table(), "cart"));
  EXPECT_EQ(json["properties"]["wheel"]["items"]["$ref"], "#/$defs/wheel");
  const auto& variants = json["$defs"]["wheel"]["oneOf"];
  ASSERT_EQ(variants.size(), 2u);
  EXPECT_EQ(variants[0]["properties"]["drive"]["enum"], nlohmann::json::array({"motor"}));
  EXPECT_FALSE(variants[0].contains("required")) << "the default variant";
  EXPECT_EQ(variants[1]["required"], nlohmann::json::array({"drive", "stiffness"}));
  EXPECT_EQ(variants[1]["properties"]["stiffness"]["exclusiveMinimum"], 0);
  EXPECT_FALSE(variants[1]["properties"].contains("power"));
  EXPECT_EQ(variants[0]["additionalProperties"], false);
  EXPECT_EQ(variants[0]["dependentRequired"]["width"], nlohmann::json::array({"radius"}));
  const auto& radius = variants[0]["properties"]["radius"];
  EXPECT_EQ(radius["description"], "of the tread [m]");
  EXPECT_EQ(radius["default"], 0.5);
  EXPECT_EQ(radius["maximum"], 10);
}

TEST(Schema, GuideHasATableForEachTable) {
  const std::string page = markdown(cart_table());
  EXPECT_THAT(page,
              HasSubstr("<!-- schema: wheel -->\n| key | unit | range | drive | default | meaning |\n"));
  EXPECT_THAT(page, HasSubstr("| `radius` | m | 0.1 to 10 | all | 0.5 | of the tread |\n"));
  EXPECT_THAT(page, HasSubstr("| `power` ↻ | W | ≥ 0 | motor | 2 |"));
  EXPECT_THAT(page, HasSubstr("| `stiffness` | N/m | > 0 | spring | must be given |"));
}

TEST(Schema, PythonHasATypeForEachVariant) {
  const std::string module = python_types(cart_table());
  EXPECT_THAT(module, HasSubstr("\"stiffness\": Required[float],"));
  EXPECT_THAT(module, HasSubstr("\"drive\": Required[Literal[\"spring\"]],"));
  EXPECT_THAT(module, HasSubstr("Wheel = Union[MotorWheel, SpringWheel]\n"));
}

}  // namespace
}  // namespace muslin::schema
