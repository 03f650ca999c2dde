#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "muslin/core/nearest_name.hpp"
#include "muslin/core/toml_table.hpp"
#include "muslin/scene/names.hpp"
#include "muslin/scene/overrides.hpp"
#include "muslin/scene/read_body.hpp"
#include "muslin/scene/read_collider.hpp"
#include "muslin/scene/read_parts.hpp"
#include "muslin/scene/read_selection.hpp"
#include "muslin/scene/resolved.hpp"
#include "muslin/scene/scene.hpp"
#include "muslin/scene/vocabulary.hpp"

namespace muslin {
namespace {

constexpr double max_frames = 1e6;
constexpr int max_steps = 1'000'000;  // of a frame

/// None: "auto".
std::optional<int> read_steps(const TomlTable& table) {
  constexpr const char* key = "steps_per_frame";
  const TomlValue* value = table.find(key);
  if (value == nullptr) return std::nullopt;
  if (value->type == TomlValue::Type::string && value->string == "auto") return std::nullopt;
  if (value->type != TomlValue::Type::integer || value->integer < 1 || value->integer > max_steps) {
    throw table.error(key, "`steps_per_frame` is neither \"auto\" nor a number of steps",
                      fmt::format("write \"auto\" or a whole number from 1 to {}", max_steps));
  }
  return static_cast<int>(value->integer);
}

TimeSettings read_time(const TomlTable& top) {
  TimeSettings time;
  const auto table = top.table("time", known_keys("time"));
  if (!table) return time;
  time.duration = table->number("duration", "s", {0, 1e9, true}, time.duration);
  time.frame_rate = table->number("frame_rate", "1/s", {1e-6, 1e6, false}, time.frame_rate);
  time.steps_per_frame = read_steps(*table);
  if (time.duration * time.frame_rate > max_frames) {
    throw table->error("duration",
                       fmt::format("{} s at {} frames per second are more than a million frames",
                                   time.duration, time.frame_rate),
                       "shorten `duration` or lower `frame_rate`");
  }
  return time;
}

/// Warns of settings that the integrator does not use.
void warn_of_unused(const TomlTable& table, const SolverSettings& solver, const TimeSettings& time,
                    std::vector<std::string>& warnings) {
  const Integrator integrator = solver.integrator;
  const bool newton = integrator == Integrator::implicit_euler || integrator == Integrator::bdf2;
  const bool linear = integrator == Integrator::linearly_implicit_euler;
  const std::string& name = name_of(integrator_names(), integrator);
  const auto warn = [&](const char* key, const std::string& effect, const std::string& remedy) {
    if (table.has(key))
      warnings.push_back(
          fmt::format("[solver] `{}` has no effect on {}: take it out, {}", key, effect, remedy));
  };
  if (!linear) warn("linear_tolerance", name, "or choose `integrator = \"linearly_implicit_euler\"`");
  if (newton) return;
  const std::string choose = "or choose `integrator = \"implicit_euler\"` or `\"bdf2\"`";
  warn("tolerance", name, choose);
  if (!linear) warn("effort", name, choose);
  // With linearly_implicit_euler an effort has one effect: automatic steps of drafts are longer.
  if (linear && time.steps_per_frame)
    warn("effort", name + " with a number of `steps_per_frame`", "set `steps_per_frame = \"auto\"`, " + choose);
  if (linear && !time.steps_per_frame && solver.effort == Effort::exact)
    warn("effort", name + " but for drafts", choose);
}

SolverSettings read_solver(const TomlTable& top, const TimeSettings& time,
                           std::vector<std::string>& warnings) {
  SolverSettings solver;
  const auto table = top.table("solver", known_keys("solver"));
  if (!table) return solver;
  solver.integrator = static_cast<Integrator>(table->choice("integrator", integrator_names(), 0));
  solver.effort = static_cast<Effort>(
      table->choice("effort", effort_names(), static_cast<std::size_t>(solver.effort)));
  if (table->has("tolerance")) solver.tolerance = table->number("tolerance", "", {0, 1, true});
  solver.linear_tolerance =
      table->number("linear_tolerance", "", {1e-16, 0.5, false}, solver.linear_tolerance);
  warn_of_unused(*table, solver, time, warnings);
  return solver;
}

/// Returns the tables of a list such as [[pin]]; none if the key is missing.
const std::vector<TomlValue>& entries(const TomlTable& top, const std::string& key) {
  static const std::vector<TomlValue> none;
  const TomlValue* value = top.find(key);
  if (value == nullptr) return none;
  if (value->type != TomlValue::Type::array) {
    throw top.error(key, "`" + key + "` is not a list of tables", "write [[" + key + "]] in two brackets");
  }
  return value->items;
}

/// Names are unique among their kind, and those of bodies and colliders among both, as files and the command
/// line refer to them.
class UniqueNames {
 public:
  void add(const std::string& kind, const std::string& name, const Place& place) {
    const auto [at, is_new] = kinds_.try_emplace(name, kind);
    if (is_new) return;
    const std::string both =
        at->second == kind ? "two of [[" + kind + "]]" : "a [[" + at->second + "]] and a [[" + kind + "]]";
    throw Error(ErrorKind::input, place, "there are " + both + " called `" + name + "`",
                "give each a `name` of its own");
  }

