#include "muslin/scene/field_force.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "muslin/core/nearest_name.hpp"
#include "muslin/force/curve_pattern.hpp"
#include "muslin/force/drag_field.hpp"
#include "muslin/force/field_force.hpp"
#include "muslin/force/grid_pattern.hpp"
#include "muslin/force/simple_patterns.hpp"
#include "muslin/force/turbulence.hpp"
#include "muslin/scene/common_keys.hpp"
#include "muslin/scene/extent_table.hpp"
#include "muslin/scene/field_force_settings.hpp"
#include "muslin/scene/points_key.hpp"

namespace muslin {
namespace {

using schema::Key;
using schema::Subject;
using Own = FieldForceSettings;

constexpr std::size_t most_points = 1000;  // every vertex looks for the nearest in every step

using Pattern = std::shared_ptr<const FieldPattern>;
struct PatternRow {
  const char* type;
  Pattern (*make)(const Scene& scene, const Own& own);
};

Pattern read_grid(const Scene& scene, const Own& own) {
  try {
    return std::make_shared<GridPattern>(read_vector_grid(resolve_path(scene, own.file)), own.origin,
                                         own.spacing);
  } catch (const Error& error) {
    throw Error(error.kind(), own.file_place, fmt::format("{}: {}", error.place().file, error.problem()),
                error.remedy());
  }
}

const PatternRow pattern_rows[] = {
    {"uniform",
     [](const Scene&, const Own& own) -> Pattern { return std::make_shared<UniformPattern>(own.direction); }},
    {"radial", [](const Scene&, const Own&) -> Pattern { return std::make_shared<RadialPattern>(); }},
    {"vortex",
     [](const Scene&, const Own& own) -> Pattern {
       return std::make_shared<VortexPattern>(own.axis, own.radius);
     }},
    {"turbulence",
     [](const Scene&, const Own& own) -> Pattern {
       Turbulence::Settings settings;
       settings.largest = own.largest;
       settings.smallest = own.smallest.value_or(own.largest / 8);
       settings.turnover = own.turnover.value_or(settings.turnover);
       settings.seed = static_cast<std::uint64_t>(own.seed);
       return std::make_shared<Turbulence>(settings);
     }},
    {"grid", read_grid},
    {"curve",
     [](const Scene&, const Own& own) -> Pattern {
       return std::make_shared<CurvePattern>(CurvePattern::Settings{own.points, own.attraction, own.reach});
     }},
};

/// Null for forces that are no field of vectors.
const PatternRow* row_of(const ForceSettings& force) {
  const auto row = std::find_if(std::begin(pattern_rows), std::end(pattern_rows),
                                [&](const PatternRow& each) { return each.type == force.type; });
  return row == std::end(pattern_rows) ? nullptr : row;
}

bool moves_air(const ForceSettings& force) {
  return row_of(force) != nullptr && force.own.as<Own>().acts_as == Own::ActsAs::wind;
}

FieldExtent extent_of(const ForceSettings& force) {
  const Own& own = force.own.as<Own>();
  FieldExtent extent;
  extent.strength = own.strength;
  extent.window = {force.from, force.until};
  extent.center = own.center;
  extent.travel = own.travel;
  if (own.falloff) {
    extent.falloff = *own.falloff;
  } else if (force.type == "vortex") {
    extent.falloff.power = 2;
    extent.falloff.min = own.radius;
  }
  extent.region = own.region;
  return extent;
}

/// The wind to which a field adds.
const ForceSettings& wind_of(const Scene& scene, const ForceSettings& field) {
  const std::string& wanted = field.own.as<Own>().wind;
  std::vector<std::string> names;
  const ForceSettings* found = nullptr;
  for (const ForceSettings& force : scene.forces) {
    if (force.type != "wind") continue;
    names.push_back(force.name);
    if (wanted.empty() || force.name == wanted) found = &force;
  }
  const auto fail = [&](const std::string& problem, const std::string& remedy) -> Error {
    return {ErrorKind::input, field.place, fmt::format("[[force]] `{}`: {}", field.name, problem), remedy};
  };
  if (names.empty())
    throw fail("it acts as wind, but the scene has no wind",
               "add a [[force]] of type \"wind\" with `velocity = [0, 0, 0]`, or set `acts_as = "
               "\"acceleration\"`");
  if (wanted.empty() && names.size() > 1)
    throw fail(fmt::format("it does not say to which of the {} winds it adds", names.size()),
               "add `wind = …`, one of " + name_list(names));
  if (found == nullptr) throw fail(fmt::format("there is no wind `{}`", wanted), name_advice(wanted, names));
  return *found;
}

void add_vectors(Model& model, const ForceSettings& force) {
  if (moves_air(force)) {
    wind_of(model.scene, force);  // the wind takes it
    return;
  }
  model.loads.push_back(
      {force.name, EnergyRole::work,
       std::make_shared<FieldForce>(
           masses_acted_on(model, force),
           Field{extent_of(force), row_of(force)->make(model.scene, force.own.as<Own>())})});
}

void add_drag(Model& model, const ForceSettings& force) {
  const Own& own = force.own.as<Own>();
  model.loads.push_back({force.name, EnergyRole::dissipation,
                         std::make_shared<DragField>(masses_acted_on(model, force), extent_of(force),
                                                     DragField::Coefficients{own.linear, own.quadratic})});
}

std::vector<Key> extent_keys() {
  return {schema::vector("center", &Own::center)
              .unit("m")
              .means("its centre: falloff counts from there, positions of the kind are relative to it"),
          schema::vector("travel", &Own::travel)
              .unit("m/s")
              .means("velocity at which it moves, without its region: what it does at x and t is what it did "
                     "at x − t `travel` and 0"),
          schema::nested("falloff", &Own::falloff, falloff_table)
              .otherwise("none; of a vortex `{ power = 2, min = radius }`")
              .means("how it weakens with the distance from its centre, a vortex from its axis, a curve from "
                     "the curve"),
          schema::nested("region", &Own::region, region_table)
              .otherwise("everywhere")
              .means("where it acts, a table; of several shapes where all of them overlap")};
}

/// The keys of a field of vectors.
std::vector<Key> vector_keys() {
  std::vector<Key> keys = {
      schema::word("acts_as", &Own::acts_as, {"wind", "acceleration"})
          .required()
          .means("`\"wind\"`: a velocity that adds to the air of a wind and acts through its drag and lift; "
                 "`\"acceleration\"`: it accelerates all mass"),
      schema::text("wind", &Own::wind)
          .otherwise("the only one")
          .means("the name of the wind to which it adds")
          .shown_if<Own>([](const Own& own) { return !own.wind.empty(); }),
      keyed_number_key("strength", &Own::strength, {-1e6, 1e6, false})
          .unit("m/s or m/s²")
          .required()
          .means("size of the vectors before falloff, constant or `{ keyframes = [{ time = …, value = … }, "
                 "…] }`")};
  for (Key& key : extent_keys()) keys.push_back(std::move(key));
  return keys;
}

void check_wind(const Own& own, const Subject& subject) {
  if (!own.wind.empty() && own.acts_as != Own::ActsAs::wind)
    throw subject.error("wind", "an acceleration adds to no wind", "take `wind` out");
}

schema::Table field_table(const char* kind, std::vector<Key> keys, const std::vector<Key>& further,
                          void (*rule)(const Own&, const Subject&)) {
  schema::Table table =
      schema::table_of<ForceSettings>(kind, {force_body_key("every body", "the body it acts on")});
  for (Key& key : window_keys(&ForceSettings::from, &ForceSettings::until, "time when it begins to act",
                              "time when it ends, after `from`", "no end"))
    table.keys.push_back(key);
  keys.insert(keys.end(), further.begin(), further.end());
  add_own_keys<Own>(table, std::move(keys), rule);
  return table;
}

const schema::Table& uniform_keys() {
  static const schema::Table table = field_table(
      "uniform", vector_keys(),
      {schema::direction("direction", &Own::direction, "[1, 0, 0]").required().means("direction")},
      check_wind);
  return table;
}

const schema::Table& radial_keys() {
  static const schema::Table table = field_table("radial", vector_keys(), {}, check_wind);
  return table;
}

const schema::Table& vortex_keys() {
  static const schema::Table table = field_table(
      "vortex", vector_keys(),
      {schema::direction("axis", &Own::axis, "[0, 1, 0]")
           .otherwise("`[0, 1, 0]`")
           .means("its axis, through the centre; it turns counterclockwise seen against it"),
       schema::number("radius", &Own::radius)
           .unit("m")
           .range(Range::positive())
           .means("distance from the axis at which the size is `strength`: inside it grows in proportion, "
                  "outside it falls like 1/r, unless there is another `falloff`")},
      check_wind);
  return table;
}

const schema::Table& turbulence_keys() {
  static const schema::Table table = field_table(
      "turbulence", vector_keys(),
      {schema::number("largest", &Own::largest)
           .unit("m")
           .range({1e-6, 1e6, false})
           .means("size of the largest eddies"),
       schema::number("smallest", &Own::smallest)
           .unit("m")
           .range({1e-6, 1e6, false})
           .otherwise("an eighth of `largest`")
           .means("size of the smallest eddies"),
       schema::number("turnover", &Own::turnover)
           .unit("s")
           .range(Range::positive())
           .otherwise("frozen")
           .means("time in which the largest eddies turn over; smaller ones are faster"),
       schema::whole_number("seed", &Own::seed)
           .range(Range::non_negative())
           .means("whole number that seeds the turbulence")},
      [](const Own& own, const Subject& subject) {
        check_wind(own, subject);
        if (own.smallest && *own.smallest > own.largest)
          throw subject.error(
              "smallest",
              fmt::format("`smallest` = {} m is above `largest` = {} m", *own.smallest, own.largest),
              "lower it, or raise `largest`");
      });
  return table;
}

const schema::Table& grid_keys() {
  static const schema::Table table = field_table(
      "grid", vector_keys(),
      {schema::path("file", &Own::file, &Own::file_place)
           .required()
           .means(
               "a `.npy` file with an array of shape (nx, ny, nz, 3), floats or integers: the vectors at the "
               "nodes, linear between them, 0 outside"),
       schema::vector("origin", &Own::origin).unit("m").means("the first node, relative to the centre"),
       schema::vector("spacing", &Own::spacing)
           .unit("m")
           .means("distances of the nodes along x, y and z, above 0")},
      [](const Own& own, const Subject& subject) {
        check_wind(own, subject);
        if (!(own.spacing.minCoeff() > 0))
          throw subject.error("spacing", "a distance of `spacing` is not above 0", "give three above 0");
      });
  return table;
}

const schema::Table& curve_keys() {
  static const schema::Table table = field_table(
      "curve", vector_keys(),
      {schema::custom<Own>(
           "points", {schema::Type::points},
           [](const Key& key, const TomlTable& given, Own& own) { own.points = read_points(key, given); },
           [](const Key& key, const Own& own, TomlValue& out) { write_points(key, own.points, out); })
           .unit("m")
           .required()
           .means("the curve, at least two points `[[x, y, z], …]`: it acts along it, from the first to the "
                  "last"),
       schema::number("attraction", &Own::attraction)
           .range({-1e3, 1e3, false})
           .means("further size towards the curve, as a share of `strength`"),
       schema::number("reach", &Own::reach)
           .unit("m")
           .range(Range::positive())
           .means("distance at which the attraction is full; inside it is proportional to the distance")},
      [](const Own& own, const Subject& subject) {
        check_wind(own, subject);
        if (own.points.size() < 2 || own.points.size() > most_points)
          throw subject.error("points", fmt::format("the curve has {} points", own.points.size()),
                              fmt::format("give 2 to {}", most_points));
        for (std::size_t i = 1; i < own.points.size(); ++i)
          if (own.points[i] == own.points[i - 1])
            throw subject.error("points", fmt::format("the points {} and {} are equal", i, i + 1),
                                "leave one out");
      });
  return table;
}

const schema::Table& drag_keys() {
  static const schema::Table table = [] {
    std::vector<Key> keys = {
        keyed_number_key("strength", &Own::strength, {0, 1e6, false})
            .otherwise("1")
            .means("factor of both coefficients, constant or `{ keyframes = [{ time = …, "
                   "value = … }, …] }`")};
    for (Key& key : extent_keys()) keys.push_back(std::move(key));
    return field_table("drag", std::move(keys),
                       {schema::number("linear", &Own::linear)
                            .unit("1/s")
                            .range({0, 1e6, false})
                            .means("deceleration per speed"),
                        schema::number("quadratic", &Own::quadratic)
                            .unit("1/m")
                            .range({0, 1e6, false})
                            .means("deceleration per square of the speed")},
                       [](const Own& own, const Subject& subject) {
                         if (own.linear == 0 && own.quadratic == 0)
                           throw subject.error("", "the drag is 0", "give `linear` or `quadratic`");
                       });
  }();
  return table;
}

}  // namespace

const std::vector<ForceKind>& field_kinds() {
  static const std::vector<ForceKind> kinds = {
      {.name = "uniform", .keys = uniform_keys, .add = add_vectors},
      {.name = "radial", .keys = radial_keys, .add = add_vectors},
      {.name = "vortex", .keys = vortex_keys, .add = add_vectors},
      {.name = "turbulence", .keys = turbulence_keys, .add = add_vectors},
      {.name = "grid", .keys = grid_keys, .add = add_vectors},
      {.name = "curve", .keys = curve_keys, .add = add_vectors},
      {.name = "drag", .keys = drag_keys, .add = add_drag}};
  return kinds;
}

std::vector<Field> fields_in_air(const Scene& scene, const ForceSettings& wind, const std::string& body) {
  std::vector<Field> fields;
  for (const ForceSettings& force : scene.forces) {
    if (!moves_air(force) || !force.acts_on(body) || &wind_of(scene, force) != &wind) continue;
    fields.push_back({extent_of(force), row_of(force)->make(scene, force.own.as<Own>())});
  }
  return fields;
}

}  // namespace muslin
