#include "muslin/fit/measurements.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "muslin/core/toml_table.hpp"
#include "muslin/fit/kes.hpp"
#include "muslin/fit/measured_key.hpp"
#include "muslin/fit/outline.hpp"
#include "muslin/fit/points_file.hpp"
#include "muslin/schema/declare.hpp"

namespace muslin {
namespace {

constexpr double gf_per_cm = 0.980665;  // N/m
constexpr double radian = 180 / std::numbers::pi;

constexpr Range shear_moduli{0.1, 1e6, false};  // N/m
constexpr Range rigidities{1e-8, 0.1, false};   // N·m

const std::vector<std::string> thread_words = {"warp", "weft", "bias"};

/// The keys of a test's table besides its settings: a table of points and its units.
struct PointKeys {
  std::vector<Vec2> points;
  std::string file;
};

struct Unit {
  const char* word;
  double scale;  // in SI units
};

double scale_of(const std::string& word, std::span<const Unit> units) {
  for (const Unit& unit : units)
    if (word == unit.word) return unit.scale;
  return 1;
}

std::vector<std::string> words_of(std::span<const Unit> units) {
  std::vector<std::string> words;
  for (const Unit& unit : units) words.emplace_back(unit.word);
  return words;
}

constexpr std::array<Unit, 4> tensile_forces = {{{"N/m", 1}, {"N/cm", 100}, {"gf/cm", gf_per_cm}, {"N", 1}}};
constexpr std::array<Unit, 3> strains = {{{"1", 1}, {"%", 0.01}, {"mm", 0.001}}};
constexpr std::array<Unit, 3> shear_forces = {{{"N/m", 1}, {"N/cm", 100}, {"gf/cm", gf_per_cm}}};
constexpr std::array<Unit, 2> angles = {{{"degrees", 1}, {"radians", radian}}};
constexpr std::array<Unit, 2> moments = {{{"N", 1}, {"gf cm/cm", gf_per_cm / 100}}};
constexpr std::array<Unit, 2> curvatures = {{{"1/m", 1}, {"1/cm", 100}}};

/// A test's settings as its table states them.
template <class Test>
struct Stated : Test {
  PointKeys curve;
  std::string x_unit, y_unit;
  std::optional<double> plus_minus;
};

/// The keys of a test with points: a table or a file, the units of both numbers, a common uncertainty.
template <class Test>
void add_point_keys(schema::Table& table, const char* x, const char* y, std::span<const Unit> x_units,
                    std::span<const Unit> y_units) {
  using S = Stated<Test>;
  table.keys.push_back(
      schema::custom<S>(
          "points", {schema::Type::curve},
          [](const schema::Key& k, const TomlTable& given, S& s) {
            for (const TomlValue& item : *given.array(k.name, "points [[x, y], …]")) {
              if (item.type != TomlValue::Type::array || item.items.size() != 2)
                throw given.error(k.name, "a point of `points` is no pair of numbers", "give [[x, y], …]");
              const Range any = Range::between(-largest_measured, largest_measured);
              s.curve.points.emplace_back(to_number(item.items[0], "a number of `points`", "", any),
                                          to_number(item.items[1], "a number of `points`", "", any));
            }
          },
          [](const schema::Key&, const S&, TomlValue&) {})
          .excludes("file", "`points` stands beside `file`, in whose place it is")
          .means(fmt::format("`[[{}, {}], …]`, the first ascending", x, y)));
  table.keys.push_back(schema::custom<S>(
                           "file", {schema::Type::path},
                           [](const schema::Key& k, const TomlTable& given, S& s) {
                             s.curve.file = given.string(k.name);
                             schema::require_path(s.curve.file, k, given);
                           },
                           [](const schema::Key&, const S&, TomlValue&) {})
                           .means("in place of `points`: a text file with two columns"));
  table.keys.push_back(schema::word(fmt::format("{}_unit", x), &S::x_unit, words_of(x_units))
                           .otherwise(fmt::format("`\"{}\"`", x_units[0].word))
                           .means("unit of the first numbers"));
  table.keys.push_back(schema::word(fmt::format("{}_unit", y), &S::y_unit, words_of(y_units))
                           .otherwise(fmt::format("`\"{}\"`", y_units[0].word))
                           .means("unit of the second numbers"));
  table.keys.push_back(schema::number("plus_minus", &S::plus_minus)
                           .range({0, 1, true})
                           .means("standard uncertainty of all forces as a share of them"));
}

/// Checks points in SI units; `largest` is that of the first numbers.
void check_points(const std::vector<Vec2>& points, const Place& place, const std::string& title,
                  double largest, const std::string& remedy_for_largest) {
  double before = -1;
  for (const Vec2& point : points) {
    const auto fail = [&](const std::string& problem, const std::string& remedy) {
      return Error(ErrorKind::input, place, fmt::format("{}: {}", title, problem), remedy);
    };
    if (point[0] < 0 || point[1] < 0)
      throw fail(fmt::format("the point ({:.4g}, {:.4g}) is negative", point[0], point[1]),
                 "subtract the offset of the tester, and begin where the cloth is slack");
    if (point[0] <= before)
      throw fail(fmt::format("{:.4g} comes after {:.4g}", point[0], before),
                 "give the loading branch only, with the first numbers ascending");
    if (point[0] > largest)
      throw fail(fmt::format("{:.4g} is beyond {:.4g}", point[0], largest), remedy_for_largest);
    before = point[0];
  }
}

/// Takes the points from where the table states them, in SI units. Returns their place.
template <class Test>
Place take_points(const TomlTable& table, Stated<Test>& s, Measurements& m, double x_scale, double y_scale) {
  Place place = table.place("points");
  if (!s.curve.file.empty()) {
    const std::filesystem::path file = m.file.parent_path() / s.curve.file;
    m.files.push_back(file);
    for (const PointRow& row : read_points(file)) s.curve.points.push_back(row.point);
    place = {file.string(), 0, 0};
  }
  for (const Vec2& point : s.curve.points) s.points.emplace_back(point[0] * x_scale, point[1] * y_scale);
  s.factor.plus_minus = s.plus_minus;
  return place;
}

/// Checks the force over `x` at the last point: outside of these ranges, of all fabrics, a unit is wrong.
void require_modulus(const std::vector<Vec2>& points, const Place& place, const std::string& title,
                     double x_scale, const Range& range, const char* unit) {
  const double x = points.empty() ? 0 : points.back()[0] * x_scale, y = points.empty() ? 0 : points.back()[1];
  if (x <= 0 || y <= 0)
    throw Error(ErrorKind::input, place, fmt::format("{} has no force at its last point", title),
                "give points up to a force");
  if (!fits(y / x, range))
    throw Error(ErrorKind::input, place,
                fmt::format("{}: the last point means {:.3g} {}, which no fabric has", title, y / x, unit),
                fmt::format("check the units of both numbers; fabrics have {:.3g} to {:.3g} {}", range.min,
                            range.max, unit));
}

const schema::Table& tensile_table() {
  using S = Stated<TensileTest>;
  static const schema::Table table = [] {
    schema::Table t = schema::table_of<S>(
        "[[tensile]]",
        {schema::text("name", &S::name).otherwise("none").means("of the specimen, in messages"),
         schema::word("direction", &S::direction, thread_words)
             .required()
             .means("in which the strip is pulled")});
    add_point_keys<TensileTest>(t, "strain", "force", strains, tensile_forces);
    t.keys.push_back(schema::number("width", &S::width)
                         .unit("m")
                         .range({1e-4, 10, false})
                         .means("of the strip; forces in N are divided by it"));
    t.keys.push_back(schema::number("length", &S::length)
                         .unit("m")
                         .range({1e-4, 10, false})
                         .means("of the strip between its clamps; elongations in mm are divided by it"));
    return t;
  }();
  return table;
}

void finish_tensile(const TomlTable& table, Stated<TensileTest>& s, Measurements& m) {
  double x = scale_of(s.x_unit, strains), y = scale_of(s.y_unit, tensile_forces);
  if (s.x_unit == "mm") {
    if (!s.length)
      throw table.error("strain_unit", "elongations in mm need the `length` of the strip", "add it");
    x /= *s.length;
  }
  if (s.y_unit == "N") {
    if (!s.width) throw table.error("force_unit", "forces in N need the `width` of the strip", "add it");
    y /= *s.width;
  }
  const Place place = take_points(table, s, m, x, y);
  check_points(s.points, place, table.title(), 2,
               "give strains, elongation over length, or strain_unit = \"%\" or \"mm\"");
  require_modulus(s.points, place, table.title(), 1, {0.5, 5e6, false}, "N/m");
}

const schema::Table& shear_table() {
  using S = Stated<ShearTest>;
  static const schema::Table table = [] {
    schema::Table t = schema::table_of<S>(
        "[[shear]]", {schema::text("name", &S::name).otherwise("none").means("of the specimen, in messages"),
                      measured("modulus", &S::modulus)
                          .unit("N/m")
                          .range(shear_moduli)
                          .excludes("points", "`modulus` stands beside `points`")
                          .excludes("file", "`modulus` stands beside `file`")
                          .means("force per length and radian at rest, in place of points")});
    add_point_keys<ShearTest>(t, "angle", "force", angles, shear_forces);
    return t;
  }();
  return table;
}

void finish_shear(const TomlTable& table, Stated<ShearTest>& s, Measurements& m) {
  const Place place = take_points(table, s, m, scale_of(s.x_unit, angles), scale_of(s.y_unit, shear_forces));
  check_points(s.points, place, table.title(), 60, "leave out angles past the locking of the threads");
  if (!s.modulus) require_modulus(s.points, place, table.title(), 1 / radian, shear_moduli, "N/m");
}

const schema::Table& bending_table() {
  using S = Stated<BendingTest>;
  static const schema::Table table = [] {
    schema::Table t = schema::table_of<S>(
        "[[bending]]",
        {schema::text("name", &S::name).otherwise("none").means("of the specimen, in messages"),
         schema::word("direction", &S::direction, thread_words).required().means("of the threads that bend"),
         measured("bending_length", &S::bending_length)
             .unit("m")
             .range({0.002, 0.3, false})
             .means("of a cantilever (BS 3361, ASTM D1388, ISO 9073-7): half the overhang that reaches the "
                    "slope "
                    "of 41.5°"),
         measured("loop_height", &S::loop_height)
             .unit("m")
             .range({0.002, 1, false})
             .needs("loop_length", "add the length of the strip that makes the loop")
             .means("of a hanging loop: from the grip to the lowest point"),
         schema::number("loop_length", &S::loop_length)
             .unit("m")
             .range({0.01, 2, false})
             .needs("loop_height", "add the height of the loop")
             .means("of the strip that makes the loop"),
         schema::word("loop", &S::loop, {"heart", "ring", "pear"})
             .means("the ends of the strip in the grip point up, to each other, or down"),
         measured("rigidity", &S::rigidity)
             .unit("N·m")
             .range(rigidities)
             .means("moment per width and curvature")});
    add_point_keys<BendingTest>(t, "curvature", "moment", curvatures, moments);
    return t;
  }();
  return table;
}

void finish_bending(const TomlTable& table, Stated<BendingTest>& s, Measurements& m) {
  const Place place = take_points(table, s, m, scale_of(s.x_unit, curvatures), scale_of(s.y_unit, moments));
  check_points(s.points, place, table.title(), 1e4, "check `curvature_unit`");
  const int given = (s.bending_length ? 1 : 0) + (s.loop_height ? 1 : 0) + (s.rigidity ? 1 : 0) +
                    (s.points.empty() ? 0 : 1);
  if (given != 1)
    throw Error(
        ErrorKind::input, table.place(), fmt::format("{} states {} results", table.title(), given),
        "give one of `bending_length`, `loop_height`, `rigidity`, `points`, `file`, and a [[bending]] for "
        "each");
  if (s.points.empty()) return;
  require_modulus(s.points, place, table.title(), 1, rigidities, "N·m");
  if (s.direction == Thread::bias)
    throw Error(ErrorKind::input, place, "a material has no curve of moments along the bias",
                "give `rigidity`, the slope at rest");
}

/// A drape as its table states it.
struct StatedDrape : DrapeTest {
  std::vector<std::string> outlines;
  double outline_unit = 1;
};

const schema::Table& drape_table() {
  using S = StatedDrape;
  static const schema::Table table = schema::table_of<S>(
      "[drape]",
      {measured("coefficient", &S::coefficient, 0.01)
           .unit("%")
           .range({0, 100, true})
           .excludes("outlines", "`coefficient` stands beside `outlines`")
           .means("share of the overhanging ring that lies in shadow (BS 5058, ISO 9073-9); a list of drops "
                  "gives "
                  "its uncertainty"),
       schema::custom<S>(
           "outlines", {schema::Type::path},
           [](const schema::Key& k, const TomlTable& given, S& s) {
             for (const TomlValue& item : *given.array(k.name, "names of files")) {
               if (item.type != TomlValue::Type::string)
                 throw given.error(k.name, "`outlines` has an item that is not a text", "name files");
               s.outlines.push_back(item.string);
             }
           },
           [](const schema::Key&, const S&, TomlValue&) {})
           .means("a list of text files, one for each drop: the points of the shadow's outline, in order"),
       schema::number("outline_unit", &S::outline_unit)
           .unit("m")
           .range({1e-6, 1, false})
           .needs("outlines", "take it out")
           .means("length of 1 in `outlines`, such as that of a pixel"),
       schema::number("specimen_diameter", &S::specimen_diameter)
           .unit("m")
           .range({0.05, 2, false})
           .means("of the cloth"),
       schema::number("support_diameter", &S::support_diameter)
           .unit("m")
           .range({0.02, 2, false})
           .means("of the disc that holds it")});
  return table;
}

DrapeTest finish_drape(const TomlTable& table, const StatedDrape& s, Measurements& m) {
  DrapeTest drape = s;
  drape.place = table.place();
  if (s.support_diameter >= 0.95 * s.specimen_diameter)
    throw table.error("support_diameter", "the support is as large as the specimen",
                      "exchange the diameters");
  if (s.coefficient) return drape;
  if (s.outlines.empty())
    throw Error(ErrorKind::input, table.place(), "[drape] has no `coefficient`", "add it, or `outlines`");
  double sum = 0, squares = 0;
  for (const std::string& name : s.outlines) {
    const std::filesystem::path file = m.file.parent_path() / name;
    m.files.push_back(file);
    const double share = outline_coefficient(file, s.outline_unit, s);
    sum += share;
    squares += share * share;
  }
  const double n = static_cast<double>(s.outlines.size()), mean = sum / n;
  drape.coefficient = Measured{mean, std::nullopt};
  if (s.outlines.size() > 1)
    drape.coefficient->plus_minus = std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1));
  return drape;
}