 private:
  std::map<std::string, std::string> kinds_;
};

/// Bodies, and colliders with a density.
std::vector<std::string> movable_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const BodySettings& body : scene.bodies) names.push_back(body.name);
  for (const ColliderSettings& collider : scene.colliders)
    if (collider.is_free()) names.push_back(collider.name);
  return names;
}

bool is_rigid(const Scene& scene, const std::string& name) {
  return std::any_of(scene.colliders.begin(), scene.colliders.end(),
                     [&](const ColliderSettings& collider) { return collider.name == name; });
}

/// Returns the body that the table names; if it names none, the only one, or, if `all_allowed`, "" for all.
std::string read_body_name(const TomlTable& table, const Scene& scene, bool all_allowed) {
  const std::vector<std::string> names = movable_names(scene);
  if (!table.has("body")) {
    if (all_allowed) return {};
    if (scene.bodies.size() == 1 || names.size() == 1) return names.front();
    throw Error(ErrorKind::input, table.place(),
                fmt::format("{} does not say which of the {} bodies it means", table.title(), names.size()),
                "add `body = …`, one of " + name_list(names));
  }
  const std::string name = table.string("body");
  if (std::find(names.begin(), names.end(), name) != names.end()) return name;
  if (is_rigid(scene, name)) {
    throw table.error("body", "the collider `" + name + "` has no mass, so nothing holds or pushes it",
                      "give it a `density`, or move it by `keyframes` of its own");
  }
  throw table.error("body", "there is no body `" + name + "`", name_advice(name, names));
}

void read_times(const TomlTable& table, double& from, double& until) {
  from = table.number("from", "s", Range::any(), from);
  until = table.number("until", "s", Range::any(), until);
  if (until <= from) {
    throw table.error("until", fmt::format("`until` = {} s is not after `from` = {} s", until, from),
                      "let it end after it begins");
  }
}

PinSettings read_pin(const TomlValue& value, std::size_t index, const Scene& scene) {
  const TomlTable table(value, title_of("pin", value, index), known_keys("pin"));
  PinSettings pin;
  pin.place = table.place();
  pin.name = read_name(table, fmt::format("pin{}", index));
  pin.body = read_body_name(table, scene, false);
  if (!is_rigid(scene, pin.body)) {
    pin.where = read_selection(table);
  } else if (table.has("where")) {
    throw table.error("where", "a rigid body is held as a whole", "take `where` out");
  }
  read_times(table, pin.from, pin.until);
  if (table.has("pivot")) pin.pivot = table.vector("pivot", "m");
  if (table.has("sequence")) {
    if (is_rigid(scene, pin.body))
      throw table.error("sequence", "a rigid body does not follow a sequence", "move it by `keyframes`");
    pin.sequence = table.string("sequence");
    pin.sequence_place = table.place("sequence");
    for (const char* other : {"keyframes", "pivot"}) {
      if (table.has(other))
        throw table.error(other, fmt::format("`{}` and `sequence` both say how the pin moves", other),
                          "keep one of them");
    }
  }
  pin.motion.keys = read_motion(table, "pin.keyframes");
  return pin;
}

