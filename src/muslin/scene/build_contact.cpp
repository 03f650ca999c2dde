#include "muslin/scene/build_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "muslin/contact/contact_candidates.hpp"
#include "muslin/contact/contact_energy.hpp"
#include "muslin/contact/contact_model.hpp"
#include "muslin/contact/crossings.hpp"
#include "muslin/scene/build_contact_rules.hpp"
#include "muslin/scene/joint_exemptions.hpp"
#include "muslin/schema/over_time.hpp"

namespace muslin {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double size_share = 1.0 / 500, edge_share = 0.2;  // of d̂
/// With the least stiffness this share of its points carries the body's weight at half the range.
constexpr double carrying_share = 0.1, gravity = 9.81;
constexpr double floor_share = 0.005;  // of the gap floor, in d̂
/// Bodies at rest have a gap of a little less than d̂. Below this share of it contact pushes them apart.
constexpr double pressed_share = 0.9;

class ContactBuilder {
 public:
  explicit ContactBuilder(Model& model) : model_(model), scene_(model.scene) {}

  void build() {
    if (!wanted()) return;
    if (scene_.solver.integrator == Integrator::symplectic_euler) {
      throw Error(ErrorKind::input, scene_.contact.given ? scene_.contact.place : Place{scene_.file.string()},
                  "symplectic_euler does not support contact", "choose an implicit integrator");
    }
    prescribed_.assign(model_.vertex_count(), 0);
    groups_.assign(model_.vertex_count(), -1);
    for (const Component& component : model_.bodies)
      if (const std::optional<ContactPart> part = component.contact_part()) add(component, *part);
    if (!can_touch()) return;
    finish();
  }

 private:
  bool wanted() const {
    return scene_.contact.given || model_.bodies.size() > 1 ||
           std::any_of(model_.bodies.begin(), model_.bodies.end(),
                       [](const Component& component) { return component.is_collider(); });
  }

  bool can_touch() const {
    for (std::size_t a = 0; a < bodies_.size(); ++a) {
      if (!bodies_[a].fixed && bodies_[a].self_contact) return true;
      for (std::size_t b = 0; b < a; ++b)
        if (!(bodies_[a].fixed && bodies_[b].fixed)) return true;
    }
    return false;
  }

  /// Appends a component's surface, its points and vertices counted within the model.
  void add(const Component& component, const ContactPart& part) {
    const int first_vertex = component.first_vertex, first_point = static_cast<int>(rest_.size());
    const auto first_entry = static_cast<int>(entries_.size());
    for (const SurfaceMap::Entry& entry : part.entries)
      entries_.push_back({first_vertex + entry.vertex, entry.weight});
    for (std::size_t p = 0; p < part.rest.size(); ++p) {
      offsets_.push_back(first_entry + part.offsets[p + 1]);
      body_of_point_.push_back(static_cast<int>(bodies_.size()));
    }
    append(part.varying.friction, part.rest.size(), varying_.friction);
    append(part.varying.radius, part.rest.size(), varying_.radius);
    rest_.insert(rest_.end(), part.rest.begin(), part.rest.end());
    for (const Vec3i& triangle : part.triangles)
      triangles_.emplace_back(triangle + Vec3i::Constant(first_point));
    faces_.insert(faces_.end(), part.faces.begin(), part.faces.end());
    for (ContactPlane plane : part.planes) {
      plane.point += first_point;
      if (plane.turns())
        for (int& point : plane.span) point += first_point;
      planes_.push_back(plane);
    }
    ContactBody body = part.body;
    const double range = std::min(part.size > 0 ? size_share * part.size : infinite, edge_share * part.edge);
    if (!scene_.contact.distance && std::isfinite(range)) body.range = range;
    for (int& vertex : body.frame)
      if (vertex >= 0) vertex += first_vertex;
    bodies_.push_back(body);
    names_.push_back(component.name);
    weights_.push_back(gravity * component.statistics.mass /
                       static_cast<double>(std::max<std::size_t>(part.rest.size(), 1)));
    if (body.fixed) std::fill_n(prescribed_.begin() + first_vertex, component.vertex_count, 1);
    if (!component.deforms())
      std::fill_n(groups_.begin() + first_vertex, component.vertex_count, group_count_++);
    largest_ = std::max(largest_, part.size);
    shortest_edge_ = std::min(shortest_edge_, part.edge);
    if (!part.warning.empty()) model_.warnings.push_back(part.warning);
  }

  /// Appends the numbers of the next `count` points, or −1 where they have none, to those of all points.
  template <class Number>
  void append(const std::vector<Number>& numbers, std::size_t count, std::vector<Number>& to) const {
    if (numbers.empty() && to.empty()) return;
    to.resize(rest_.size(), -1.0);
    to.insert(to.end(), numbers.begin(), numbers.end());
    to.resize(rest_.size() + count, -1.0);
  }

  void finish() {
    const auto model = std::make_shared<ContactModel>();
    model->distance =
        scene_.contact.distance.value_or(std::min(size_share * largest_, edge_share * shortest_edge_));
    model->friction = *schema::over_time(scene_.contact.variations, "friction", scene_.contact.friction);
    model->limits.prescribed = std::move(prescribed_);
    model->limits.groups = std::move(groups_);
    model->rest = std::move(rest_);
    model->names = std::move(names_);
    model->faces = std::move(faces_);
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      const double range = bodies_[b].range.value_or(model->distance);
      const double force = -contact_law(0.5 * range, range).slope;
      const double carrying = weights_[b] / (carrying_share * force);
      bodies_[b].stiffness = std::max(bodies_[b].stiffness, carrying);
    }
    model->map =
        std::make_shared<SurfaceMap>(is_identity() ? SurfaceMap::identity(model_.vertex_count())
                                                   : SurfaceMap(model_.vertex_count(), offsets_, entries_));
    ContactRules rules = build_contact_rules(model_, {model->names, body_of_point_, *model->map});
    model->surface =
        std::make_shared<ContactSurface>(std::move(triangles_), std::move(body_of_point_), std::move(bodies_),
                                         std::move(planes_), std::move(rules), std::move(varying_));
    model->limits.gap_floor = floor_share * model->surface->ranges(model->distance)[0];
    if (!model_.attachments.empty()) model->exempt = exemptions_at_joints(model_, *model);
    model_.contact = model;
  }

