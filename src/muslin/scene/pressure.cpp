#include "muslin/scene/pressure.hpp"

#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "muslin/component/body_maps.hpp"
#include "muslin/energy/pressure_energy.hpp"
#include "muslin/force/uneven_pressure.hpp"
#include "muslin/geometry/enclosed_volume.hpp"
#include "muslin/potential/restricted.hpp"
#include "muslin/scene/common_keys.hpp"
#include "muslin/scene/model.hpp"
#include "muslin/schema/declare.hpp"

namespace muslin {
namespace {

constexpr double largest_pressure = 1e9;  // [Pa]
/// A gas needs a volume of at least this share of (area)^(3/2).
constexpr double flattest = 1e-6;

schema::Table declare_pressure() {
  schema::Table table = schema::table_of<PressureSettings>(
      "[[pressure]]",
      {name_key<PressureSettings>("`pressure0`, `pressure1`, …").means("name in messages"),
       schema::text("body", &PressureSettings::body)
           .otherwise("the only body")
           .means("a shell that is closed or nearly closed; flat lids close its holes"),
       keyed_number_key("pressure", &PressureSettings::pressure, {-largest_pressure, largest_pressure, false})
           .unit("Pa")
           .required()
           .means("excess over the outside, constant or `{ keyframes = [{ time = …, value = … }, …] }`; of a "
                  "gas: its excess while the surface encloses the volume at rest"),
       schema::number("weight", &PressureSettings::weight)
           .range(Range::between(-1, 1))
           .varies(&PressureSettings::variations, {.map = true})
           .means("factor of the pressure at each vertex; of a gas always 1"),
       schema::truth("gas", &PressureSettings::gas)
           .means(
               "`true`: a fixed amount of gas at a constant temperature, whose pressure falls as the volume "
               "grows"),
       schema::number("atmosphere", &PressureSettings::atmosphere)
           .unit("Pa")
           .range({0, largest_pressure, false})
           .needs("gas", "only a gas asks for the pressure outside; remove it")
           .means("pressure outside, for a gas")});
  for (schema::Key& key :
       window_keys(&PressureSettings::from, &PressureSettings::until, "time when it begins to act",
                   "time when it ends, after `from`", "no end"))
    table.keys.push_back(key);
  schema::add_rule<PressureSettings>(table, [](const PressureSettings& settings,
                                               const schema::Subject& subject) {
    check_window(settings.from, settings.until, subject);
    if (!settings.gas) return;
    if (settings.weight != 1 || !settings.variations.empty())
      throw subject.error("weight", "a gas has one pressure everywhere, but its `weight` is given",
                          "leave out `weight`, or `gas`");
    for (const KeyedNumber::Key& key : settings.pressure.keys)
      if (key.value < -settings.atmosphere)
        throw subject.error("pressure",
                            fmt::format("a gas of {} Pa less than the {} Pa outside has a negative amount",
                                        -key.value, settings.atmosphere),
                            "give at least minus `atmosphere`");
  });
  return table;
}

/// One pressure that acts on one body.
class PressureBuilder {
 public:
  PressureBuilder(Model& model, const PressureSettings& settings, Component& body)
      : model_(model), settings_(settings), body_(body) {}

  void build() {
    if (!body_.is_mesh() || !body_.is_soft())
      fail(fmt::format("`{}` is no shell", body_.name), "give the name of a shell");
    const std::shared_ptr<const EnclosedVolume> surface = enclosed();
    const double volume = surface->value(body_.mesh.positions);
    const double size = body_.report.area * std::sqrt(body_.report.area);
    if (settings_.gas && !(volume > flattest * size))
      fail(fmt::format("`{}` encloses no volume at rest, so a gas has no room in it", body_.name),
           "take `gas` out, or start from a shape with some volume");
    if (!surface->holes().empty()) {
      model_.warnings.push_back(
          fmt::format("pressure {}: flat lids close {} of body {}, and the pressure acts "
                      "on them too",
                      settings_.name,
                      surface->holes().size() == 1 ? std::string("a hole")
                                                   : fmt::format("{} holes", surface->holes().size()),
                      body_.name));
    }
    add(surface, settings_.gas ? volume : 0);
    for (const MappedNumber& map :
         read_maps(settings_.variations, pressure_table(), {model_.scene.file, model_.scene.meshes}, body_)) {
      add_uneven(surface, map);
      MappedNumber& shown = body_.maps.emplace_back(map);
      shown.variation.key = settings_.name + "." + map.variation.key;
      shown.may_change_on_resume = true;
    }
  }