ForceSettings read_force(const TomlValue& value, std::size_t index, const Scene& scene) {
  const std::string title = title_of("force", value, index);
  if (value.type != TomlValue::Type::table || value.find("type") == nullptr) {
    throw Error(ErrorKind::input, value.place, title + " has no `type`",
                "add `type = …`, one of " + name_list(force_type_names()));
  }
  TomlValue type_only;  // the type decides which keys are known
  type_only.keys = {"type"};
  type_only.items = {*value.find("type")};
  ForceSettings force;
  force.type = static_cast<ForceSettings::Type>(
      TomlTable(type_only, title, {"type"}).choice("type", force_type_names(), 0));

  const std::string& type = name_of(force_type_names(), force.type);
  const TomlTable table(value, title + " of type " + type, known_keys("force." + type));
  force.place = table.place();
  force.name = read_name(table, fmt::format("{}{}", type, index));
  force.body = read_body_name(table, scene, force.type != ForceSettings::Type::point);
  read_times(table, force.from, force.until);

  const std::string& key = name_of(force_value_names(), force.type);
  const char* unit = std::array{"m/s²", "N", "m/s"}[static_cast<std::size_t>(force.type)];
  if (table.has("keyframes") && table.has(key)) {
    throw table.error(key, "`" + key + "` is given twice, as constant and by `keyframes`",
                      "keep one of them");
  }
  read_keyframes(table, known_keys("force.keyframes"), [&](const TomlTable& frame, double time) {
    force.value.keys.push_back({time, frame.vector("value", unit)});
  });
  if (force.value.keys.empty()) {
    const bool standard = force.type == ForceSettings::Type::gravity && !table.has(key);
    force.value.keys.push_back({0, standard ? Vec3(0, -9.8, 0) : table.vector(key, unit)});
  }
  const bool rigid = is_rigid(scene, force.body);
  if (force.type == ForceSettings::Type::point && (!rigid || table.has("where")))
    force.where = read_selection(table);
  if (force.type == ForceSettings::Type::wind && rigid)
    throw table.error("body", "wind does not blow on rigid bodies", "push it by a point force");
  if (force.type == ForceSettings::Type::wind) {
    force.air_density = table.number("air_density", "kg/m³", {0, 1e5, false}, force.air_density);
    force.drag = table.number("drag", "", {0, 1e3, false}, force.drag);
    force.lift = table.number("lift", "", {0, force.drag, false}, force.lift);
    force.gust = table.number("gust", "m/s", {0, 1e4, false}, force.gust);
    force.gust_length = table.number("gust_length", "m", {1e-6, 1e6, false}, force.gust_length);
    force.seed = table.integer("seed", 0, std::numeric_limits<std::int64_t>::max(), force.seed);
  }
  return force;
}

ProbeSettings read_probe(const TomlValue& value, std::size_t index, const Scene& scene) {
  const TomlTable table(value, title_of("probe", value, index), known_keys("probe"));
  ProbeSettings probe;
  probe.place = table.place();
  probe.name = read_name(table, fmt::format("probe{}", index));
  const bool of_collider = table.has("body") && is_rigid(scene, table.string("body"));
  probe.body = of_collider ? table.string("body") : read_body_name(table, scene, false);
  probe.at = table.vector("at", "m");
  return probe;
}

template <class Settings, class Read>
void read_list(const TomlTable& top, const std::string& kind, UniqueNames& names, std::vector<Settings>& list,
               const Read& read) {
  for (const TomlValue& value : entries(top, kind)) {
    list.push_back(read(value, list.size()));
    const TomlValue* name = value.find("name");
    names.add(kind, list.back().name, name == nullptr ? value.place : name->place);
  }
}

}  // namespace

Scene read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return parse_scene(read_text(file), file, overrides);
}

Scene parse_scene(const std::string& text, const std::filesystem::path& file,
                  const std::vector<std::string>& overrides) {
  TomlValue root = parse_toml(text, file.string());
  for (const std::string& setting : overrides) apply_override(root, setting);
  root.place = {file.string(), 0, 0};
  const TomlTable top(root, "the scene", known_keys(""));

  Scene scene;
  scene.file = file;
  scene.text = text;
  scene.title = top.string("title", file.stem().string());
  scene.time = read_time(top);
  scene.solver = read_solver(top, scene.time, scene.warnings);
  UniqueNames bodies, pins, forces, probes;
  read_list(top, "body", bodies, scene.bodies, [&](const TomlValue& value, std::size_t index) {
    return read_body(value, index, file.parent_path(), scene.warnings);
  });
  read_list(top, "collider", bodies, scene.colliders, read_collider);
  if (movable_names(scene).empty()) {
    throw Error(ErrorKind::input, root.place, "the scene has no body",
                "add a [[body]] with `mesh`, `material` and `voxel_width`, or `model = \"shell\"`");
  }
  scene.contact = read_contact(top);
  read_list(top, "pin", pins, scene.pins,
            [&](const TomlValue& value, std::size_t index) { return read_pin(value, index, scene); });
  read_list(top, "force", forces, scene.forces,
            [&](const TomlValue& value, std::size_t index) { return read_force(value, index, scene); });
  read_list(top, "probe", probes, scene.probes,
            [&](const TomlValue& value, std::size_t index) { return read_probe(value, index, scene); });
  scene.resolved = resolved_json(scene);
  return scene;
}

}  // namespace muslin
