#include "muslin/scene/attachment.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "muslin/component/body_maps.hpp"
#include "muslin/component/select.hpp"
#include "muslin/constraint/attachment.hpp"
#include "muslin/core/nearest_name.hpp"
#include "muslin/geometry/closest_point.hpp"
#include "muslin/potential/stopping_time.hpp"
#include "muslin/scene/common_keys.hpp"
#include "muslin/scene/model.hpp"
#include "muslin/scene/selection_table.hpp"
#include "muslin/schema/declare.hpp"
#include "muslin/schema/over_time.hpp"

namespace muslin {
namespace {

using Settings = AttachmentSettings;

static_assert(static_cast<int>(Settings::Rest::cord) == static_cast<int>(AttachmentRules::Rest::cord));

/// A stiff joint of a rigid body, in units of mass/stopping_time²: the weight of the body stretches it by
/// g stopping_time²/100, 2 µm.
constexpr double rigid_share = 100;
/// A stiff joint of a soft body, in units of mass/step² with the largest stable step: a sixteenth of the
/// bound of a vertex's stiffness, and about the stiffness of the elements around it. Stiffer joints make
/// steps of normal effort leave more work unbalanced.
constexpr double soft_share = 0.25;

schema::Table declare_attachment() {
  schema::Table table = schema::table_of<Settings>(
      "[[attachment]]",
      {name_key<Settings>("`attachment0`, `attachment1`, …")
           .means("name in messages and in `attachments.csv`"),
       schema::text("body", &Settings::body)
           .otherwise("the only body")
           .means("a body, or a collider with a density; must be given if there are several"),
       schema::nested("where", &Settings::where, selection_table)
           .otherwise("must be given")
           .means("selection of its vertices; for a collider with a density those of its mesh"),
       schema::text("to", &Settings::to).required().means("the body or collider that they are attached to"),
       schema::nested("where_to", &Settings::where_to, selection_table)
           .otherwise("the nearest point of the surface of `to`")
           .means("selection of vertices of `to`: each vertex is attached to the nearest one"),
       schema::vector("at", &Settings::at)
           .unit("m")
           .excludes("where_to", "`at` and `where_to` both choose points")
           .means("a point of `to` at the start, in place of `where_to`: all are attached to this one"),
       schema::word("rest", &Settings::rest, {"joined", "distance", "cord"})
           .means("`\"joined\"`: the points are pulled together · `\"distance\"`: they keep the distance "
                  "that they "
                  "have when it begins · `\"cord\"`: they come no farther apart than that"),
       schema::number("stiffness", &Settings::stiffness)
           .unit("N/m")
           .range({0, 1e9, false})
           .varies(&Settings::variations, {.keyframes = true})
           .otherwise("stiff: that of the material around each point")
           .means("of the whole attachment; each vertex has a share by its mass"),
       schema::number("damping", &Settings::damping)
           .unit("N·s/m")
           .range({0, 1e9, false})
           .varies(&Settings::variations, {.keyframes = true})
           .means("of the whole attachment, against relative motion of the points"),
       schema::number("break_force", &Settings::break_force)
           .unit("N")
           .range({0, 1e12, true})
           .varies(&Settings::variations, {.keyframes = true})
           .otherwise("it never breaks")
           .means("of the whole attachment: a vertex whose force exceeds its share is free from then on"),
       schema::number("weight", &Settings::weight)
           .range(Range::between(0, 1))
           .varies(&Settings::variations, {.map = true})
           .means(
               "at each selected vertex, as a factor of stiffness, damping and breaking force; where it is "
               "0 the vertex is not attached")});
  for (schema::Key& key :
       window_keys(&Settings::from, &Settings::until, "start time", "release time, after `from`", "never"))
    table.keys.push_back(key);
  schema::add_rule<Settings>(table, [](const Settings& s, const schema::Subject& subject) {
    check_window(s.from, s.until, subject);
    if (const auto stiffness = schema::over_time(s.variations, "stiffness", s.stiffness);
        stiffness && stiffness->greatest() == 0)
      throw subject.error("stiffness", "an attachment of `stiffness` 0 holds nothing",
                          "give a number above 0, at one keyframe at least, or leave it out for a stiff one");
    if (s.to == s.body && !s.where_to && !s.at)
      throw subject.error("to", fmt::format("`{}` is attached to its own nearest points", s.body),
                          "name another body, or choose points by `where_to` or `at`");
  });
  return table;
}

/// A number over time as its greatest value and a factor; without a number `otherwise` at all times.
struct Scaled {
  Scaled(const Settings& settings, const char* key, std::optional<double> number, double otherwise) {
    const auto over_time = schema::over_time(settings.variations, key, number);
    greatest = over_time ? over_time->greatest() : otherwise;
    if (!over_time || greatest == 0) return;
    factor = *over_time;
    for (KeyedNumber::Key& each : factor.keys) each.value /= greatest;
  }
  double greatest = 0;
  KeyedNumber factor = 1;
};

/// A point of a component.
struct JointPoint {
  std::vector<Joints::Weight> weights;  ///< of vertices of the model
  Vec3 place = Vec3::Zero();            ///< at the start [m]
  double mass = 0;                      ///< [kg]; 0: forces do not move it
};

class AttachmentBuilder {
 public:
  AttachmentBuilder(Model& model, const Settings& settings)
      : model_(model),
        settings_(settings),
        what_("attachment " + settings.name),
        stiffness_over_time_(settings, "stiffness", settings.stiffness, 0),
        damping_(settings, "damping", settings.damping, 0),
        strength_(settings, "break_force", settings.break_force, std::numeric_limits<double>::infinity()),
        body_(model.body(settings.body)),
        to_(model.body(settings.to)) {}