  /// True if the points are the vertices, in order: only shells.
  bool is_identity() const {
    if (entries_.size() != model_.vertex_count() || offsets_.size() != entries_.size() + 1) return false;
    for (std::size_t i = 0; i < entries_.size(); ++i)
      if (entries_[i].vertex != static_cast<int>(i) || entries_[i].weight != 1) return false;
    return true;
  }

  Model& model_;
  const Scene& scene_;
  std::vector<Vec3i> triangles_;
  std::vector<int> faces_;
  std::vector<std::string> names_;
  std::vector<int> body_of_point_, offsets_ = {0};
  std::vector<SurfaceMap::Entry> entries_;
  std::vector<Vec3> rest_;
  std::vector<ContactBody> bodies_;
  std::vector<double> weights_;  ///< of bodies, by point [N]
  std::vector<ContactPlane> planes_;
  ContactPointNumbers varying_;
  std::vector<std::uint8_t> prescribed_;
  std::vector<int> groups_;
  int group_count_ = 0;
  double largest_ = 0, shortest_edge_ = infinite;
};

/// Warns of bodies that contact pushes apart as soon as the run starts. Bodies that cross or are closer than
/// their thickness are left out: they are errors of their own (find_crossings). Of pairs within a body the
/// range is smaller than the gap at rest.
void warn_of_pressed_start(Model& model) {
  const ContactModel& contact = *model.contact;
  if (!(contact.distance > 0)) return;
  const ContactSurface& surface = *contact.surface;
  ContactCandidates candidates(contact.surface, contact.rest, contact.distance);
  candidates.ignore_pairs({}, contact.exempt);
  candidates.apply_rules(surface.rules().in_force(0));
  candidates.update(contact.rest, contact.rest, 0);
  struct Gap {
    double size, range;
  };
  std::map<std::pair<int, int>, Gap> gaps;  // the smallest, by bodies
  for (const ContactPair& pair : candidates.pairs()) {
    const int first = surface.body_of(pair.points[0]);
    const int second = surface.body_of(pair.points[static_cast<std::size_t>(pair.point_count() - 1)]);
    if (first == second) continue;
    const double gap = pair_geometry(surface, pair, contact.rest).distance - pair.thickness;
    if (gap >= pressed_share * pair.range) continue;
    const auto [at, is_new] = gaps.try_emplace(std::minmax(first, second), Gap{gap, pair.range});
    if (!is_new && gap < at->second.size) at->second = {gap, pair.range};
  }
  if (gaps.empty()) return;
  for (const Crossing& crossing : find_crossings(contact, model.rest_positions))
    gaps.erase(std::minmax(crossing.first_body, crossing.second_body));
  if (gaps.empty()) return;
  const auto closest = std::min_element(
      gaps.begin(), gaps.end(), [](const auto& a, const auto& b) { return a.second.size < b.second.size; });
  const auto name = [&](int body) { return contact.names[static_cast<std::size_t>(body)]; };
  std::string others;
  if (gaps.size() > 1) others = fmt::format(" (the closest of {} such pairs)", gaps.size());
  model.warnings.push_back(fmt::format(
      "\"{}\" and \"{}\" start with a gap of {:.3g} m{}, and contact, which acts within {:.3g} m, pushes "
      "them apart at once; set `contact.distance` below the gap, or move them apart",
      name(closest->first.first), name(closest->first.second), closest->second.size, others,
      closest->second.range));
}

/// Warns of colliders that jump, by their motion from frame to frame.
void warn_of_jumps(Model& model) {
  for (const Component& component : model.bodies) {
    const Prescribed* motion = component.is_prescribed() ? component.motion() : nullptr;
    if (motion == nullptr || !motion->moves()) continue;
    const double frame = 1 / model.scene.time.frame_rate;
    std::vector<Vec3> x(motion->start.size());
    const auto middle = [&](double time) {
      motion->positions(time, x);
      return Vec3(std::accumulate(x.begin(), x.end(), Vec3(Vec3::Zero())) / static_cast<double>(x.size()));
    };
    double fastest = 0, when = 0;
    Vec3 last = middle(0);
    for (int f = 1; f <= model.scene.time.frames(); ++f) {
      const Vec3 now = middle(f * frame);
      if (const double speed = (now - last).norm() / frame; speed > fastest) {
        fastest = speed;
        when = (f - 1) * frame;
      }
      last = now;
    }
    if (fastest > jump_speed)
      model.warnings.push_back(
          fmt::format("\"{}\" moves at {:.3g} m/s at {:.3g} s; where it is faster than {:.3g} m/s relative "
                      "to all bodies it "
                      "passes through what is in its way",
                      component.name, fastest, when, jump_speed));
  }
}

}  // namespace

void build_contact(Model& model) {
  ContactBuilder(model).build();
  if (!model.contact) return;
  warn_of_pressed_start(model);
  warn_of_jumps(model);
}

}  // namespace muslin