const schema::Table& kes_side_table() {
  using S = KesSide;
  constexpr double deg = radian;  // per radian
  static const schema::Table table = schema::table_of<S>(
      "`warp`, `weft` of [kes]",
      {measured("LT", &S::linearity)
           .range(kes_linearities)
           .means("linearity of tension, 2 WT/(500 gf/cm · EMT)"),
       measured("WT", &S::tensile_energy, gf_per_cm)
           .unit("gf·cm/cm²")
           .range({0.01, 500, false})
           .means("tensile energy up to 500 gf/cm"),
       measured("RT", &S::resilience, 0.01)
           .unit("%")
           .range({0, 100, false})
           .means("tensile resilience, not used"),
       measured("EMT", &S::extension, 0.01).unit("%").range({0.05, 200, false}).means("strain at 500 gf/cm"),
       measured("G", &S::shear, gf_per_cm * deg)
           .unit("gf/(cm·deg)")
           .range({0.01, 50, false})
           .means("slope of shear, 0.5° to 2.5°"),
       measured("2HG", &S::shear_hysteresis, gf_per_cm)
           .unit("gf/cm")
           .range({0, 100, false})
           .means("hysteresis of shear at 0.5°, not used"),
       measured("2HG5", &S::shear_hysteresis_5, gf_per_cm)
           .unit("gf/cm")
           .range({0, 100, false})
           .means("hysteresis of shear at 5°, not used"),
       measured("B", &S::bending, gf_per_cm * 1e-4)
           .unit("gf·cm²/cm")
           .range({1e-4, 100, false})
           .means("slope of bending, 0.5/cm to 1.5/cm"),
       measured("2HB", &S::bending_hysteresis, gf_per_cm / 100)
           .unit("gf·cm/cm")
           .range({0, 100, false})
           .means("hysteresis of bending at 1/cm, not used")});
  return table;
}