  void build() {
    if (model_.scene.solver.integrator == Integrator::symplectic_euler)
      fail("symplectic_euler does not support attachments", "choose an implicit integrator");
    const std::vector<int> selected = select_vertices(body_, settings_.where, what_);
    const std::vector<JointPoint> others = settings_.where_to
                                               ? points(to_, select_vertices(to_, *settings_.where_to, what_))
                                               : std::vector<JointPoint>();
    const std::vector<double> weights =
        numbers_at(settings_.variations, attachment_table(), "weight",
                   {model_.scene.file, model_.scene.meshes}, body_, selected, settings_.weight);
    const std::vector<JointPoint> firsts = points(body_, selected);
    double mass = 0;
    for (std::size_t i = 0; i < firsts.size(); ++i) {
      if (weights[i] == 0) continue;
      add(firsts[i], partner(firsts[i], others), weights[i]);
      mass += firsts[i].mass;
    }
    if (masses_.empty())
      fail("its `weight` is 0 at every vertex", "raise it somewhere, or remove the attachment");
    if (!(mass > 0)) fail(fmt::format("body `{}` has no mass there", body_.name), "attach another body");
    share(mass);
    warn_of_stiffness();
    warn_of_breaking();
    const AttachmentRules rules{static_cast<AttachmentRules::Rest>(settings_.rest),
                                settings_.from,
                                settings_.until,
                                stiffness_over_time_.factor,
                                damping_.factor,
                                strength_.factor};
    const auto springs = std::make_shared<const Attachment>(settings_.name, rules, joints_);
    model_.loads.push_back({settings_.name, EnergyRole::joint, springs});
    if (damping_.greatest > 0)
      model_.loads.push_back({settings_.name + ": damping", EnergyRole::dissipation,
                              std::make_shared<AttachmentDamping>(springs)});
    model_.attachments.push_back({settings_.name,
                                  springs,
                                  {model_.bodies.index_of(body_), model_.bodies.index_of(to_)},
                                  std::move(places_)});
  }

