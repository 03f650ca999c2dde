#include "muslin/scene/scene_table.hpp"

#include "muslin/component/body_table.hpp"
#include "muslin/component/collider/collider_table.hpp"
#include "muslin/component/kinds.hpp"
#include "muslin/scene/common_keys.hpp"
#include "muslin/scene/force_kinds.hpp"
#include "muslin/scene/names.hpp"
#include "muslin/scene/pin_table.hpp"
#include "muslin/scene/scene.hpp"
#include "muslin/schema/declare.hpp"

namespace muslin {
namespace {

using schema::Key;
using schema::Type;

constexpr double max_frames = 1e6;
constexpr int max_steps = 1'000'000;  // of a frame

/// None: "auto".
std::optional<int> read_steps(const Key& key, const TomlTable& table) {
  const TomlValue& value = *table.find(key.name);
  if (value.type == TomlValue::Type::string && value.string == "auto") return std::nullopt;
  if (value.type != TomlValue::Type::integer || value.integer < 1 || value.integer > max_steps) {
    throw table.error(key.name, "`steps_per_frame` is neither \"auto\" nor a number of steps",
                      fmt::format("write \"auto\" or a whole number from 1 to {}", max_steps));
  }
  return static_cast<int>(value.integer);
}

Key steps_key() {
  Key key = schema::custom<TimeSettings>(
                "steps_per_frame", {Type::word, Type::whole_number},
                [](const Key& k, const TomlTable& table, TimeSettings& time) {
                  time.steps_per_frame = read_steps(k, table);
                },
                [](const Key& k, const TimeSettings& time, TomlValue& out) {
                  const auto& steps = time.steps_per_frame;
                  schema::append(out, k.name, steps ? schema::whole(*steps) : schema::words("auto"));
                })
                .range({1, max_steps, false})
                .may_change_on_resume()
                .means("time steps per frame: `\"auto\"`, as many as the motion needs, or a whole number");
  key.choices = {"auto"};
  key.check = [](const Key& k, const void* s, const schema::Subject& subject) {
    const auto& steps = static_cast<const TimeSettings*>(s)->steps_per_frame;
    if (steps) schema::WholeNumberCodec{}.check(k, *steps, subject);
  };
  return key;
}

const schema::Table& time_table() {
  static const schema::Table table = [] {
    schema::Table time = schema::table_of<TimeSettings>(
        "[time]", {schema::number("duration", &TimeSettings::duration)
                       .unit("s")
                       .range({0, 1e9, true})
                       .may_change_on_resume()
                       .means("simulated time; rounded up to whole frames, at most a million of them"),
                   schema::number("frame_rate", &TimeSettings::frame_rate)
                       .unit("1/s")
                       .range({1e-6, 1e6, false})
                       .means("frames per second"),
                   steps_key()});
    schema::add_rule<TimeSettings>(time, [](const TimeSettings& settings, const schema::Subject& subject) {
      if (settings.duration * settings.frame_rate <= max_frames) return;
      throw subject.error("duration",
                          fmt::format("{} s at {} frames per second are more than a million frames",
                                      settings.duration, settings.frame_rate),
                          "shorten `duration` or lower `frame_rate`");
    });
    return time;
  }();
  return table;
}

const schema::Table& effort_over_time_table() {
  static const schema::Table table = [] {
    const auto keyframe_table = []() -> const schema::Table& {
      static const schema::Table keyframe = schema::table_of<SolverSettings::EffortKey>(
          "keyframes of an effort", {schema::number("time", &SolverSettings::EffortKey::time)
                                         .unit("s")
                                         .required()
                                         .means("time of the keyframe, later than the previous one"),
                                     schema::word("value", &SolverSettings::EffortKey::value, effort_names())
                                         .required()
                                         .means("the effort from that time on")});
      return keyframe;
    };
    return schema::table_of<SolverSettings>(
        "an effort over time",
        {schema::keyframes("keyframes", &SolverSettings::effort_keys, +keyframe_table)
             .required()
             .means("a list of tables; times ascend; before the first its effort holds")});
  }();
  return table;
}

/// A word, or `{ keyframes = [{ time, value }, …] }`.
Key effort_key() {
  Key key =
      schema::word("effort", &SolverSettings::effort, effort_names())
          .means(
              "how accurately steps are solved, one word or `{ keyframes = [{ time = …, value = … }, …] }`: "
              "`\"draft\"`, to see whether a scene works · `\"normal\"`, for pictures · `\"exact\"`, for "
              "measurements");
  key.types.push_back(Type::table);
  key.table = effort_over_time_table;
  key.read = [word = key.read](const Key& k, const TomlTable& table, void* s) {
    auto& solver = *static_cast<SolverSettings*>(s);
    solver.effort_keys.clear();
    const TomlValue& value = *table.find(k.name);
    if (value.type != TomlValue::Type::table) return word(k, table, s);
    effort_over_time_table().read(
        effort_over_time_table().open(value, fmt::format("`{}` of {}", k.name, table.title())), solver);
    solver.effort = solver.effort_keys.front().value;
  };
  key.write = [word = key.write](const Key& k, const void* s, TomlValue& out) {
    const auto& solver = *static_cast<const SolverSettings*>(s);
    if (solver.effort_keys.empty()) return word(k, s, out);
    schema::append(out, k.name, effort_over_time_table().write(solver));
  };
  key.check = [word = key.check](const Key& k, const void* s, const schema::Subject& subject) {
    word(k, s, subject);
    effort_over_time_table().check(*static_cast<const SolverSettings*>(s), subject);
  };
  return key;
}

const schema::Table& solver_table() {
  static const schema::Table table = schema::table_of<SolverSettings>(
      "[solver]",
      {schema::word("integrator", &SolverSettings::integrator, integrator_names())
           .means("`\"implicit_euler\"`: first order, always stable, damps · `\"bdf2\"`: second order, "
                  "always stable, "
                  "damps little · `\"linearly_implicit_euler\"`: one Newton step · `\"symplectic_euler\"`: "
                  "explicit, "
                  "only stable for small steps"),
       effort_key(),
       schema::number("tolerance", &SolverSettings::tolerance)
           .range({0, 1, true})
           .otherwise("that of `effort`: 1, 0.2 or 1e-3")
           .shown_as<SolverSettings>(
               [](const SolverSettings& solver) { return schema::real(solver.error_tolerance()); })
           .shown_if<SolverSettings>([](const SolverSettings& solver) {
             return solver.tolerance.has_value() || solver.effort_keys.empty();
           })
           .means(
               "a step has converged when its estimated error, as displacement, is at most this share of the "
               "displacement that the present accelerations cause in a step"),
       schema::number("linear_tolerance", &SolverSettings::linear_tolerance)
           .range({1e-16, 0.5, false})
           .means("relative residual of the linear solve of `linearly_implicit_euler`")});
  return table;
}

schema::Key pair_key() {
  Key key =
      schema::custom<ContactSettings>(
          "pair", {Type::tables},
          [](const Key& k, const TomlTable& contact, ContactSettings& settings) {
            for (const TomlValue& value : *contact.array(k.name, "tables, [[contact.pair]]")) {
              const std::string title = fmt::format("[[contact.pair]] {}", settings.pairs.size());
              contact_pair_table().read(contact_pair_table().open(value, title),
                                        settings.pairs.emplace_back());
            }
          },
          [](const Key& k, const ContactSettings& settings, TomlValue& out) {
            TomlValue pairs = schema::list({});
            for (const ContactPairSettings& pair : settings.pairs)
              pairs.items.push_back(contact_pair_table().write(pair));
            schema::append(out, k.name, std::move(pairs));
          })
          .shown_if<ContactSettings>([](const ContactSettings& contact) { return !contact.pairs.empty(); })
          .means("how two of them meet, in place of what they say of themselves");
  key.table = contact_pair_table;
  key.check = [](const Key&, const void* s, const schema::Subject&) {
    for (const ContactPairSettings& pair : static_cast<const ContactSettings*>(s)->pairs)
      contact_pair_table().check(pair, schema::Subject("[[contact.pair]]", pair.place));
  };
  return key;
}

const schema::Table& contact_table() {
  static const schema::Table table = schema::table_of<ContactSettings>(
      "[contact]",
      {schema::number("distance", &ContactSettings::distance)
           .unit("m")
           .range({1e-9, 1e6, false})
           .steady(steady_distance)
           .otherwise("see below")
           .shown_as<ContactSettings>([](const ContactSettings& contact) {  // null where the bodies decide
             return contact.distance ? schema::real(*contact.distance) : schema::null();
           })
           .means("contact distance: surfaces repel each other where the gap is below it"),
       schema::number("friction", &ContactSettings::friction)
           .range({0, 100, false})
           .varies(&ContactSettings::variations, {.keyframes = true})
           .means("Coulomb's coefficient of each body and collider without its own `friction`"),
       schema::word("tangled", &ContactSettings::tangled, {"refuse", "repair", "ignore"})
           .means(
               "a start at which surfaces cross: `\"refuse\"` it · `\"repair\"` it before the first frame · "
               "`\"ignore\"`: leave them free of each other until they part"),
       pair_key()});
  return table;
}

const schema::Table& probe_table() {
  static const schema::Table table = schema::table_of<ProbeSettings>(
      "[[probe]]", {name_key<ProbeSettings>("`probe0`, `probe1`, …").means("name in `probes.csv`"),
                    schema::text("body", &ProbeSettings::body)
                        .otherwise("the only body")
                        .means("must be given if there are several"),
                    schema::vector("at", &ProbeSettings::at)
                        .unit("m")
                        .required()
                        .means("a point of the body or collider at the start, which moves with it")});
  return table;
}

/// Warns of settings that the integrator does not use.
void warn_of_unused(const TomlTable& table, Scene& scene) {
  const SolverSettings& solver = scene.solver;
  const Integrator integrator = solver.integrator;
  const bool newton = integrator == Integrator::implicit_euler || integrator == Integrator::bdf2;
  const bool linear = integrator == Integrator::linearly_implicit_euler;
  const bool adaptive = !scene.time.steps_per_frame;
  const std::string& name = name_of(integrator_names(), integrator);
  const auto warn = [&](const char* key, const std::string& effect, const std::string& remedy) {
    if (table.has(key))
      scene.warnings.push_back(
          fmt::format("[solver] `{}` has no effect on {}: remove it, {}", key, effect, remedy));
  };
  if (!linear) warn("linear_tolerance", name, "or choose `integrator = \"linearly_implicit_euler\"`");
  if (newton) return;
  const std::string choose = "or choose `integrator = \"implicit_euler\"` or `\"bdf2\"`";
  warn("tolerance", name, choose);
  if (!linear) warn("effort", name, choose);
  // With linearly_implicit_euler an effort has one effect: automatic steps of drafts are longer.
  if (linear && !adaptive)
    warn("effort", name + " with a number of `steps_per_frame`",
         "set `steps_per_frame = \"auto\"`, " + choose);
  if (linear && adaptive && solver.effort == Effort::exact) warn("effort", name + " but for drafts", choose);
}

void finish_body(const TomlTable& table, std::size_t, BodySettings& body, Scene& scene) {
  complete_name(table, std::filesystem::path(body.mesh).stem().string(), body.name);
  const BodyKind& kind = kind_of(body);
  if (kind.finish != nullptr) kind.finish(table, scene.file.parent_path(), body, scene.warnings);
  require_new_name(table, scene.bodies, "body", "body", body.name);
}

void finish_collider(const TomlTable& table, std::size_t index, ColliderSettings& collider,
                     const Scene& scene) {
  const std::string stem = std::filesystem::path(collider.mesh).stem().string();
  const std::string numbered = fmt::format("{}{}", name_of(collider.shape), index);
  complete_name(table, stem.empty() ? numbered : stem, collider.name);
  require_new_name(table, scene.bodies, "body", "collider", collider.name);
  require_new_name(table, scene.colliders, "collider", "collider", collider.name);
}

void finish_probe(const TomlTable& table, std::size_t index, ProbeSettings& probe, const Scene& scene) {
  complete_name(table, fmt::format("probe{}", index), probe.name);
  if (!table.has("body") || !is_rigid(scene, probe.body)) resolve_body(table, scene, false, probe.body);
  require_new_name(table, scene.probes, "probe", "probe", probe.name);
}

schema::Table declare_scene() {
  return schema::table_of<Scene>(
      "scene", {schema::text("title", &Scene::title)
                    .otherwise("the file's name")
                    .may_change_on_resume()
                    .means("name for the reader"),
                schema::section("time", &Scene::time, time_table, schema::nothing)
                    .otherwise("see below")
                    .means("duration, frames and time steps"),
                schema::section("solver", &Scene::solver, solver_table, warn_of_unused)
                    .may_change_on_resume()
                    .otherwise("see below")
                    .means("integrator and accuracy"),
                schema::sections("body", &Scene::bodies, body_table, finish_body)
                    .otherwise("at least one, or a collider with a density")
                    .means("the simulated bodies"),
                schema::sections("collider", &Scene::colliders, collider_table, finish_collider)
                    .means("obstacles and rigid bodies"),
                schema::section("contact", &Scene::contact, contact_table,
                                [](const TomlTable&, Scene& scene) {
                                  scene.contact.given = true;
                                  check_contact_pairs(scene);
                                })
                    .may_change_on_resume()
                    .otherwise("see below")
                    .means("contact distance and friction"),
                schema::sections("pin", &Scene::pins, pin_table, finish_pin)
                    .may_change_on_resume()
                    .means("prescribed vertices"),
                schema::sections("force", &Scene::forces, force_table, finish_force)
                    .may_change_on_resume()
                    .means("gravity, point forces, wind; without a gravity force there is no gravity"),
                schema::sections("pressure", &Scene::pressures, pressure_table, finish_pressure)
                    .may_change_on_resume()
                    .means("pressures inside shells"),
                schema::sections("attachment", &Scene::attachments, attachment_table, finish_attachment)
                    .may_change_on_resume()
                    .means("vertices held to points of other bodies"),
                schema::sections("probe", &Scene::probes, probe_table, finish_probe)
                    .may_change_on_resume()
                    .means("points whose path is written to `probes.csv`")});
}

}  // namespace

const schema::Table& scene_table() {
  static const schema::Table table = declare_scene();
  return table;
}

}  // namespace muslin