const schema::Table& kes_table() {
  using S = KesSheet;
  static const schema::Table table = schema::table_of<S>(
      "[kes]",
      {measured("W", &S::weight, 0.01).unit("mg/cm²").range({0.5, 300, false}).means("mass per area"),
       measured("T", &S::thickness, 0.001)
           .unit("mm")
           .range({0.01, 50, false})
           .means("thickness at 0.5 gf/cm²"),
       schema::nested("warp", &S::warp, kes_side_table).means("results along warp"),
       schema::nested("weft", &S::weft, kes_side_table).means("results along weft")});
  return table;
}

/// A list of tests, whose points are taken when a table has been read.
template <class Test, class Finish>
schema::Declaration tests(const char* name, std::vector<Test> Measurements::* member,
                          const schema::Table& (*keys)(), Finish finish) {
  schema::Key key = schema::custom<Measurements>(
      name, {schema::Type::tables},
      [=](const schema::Key& k, const TomlTable& top, Measurements& m) {
        for (const TomlValue& value : schema::section_values(k.name, top)) {
          const std::size_t index = (m.*member).size();
          const TomlTable table = keys().open(value, schema::section_title(k.name, value, index));
          Stated<Test> stated;
          keys().read(table, stated);
          finish(table, stated, m);
          stated.place = table.place();
          (m.*member).push_back(std::move(stated));
        }
      },
      [](const schema::Key&, const Measurements&, TomlValue&) {});
  key.table = keys;
  return schema::Declaration(std::move(key));
}

