#include <algorithm>
#include <array>
#include <limits>
#include <set>

#include <fmt/format.h>

#include "muslin/core/nearest_name.hpp"
#include "muslin/core/toml_table.hpp"
#include "muslin/scene/names.hpp"
#include "muslin/scene/overrides.hpp"
#include "muslin/scene/placement.hpp"
#include "muslin/scene/read_body.hpp"
#include "muslin/scene/read_selection.hpp"
#include "muslin/scene/resolved.hpp"
#include "muslin/scene/scene.hpp"
#include "muslin/scene/vocabulary.hpp"

namespace muslin {
namespace {

constexpr double most_frames = 1e6;

TimeSettings read_time(const TomlTable& top) {
  TimeSettings time;
  const auto table = top.table("time", known_keys("time"));
  if (!table) return time;
  time.duration = table->number("duration", "s", {0, 1e9, true}, time.duration);
  time.frame_rate = table->number("frame_rate", "1/s", {1e-6, 1e6, false}, time.frame_rate);
  time.steps_per_frame =
      static_cast<int>(table->integer("steps_per_frame", 1, 1'000'000, time.steps_per_frame));
  if (time.duration * time.frame_rate > most_frames) {
    throw table->error("duration",
                       fmt::format("{} s at {} frames per second are more than a million frames",
                                   time.duration, time.frame_rate),
                       "shorten `duration` or lower `frame_rate`");
  }
  return time;
}

SolverSettings read_solver(const TomlTable& top) {
  SolverSettings solver;
  const auto table = top.table("solver", known_keys("solver"));
  if (!table) return solver;
  solver.integrator = static_cast<Integrator>(table->choice("integrator", integrator_names(), 0));
  solver.tolerance = table->number("tolerance", "m/s²", Range::positive(), solver.tolerance);
  solver.max_iterations =
      static_cast<int>(table->integer("max_iterations", 1, 1'000'000, solver.max_iterations));
  solver.linear_tolerance =
      table->number("linear_tolerance", "", {1e-16, 0.5, false}, solver.linear_tolerance);
  return solver;
}

/// The tables of a list such as [[pin]]; none if the key is missing.
const std::vector<TomlValue>& entries(const TomlTable& top, const std::string& key) {
  static const std::vector<TomlValue> none;
  const TomlValue* value = top.find(key);
  if (value == nullptr) return none;
  if (value->type != TomlValue::Type::array) {
    throw top.error(key, "`" + key + "` is not a list of tables", "write [[" + key + "]] in two brackets");
  }
  return value->items;
}

std::string title_of(const std::string& kind, const TomlValue& value, std::size_t index) {
  const TomlValue* name = value.find("name");
  const bool has_name = name != nullptr && name->type == TomlValue::Type::string;
  return "[[" + kind + "]] " + (has_name ? name->string : std::to_string(index));
}

/// Names are unique among their kind, as files and the command line refer to them.
class UniqueNames {
 public:
  explicit UniqueNames(std::string kind) : kind_(std::move(kind)) {}
  void add(const std::string& name, const Place& place) {
    if (names_.insert(name).second) return;
    throw Error(ErrorKind::input, place, "there are two of [[" + kind_ + "]] called `" + name + "`",
                "give each a `name` of its own");
  }

 private:
  std::string kind_;
  std::set<std::string> names_;
};

std::string read_name(const TomlTable& table, const std::string& fallback) {
  const std::string name = table.string("name", fallback);
  require_name(name, table.place("name"));
  return name;
}

std::vector<std::string> body_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const BodySettings& body : scene.bodies) names.push_back(body.name);
  return names;
}

/// The body that the table names; if it names none, the only one, or, if `all_allowed`, "" for all.
std::string read_body_name(const TomlTable& table, const Scene& scene, bool all_allowed) {
  const std::vector<std::string> names = body_names(scene);
  if (!table.has("body")) {
    if (all_allowed) return {};
    if (names.size() == 1) return names.front();
    throw Error(ErrorKind::input, table.place(),
                fmt::format("{} does not say which of the {} bodies it means", table.title(), names.size()),
                "add `body = …`, one of " + name_list(names));
  }
  const std::string name = table.string("body");
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    throw table.error("body", "there is no body `" + name + "`", name_advice(name, names));
  }
  return name;
}