 private:
  [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const {
    throw Error(ErrorKind::input, settings_.place,
                fmt::format("[[attachment]] `{}`: {}", settings_.name, problem), remedy);
  }

  JointPoint weigh(const Component& component, const Embedding& embedding, std::size_t p,
                   const Vec3& place) const {
    JointPoint point;
    point.place = place;
    for (std::size_t s = 0; s < 8; ++s) {
      const double weight = embedding.weights[p][s];
      if (weight == 0) continue;
      const int vertex = component.first_vertex + embedding.vertices[p][s];
      point.weights.push_back({vertex, weight});
      point.mass += std::abs(weight) * model_.masses[static_cast<std::size_t>(vertex)];
    }
    return point;
  }

  /// Returns selectable points of a component.
  std::vector<JointPoint> points(const Component& component, const std::vector<int>& selected) const {
    std::vector<JointPoint> all;
    for (const int i : selected) {
      const auto p = static_cast<std::size_t>(i);
      const Vec3 place = component.selectable(p);
      if (!component.selects_vertices()) {
        all.push_back(weigh(component, component.skin, p, place));
        continue;
      }
      const int vertex = component.first_vertex + i;
      all.push_back({{{vertex, 1}}, place, model_.masses[static_cast<std::size_t>(vertex)]});
    }
    return all;
  }

  /// Returns the point of the other body that a point is attached to.
  JointPoint partner(const JointPoint& point, const std::vector<JointPoint>& others) {
    if (!others.empty()) {
      return *std::min_element(others.begin(), others.end(), [&](const JointPoint& a, const JointPoint& b) {
        return (a.place - point.place).squaredNorm() < (b.place - point.place).squaredNorm();
      });
    }
    const Vec3 at = settings_.at ? *settings_.at : nearest(point.place);
    const AttachedPoint attached = to_.attach(at);
    if (!attached.warning.empty() && places_.empty())
      model_.warnings.push_back(
          fmt::format("{}: {} {}", what_, settings_.at ? "`at`" : "a point", attached.warning));
    Vec3 place = Vec3::Zero();
    for (std::size_t s = 0; s < 8; ++s)
      place += attached.point.weights[0][s] *
               to_.rest_position(static_cast<std::size_t>(attached.point.vertices[0][s]));
    return weigh(to_, attached.point, 0, place);
  }

  Vec3 nearest(const Vec3& place) {
    if (!surface_) {
      triangles_ = triangulate(to_.mesh).triangles;
      surface_.emplace(to_.mesh.positions, triangles_);
    }
    return (*surface_)(place).point;
  }

  void add(const JointPoint& first, const JointPoint& second, double weight) {
    if (second.mass == 0) require_free(first);
    joints_->add_points(first.weights, second.weights);
    if (joints_->weights.size() == joints_->offsets[joints_->offsets.size() - 2])
      fail("a vertex is attached to itself", "choose other points by `where_to`");
    masses_.push_back(first.mass);
    weights_.push_back(weight);
    stiffness_.push_back(std::min(material(body_, first), material(to_, second)));
    places_.push_back({first.place, second.place});
  }

  /// Refuses a point that a pin holds all the time, and whose partner no force moves either.
  void require_free(const JointPoint& point) const {
    for (const Pin& pin : model_.pins) {
      if (pin.is_soft() || pin.from > settings_.from || pin.until < settings_.until) continue;
      if (!std::binary_search(pin.vertices.begin(), pin.vertices.end(), point.weights.front().vertex))
        continue;
      fail(fmt::format(
               "pin `{}` holds a vertex of `{}` that is attached to `{}`, which forces do not move either",
               pin.name, body_.name, to_.name),
           "select vertices that are free, or take the pin out");
    }
  }

  /// Returns the stiffness of a stiff joint at a point.
  static double material(const Component& component, const JointPoint& point) {
    if (point.mass == 0) return std::numeric_limits<double>::infinity();
    const double step = component.statistics.undamped_step;
    return std::isfinite(step) ? soft_share * point.mass / (step * step)
                               : rigid_share * point.mass / (stopping_time * stopping_time);
  }

  /// Sets the greatest constants of the joints, which share those of the attachment by the masses of their
  /// points, times their weights.
  void share(double mass) {
    for (std::size_t j = 0; j < masses_.size(); ++j) {
      const double share = weights_[j] * masses_[j] / mass;
      joints_->stiffness.push_back(settings_.stiffness ? stiffness_over_time_.greatest * share
                                                       : weights_[j] * stiffness_[j]);
      joints_->damping.push_back(damping_.greatest * share);
      joints_->strength.push_back(strength_.greatest * share);
    }
  }

  /// Steps do not resolve the forces of joints that are stiffer than the bodies around them.
  void warn_of_stiffness() {
    if (model_.scene.solver.effort_at(0) == Effort::exact) return;
    constexpr double bound = 4 / soft_share;  // of the stiffness of a vertex, over that of a stiff joint
    double worst = 0;
    for (std::size_t j = 0; j < masses_.size(); ++j) {
      const double resisted = joints_->stiffness[j] + joints_->damping[j] * model_.scene.time.frame_rate;
      if (std::isfinite(stiffness_[j])) worst = std::max(worst, resisted / (bound * stiffness_[j]));
    }
    if (worst > 1)
      model_.warnings.push_back(fmt::format(
          "{}: it is {:.2g} times as stiff as the bodies it joins, so that its force is only accurate at "
          "effort "
          "exact; lower `stiffness` and `damping`, or leave them out for joints as stiff as the bodies",
          what_, worst));
  }

  /// Points that are joined start with a gap if the meshes do.
  void warn_of_breaking() {
    if (settings_.rest != Settings::Rest::joined) return;
    const double stiffness = stiffness_over_time_.factor.at(settings_.from),
                 strength = strength_.factor.at(settings_.from);
    std::size_t count = 0;
    double widest = 0;
    for (std::size_t j = 0; j < places_.size(); ++j) {
      const double gap = (places_[j][0] - places_[j][1]).norm();
      if (stiffness * joints_->stiffness[j] * gap <= strength * joints_->strength[j]) continue;
      ++count;
      widest = std::max(widest, gap);
    }
    if (count == 0) return;
    model_.warnings.push_back(
        fmt::format("{}: {} of {} joints break at once, as they pull points together that are up to {:.3g} m "
                    "apart; start without "
                    "gaps, or give `stiffness`, a larger `break_force`, or `rest = \"distance\"`",
                    what_, count, places_.size(), widest));
  }

  Model& model_;
  const Settings& settings_;
  std::string what_;
  Scaled stiffness_over_time_, damping_, strength_;
  const Component &body_, &to_;
  std::shared_ptr<Joints> joints_ = std::make_shared<Joints>();
  std::vector<double> masses_, weights_, stiffness_;  // by joint
  std::vector<std::array<Vec3, 2>> places_;
  std::vector<Vec3i> triangles_;
  std::optional<ClosestPointQuery> surface_;  // of `to`
};

}  // namespace

const schema::Table& attachment_table() {
  static const schema::Table table = declare_attachment();
  return table;
}

void finish_attachment(const TomlTable& table, std::size_t index, AttachmentSettings& attachment,
                       const Scene& scene) {
  complete_name(table, fmt::format("attachment{}", index), attachment.name);
  resolve_body(table, scene, false, attachment.body);
  if (!table.has("where")) refuse_without_selection(table);
  const std::vector<std::string> names = all_names(scene);
  if (std::find(names.begin(), names.end(), attachment.to) == names.end())
    throw table.error("to", fmt::format("there is no body or collider `{}`", attachment.to),
                      name_advice(attachment.to, names));
  require_new_name(table, scene.attachments, "attachment", "attachment", attachment.name);
}

void build_attachments(Model& model) {
  for (const AttachmentSettings& settings : model.scene.attachments)
    AttachmentBuilder(model, settings).build();
}

}  // namespace muslin