 private:
  [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const {
    throw Error(ErrorKind::input, settings_.place,
                fmt::format("[[pressure]] `{}`: {}", settings_.name, problem), remedy);
  }

  std::shared_ptr<const EnclosedVolume> enclosed() const {
    std::vector<Vec3i> triangles = triangulate(body_.mesh).triangles;
    if (body_.report.volume < 0)
      for (Vec3i& triangle : triangles) std::swap(triangle[1], triangle[2]);
    try {
      return std::make_shared<EnclosedVolume>(triangles, body_.mesh.vertex_count());
    } catch (const Error& error) {
      fail(error.problem(), error.remedy());
    }
  }

  void add(const std::shared_ptr<const EnclosedVolume>& surface, double rest_volume) {
    const auto first = static_cast<std::size_t>(body_.first_vertex),
               count = static_cast<std::size_t>(body_.vertex_count);
    const PressureSettings& s = settings_;
    const auto gas_at = [s, rest_volume](double time) {
      return Gas{s.weight * s.pressure.at(time), s.gas ? s.atmosphere : 0, rest_volume};
    };
    // In a step that crosses a border of the window a pressure acts with its share, a gas in full.
    const auto gas_of_step = [s, gas_at](double begin, double end) -> std::optional<Gas> {
      const Window window{s.from, s.until};
      const double share = window.share(begin, end);
      if (share == 0) return std::nullopt;
      Gas gas = gas_at(window.sample(end));
      if (!s.gas) gas.pressure *= share;
      return gas;
    };
    // Only a pressure that stays the same during the whole run stores energy; a changing one does work.
    if (s.pressure.is_constant() && s.from <= 0 && s.until >= model_.scene.time.duration) {
      model_.potentials.push_back({s.name, EnergyRole::potential,
                                   std::make_shared<RestrictedPotential>(
                                       std::make_shared<PressureEnergy>(surface, gas_at(0)), first, count)});
      return;
    }
    model_.loads.push_back(
        {s.name, EnergyRole::work,
         std::make_shared<RestrictedLoad>(std::make_shared<Pressure>(surface, gas_of_step), first, count)});
  }

  /// Adds what a map has above its middle, which is the weight of the settings.
  void add_uneven(const std::shared_ptr<const EnclosedVolume>& surface, const MappedNumber& map) {
    if (map.variation.from == map.variation.to) return;
    std::vector<double> shares = map.numbers();
    for (double& share : shares) share -= settings_.weight;
    const auto pressure_of_step = [s = settings_](double begin, double end) {
      const Window window{s.from, s.until};
      return window.share(begin, end) * s.pressure.at(window.sample(end));
    };
    model_.loads.push_back(
        {settings_.name + " by map", EnergyRole::work,
         std::make_shared<RestrictedLoad>(
             std::make_shared<UnevenPressure>(surface, std::move(shares), pressure_of_step),
             static_cast<std::size_t>(body_.first_vertex), static_cast<std::size_t>(body_.vertex_count))});
  }

  Model& model_;
  const PressureSettings& settings_;
  Component& body_;
};

}  // namespace

const schema::Table& pressure_table() {
  static const schema::Table table = declare_pressure();
  return table;
}

void finish_pressure(const TomlTable& table, std::size_t index, PressureSettings& pressure,
                     const Scene& scene) {
  complete_name(table, fmt::format("pressure{}", index), pressure.name);
  resolve_body(table, scene, false, pressure.body);
  require_new_name(table, scene.pressures, "pressure", "pressure", pressure.name);
  require_new_name(table, scene.forces, "force", "pressure", pressure.name);
}

void build_pressures(Model& model, std::span<const std::shared_ptr<Component>> components) {
  for (const PressureSettings& settings : model.scene.pressures) {
    const auto body = static_cast<std::size_t>(model.bodies.index_of(model.body(settings.body)));
    PressureBuilder(model, settings, *components[body]).build();
  }
}

}  // namespace muslin