void read_times(const TomlTable& table, double& from, double& until) {
  from = table.number("from", "s", Range::any(), from);
  until = table.number("until", "s", Range::any(), until);
  if (until <= from) {
    throw table.error("until", fmt::format("`until` = {} s is not after `from` = {} s", until, from),
                      "let it end after it begins");
  }
}

/// The tables under `keyframes`, each with a time after the one before.
template <class Read>
void read_keyframes(const TomlTable& owner, const std::vector<std::string>& known, const Read& read) {
  const auto* items = owner.array("keyframes", "tables such as { time = 0, … }");
  if (items == nullptr) return;
  if (items->empty()) throw owner.error("keyframes", "`keyframes` is empty", "take it out or give keys");
  double last = -std::numeric_limits<double>::infinity();
  for (const TomlValue& item : *items) {
    const TomlTable key(item, "a keyframe of " + owner.title(), known);
    const double time = key.number("time", "s", Range::any());
    if (time <= last) {
      throw key.error("time",
                      fmt::format("the keyframe at {} s does not come after that at {} s", time, last),
                      "order keyframes by time, one at a time");
    }
    last = time;
    read(key, time);
  }
}

PinSettings read_pin(const TomlValue& value, std::size_t index, const Scene& scene) {
  const TomlTable table(value, title_of("pin", value, index), known_keys("pin"));
  PinSettings pin;
  pin.place = table.place();
  pin.name = read_name(table, fmt::format("pin{}", index));
  pin.body = read_body_name(table, scene, false);
  pin.where = read_selection(table);
  read_times(table, pin.from, pin.until);
  if (table.has("pivot")) pin.pivot = table.vector("pivot", "m");
  if (table.has("sequence")) {
    pin.sequence = table.string("sequence");
    pin.sequence_place = table.place("sequence");
    for (const char* other : {"keyframes", "pivot"}) {
      if (table.has(other))
        throw table.error(other, fmt::format("`{}` and `sequence` both say how the pin moves", other),
                          "keep one of them");
    }
  }
  read_keyframes(table, known_keys("pin.keyframes"), [&](const TomlTable& key, double time) {
    pin.motion.keys.push_back({time, key.vector("translate", "m", Vec3::Zero()),
                               rotation_from_degrees(key.vector("rotate", "degrees", Vec3::Zero()))});
  });
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
  if (force.type == ForceSettings::Type::point) force.where = read_selection(table);
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
  probe.body = read_body_name(table, scene, false);
  probe.at = table.vector("at", "m");
  return probe;
}

template <class Settings, class Read>
void read_list(const TomlTable& top, const std::string& kind, std::vector<Settings>& list, const Read& read) {
  UniqueNames names(kind);
  for (const TomlValue& value : entries(top, kind)) {
    list.push_back(read(value, list.size()));
    const TomlValue* name = value.find("name");
    names.add(list.back().name, name == nullptr ? value.place : name->place);
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
  refuse_reserved_keys(root);
  root.place = {file.string(), 0, 0};
  const TomlTable top(root, "the scene", known_keys(""));

  Scene scene;
  scene.file = file;
  scene.text = text;
  scene.title = top.string("title", file.stem().string());
  scene.time = read_time(top);
  scene.solver = read_solver(top);
  read_list(top, "body", scene.bodies, [&](const TomlValue& value, std::size_t index) {
    return read_body(value, index, file.parent_path(), scene.warnings);
  });
  if (scene.bodies.empty()) {
    throw Error(ErrorKind::input, root.place, "the scene has no body",
                "add a [[body]] with `mesh`, `material` and `voxel_width`, or `model = \"shell\"`");
  }
  read_list(top, "pin", scene.pins,
            [&](const TomlValue& value, std::size_t index) { return read_pin(value, index, scene); });
  read_list(top, "force", scene.forces,
            [&](const TomlValue& value, std::size_t index) { return read_force(value, index, scene); });
  read_list(top, "probe", scene.probes,
            [&](const TomlValue& value, std::size_t index) { return read_probe(value, index, scene); });
  scene.resolved = resolved_json(scene);
  return scene;
}

}  // namespace muslin