schema::Table declared_measurements() {
  using S = Measurements;
  schema::Table table = schema::table_of<S>(
      "measurements",
      {schema::text("name", &S::name).otherwise("the file's name").means("of the material"),
       schema::text("description", &S::description).otherwise("none").means("of the material, in a sentence"),
       schema::text("source", &S::source).otherwise("none").means("who measured what"),
       measured("areal_density", &S::areal_density)
           .unit("kg/m²")
           .range({0.003, 5, false})
           .required_without({"kes"})
           .means("mass per area"),
       measured("thickness", &S::thickness).unit("m").range({1e-5, 0.05, false}).means("for information"),
       measured("poisson", &S::poisson)
           .range({0, 0.99, false})
           .means("contraction over strain of a strip at small strains, geometric mean of warp and weft"),
       tests("tensile", &S::tensile, tensile_table, finish_tensile).means("a strip test of a specimen"),
       tests("shear", &S::shear, shear_table, finish_shear).means("a shear test of a specimen"),
       tests("bending", &S::bending, bending_table, finish_bending).means("a bending test of a specimen"),
       schema::custom<S>(
           "kes", {schema::Type::table},
           [](const schema::Key& k, const TomlTable& top, S& m) {
             const TomlTable given = kes_table().open(*top.find(k.name), "[kes]");
             kes_table().read(given, m.kes.emplace());
             for (const auto& [side, name] :
                  {std::pair{&m.kes->warp, "warp"}, std::pair{&m.kes->weft, "weft"}}) {
               if (!*side) continue;
               (*side)->place = given.place(name);
               check_kes_tension(**side, name);
             }
           },
           [](const schema::Key&, const S&, TomlValue&) {})
           .means("a sheet of the Kawabata Evaluation System, in its units"),
       schema::custom<S>(
           "drape", {schema::Type::table},
           [](const schema::Key& k, const TomlTable& top, S& m) {
             const TomlTable given = drape_table().open(*top.find(k.name), "[drape]");
             StatedDrape stated;
             drape_table().read(given, stated);
             m.drape = finish_drape(given, stated, m);
           },
           [](const schema::Key&, const S&, TomlValue&) {})
           .means("Cusick's drape test")});
  for (schema::Key& key : table.keys) {
    if (key.name == "kes") key.table = kes_table;
    if (key.name == "drape") key.table = drape_table;
  }
  return table;
}

}  // namespace

