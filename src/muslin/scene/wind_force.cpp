#include "muslin/scene/wind_force.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "muslin/force/wind.hpp"
#include "muslin/scene/common_keys.hpp"
#include "muslin/scene/field_force.hpp"
#include "muslin/scene/wind_force_settings.hpp"

namespace muslin {
namespace {

using schema::Subject;
using Own = WindForceSettings;

const schema::Table& keyframes() {
  static const schema::Table table = force_keyframe_table("wind", "velocity", "m/s");
  return table;
}

void check_lift(const Own& own, const Subject& subject) {
  for (const KeyedNumber* number : {&own.lift, &own.drag}) {
    for (const KeyedNumber::Key& key : number->keys) {
      const double lift = own.lift.at(key.time), drag = own.drag.at(key.time);
      if (lift <= drag) continue;
      const std::string when =
          own.lift.is_constant() && own.drag.is_constant() ? "" : fmt::format(" at {} s", key.time);
      throw subject.error("lift", fmt::format("`lift` = {} is above `drag` = {}{}", lift, drag, when),
                          "lower it, or raise `drag`");
    }
  }
}

const schema::Table& keys() {
  static const schema::Table table = [] {
    schema::Table wind =
        schema::table_of<ForceSettings>("wind", {force_body_key("every body", "the body it acts on")});
    add_value_keys(
        wind,
        {.key = "velocity", .unit = "m/s", .meaning = "mean velocity of the air", .keyframes = keyframes});
    add_own_keys<Own>(
        wind,
        {keyed_number_key("air_density", &Own::air_density, {0, 1e5, false})
             .unit("kg/m³")
             .means("density of the air"),
         keyed_number_key("drag", &Own::drag, {0, 1e3, false})
             .means("drag coefficient; 1.17 is a square plate, broadside"),
         keyed_number_key("lift", &Own::lift, {0, 1e3, false}).means("lift coefficient, at most `drag`"),
         keyed_number_key("gust", &Own::gust, {0, 1e4, false})
             .unit("m/s")
             .means("root mean square of each component of the turbulence"),
         schema::number("gust_length", &Own::gust_length)
             .unit("m")
             .range({1e-6, 1e6, false})
             .means("size of its largest eddies"),
         schema::whole_number("seed", &Own::seed)
             .range(Range::non_negative())
             .means("whole number that seeds the turbulence"),
         schema::number("porosity", &Own::porosity)
             .range({0, 1, false})
             .means("open share of the surface, through which air passes: drag and lift are those of the "
                    "rest")},
        check_lift);
    return wind;
  }();
  return table;
}

void check(const ForceSettings& force, const Scene& scene, const Subject& subject) {
  if (is_rigid(scene, force.body))
    throw subject.error("body", "wind does not blow on rigid bodies", "push it by a point force");
}

void add(Model& model, const ForceSettings& force) {
  const auto soft = std::count_if(model.bodies.begin(), model.bodies.end(),
                                  [](const Component& body) { return body.is_soft(); });
  for (const Component& body : model.bodies) {
    if (!force.acts_on(body.name) || !body.is_soft()) continue;
    Embedding skin = body.skin;
    for (auto& vertices : skin.vertices) {
      for (int& v : vertices) v += body.first_vertex;
    }
    std::vector<Vec3i> triangles = triangulate(body.skin_mesh()).triangles;
    if (!body.sheet && body.report.volume < 0) {
      for (Vec3i& triangle : triangles) std::swap(triangle[1], triangle[2]);
    }
    const Own& own = force.own.as<Own>();
    WindSettings wind;
    wind.velocity = force.value;
    wind.window = {force.from, force.until};
    wind.air_density = own.air_density;
    wind.drag = own.drag;
    wind.lift = own.lift;
    wind.gust = own.gust;
    wind.gust_length = own.gust_length;
    wind.seed = static_cast<std::uint64_t>(own.seed);
    wind.porosity = own.porosity;
    wind.fields = fields_in_air(model.scene, force, body.name);
    // Without a consistent front a face counts from both sides.
    wind.two_sided = body.sheet || body.report.flipped_edges > 0 || body.report.non_manifold_edges > 0;
    const std::string name = soft > 1 ? force.name + ": " + body.name : force.name;
    model.loads.push_back(
        {name, EnergyRole::work,
         std::make_shared<Wind>(wind, std::move(skin), std::move(triangles), model.vertex_count())});
  }
}

}  // namespace

const ForceKind wind_kind = {.name = "wind", .keys = keys, .check = check, .add = add};

}  // namespace muslin