const schema::Table& measurements_table() {
  static const schema::Table table = declared_measurements();
  return table;
}

Measurements read_measurements(const std::filesystem::path& file) {
  return parse_measurements(read_text(file), file);
}

Measurements parse_measurements(std::string_view text, const std::filesystem::path& file) {
  const TomlValue root = parse_toml(text, file.string());
  const TomlTable top = measurements_table().open(root, "the file of measurements");
  Measurements m;
  m.file = file;
  m.files = {file};
  m.name = file.stem().string();
  measurements_table().read(top, m);
  if (!m.areal_density && m.kes) m.areal_density = m.kes->weight;
  if (!m.thickness && m.kes) m.thickness = m.kes->thickness;
  if (!m.areal_density)
    throw Error(ErrorKind::input, top.place("kes"), "neither `areal_density` nor `W` of [kes] is given",
                "add areal_density = … [kg/m²]");
  return m;
}

void for_each_measured(Measurements& m, const std::function<void(Measured&)>& visit) {
  const auto number = [&](std::optional<Measured>& x) {
    if (x) visit(*x);
  };
  number(m.areal_density);
  number(m.poisson);
  for (TensileTest& test : m.tensile) visit(test.factor);
  for (ShearTest& test : m.shear) {
    if (!test.points.empty()) visit(test.factor);
    number(test.modulus);
  }
  for (BendingTest& test : m.bending) {
    if (!test.points.empty()) visit(test.factor);
    number(test.bending_length);
    number(test.loop_height);
    number(test.rigidity);
  }
  if (!m.kes) return;
  for (std::optional<KesSide>* side : {&m.kes->warp, &m.kes->weft}) {
    if (!*side) continue;
    number((*side)->linearity);
    number((*side)->tensile_energy);
    number((*side)->extension);
    number((*side)->shear);
    number((*side)->bending);
  }
}

}  // namespace muslin
