#include "muslin/scene/build_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "muslin/contact/contact_candidates.hpp"
#include "muslin/contact/contact_energy.hpp"
#include "muslin/contact/contact_model.hpp"
#include "muslin/contact/crossings.hpp"
#include "muslin/geometry/edge_length.hpp"
#include "muslin/material/lattice_moduli.hpp"

namespace muslin {
namespace {

using Shape = ColliderSettings::Shape;

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double size_share = 1.0 / 500, edge_share = 0.2;  // of d̂
constexpr double thin = 5e-4, thin_share = 0.1;             // thickness of shells: [m], of the mean edge
constexpr double stiffness_share = 0.15;
/// With the least stiffness this share of its points carries the body's weight at half the range.
constexpr double carrying_share = 0.1, gravity = 9.81;
constexpr double floor_share = 0.005;       // of the gap floor, in d̂
/// Bodies at rest have a gap of a little less than d̂. Below this share of it contact pushes them apart.
constexpr double pressed_share = 0.9;

double lattice_stiffness(const Body& body, const BodySettings& settings) {
  const Material& m = settings.material;
  const ElasticModuli moduli = elastic_moduli(
      {m.edge_modulus, m.face_diagonal_modulus, m.body_diagonal_modulus}, settings.bracing, m.volume_modulus);
  const double width = body.lattice.width;
  // The springs of a sheet have the stiffness of its thickness, unless every voxel counts full.
  const bool thin = body.sheet && settings.mass == BodySettings::Mass::solid;
  return stiffness_share * (moduli.youngs + m.young_modulus) *
         (thin ? std::min(width, body.thickness) : width);
}

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
    for (std::size_t b = 0; b < scene_.bodies.size(); ++b)
      if (scene_.bodies[b].contact) add_body(model_.bodies[b], scene_.bodies[b]);
    for (std::size_t c = 0; c < scene_.colliders.size(); ++c)
      if (scene_.colliders[c].contact) add_collider(model_.collider(c), scene_.colliders[c]);
    if (!can_touch()) return;
    finish();
  }

 private:
  bool wanted() const {
    return !scene_.colliders.empty() || scene_.contact.given || scene_.bodies.size() > 1;
  }

  bool can_touch() const {
    for (std::size_t a = 0; a < bodies_.size(); ++a) {
      if (!bodies_[a].fixed && bodies_[a].self_contact) return true;
      for (std::size_t b = 0; b < a; ++b)
        if (!(bodies_[a].fixed && bodies_[b].fixed)) return true;
    }
    return false;
  }

  void add_body(const Body& body, const BodySettings& settings) {
    const Triangulation cut = triangulate(body.mesh);
    const double edge = mean_edge(body.mesh.positions, cut.triangles);
    ContactBody contact;
    contact.self_contact = settings.self_contact;
    contact.friction = settings.friction;
    if (body.is_shell()) {
      const ShellMaterial& m = *settings.material.shell;
      contact.radius = settings.shell_thickness.value_or(std::min(thin, thin_share * edge)) / 2;
      contact.stiffness = stiffness_share * std::sqrt(m.membrane_warp * m.membrane_weft);
    } else {
      contact.radius = body.sheet ? body.thickness / 2 : 0;
      contact.stiffness = lattice_stiffness(body, settings);
    }
    // A body without stretch resistance still needs contact to carry its weight.
    if (!(contact.stiffness > 0)) contact.mass = mean_mass(body);
    note_size(body, edge);
    add_mesh(body, cut, contact);
    if (body.has_lattice() && edge > 2 * body.lattice.width) {
      model_.warnings.push_back(
          fmt::format("body {}: contact sees its mesh, whose edges of {:.3g} m do not bend as its voxels do; "
                      "subdivide the mesh",
                      body.name, edge));
    }
  }

  /// Returns the mean mass of a vertex [kg].
  double mean_mass(const Body& body) const {
    const auto first = static_cast<std::ptrdiff_t>(body.first_vertex);
    return std::accumulate(model_.masses.begin() + first, model_.masses.begin() + first + body.vertex_count,
                           0.0) /
           body.vertex_count;
  }

  void add_collider(const Body& body, const ColliderSettings& settings) {
    ContactBody contact;
    contact.fixed = body.prescribed;
    contact.self_contact = false;
    contact.friction = settings.friction;
    contact.stiffness = infinite;
    const auto first = static_cast<std::size_t>(body.first_vertex);
    if (body.prescribed) std::fill_n(prescribed_.begin() + body.first_vertex, body.vertex_count, 1);
    if (body.is_rigid()) std::fill_n(groups_.begin() + body.first_vertex, body.vertex_count, group_count_++);
    if (!body.prescribed) {
      contact.mass = model_.masses[first];
      note_size(body, body.mean_edge);
    }
    switch (settings.shape) {
      case Shape::plane: {
        const Vec3 normal = start_of(body).linear() * settings.normal;
        ContactPlane plane = {add_point(body, body.frame.centre), normal};
        if (turns(settings.motion)) {
          // Within the corners that carry them.
          const double reach = body.frame.radii.x() / 2;
          const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
          plane.span = {add_point(body, body.frame.centre + reach * u),
                        add_point(body, body.frame.centre + reach * v)};
        }
        planes_.push_back(plane);
        break;
      }
      case Shape::sphere: {
        const int point = add_point(body, body.frame.centre);
        add_triangle(Vec3i::Constant(point), -1);
        contact.radius = settings.radius;
        contact.frame = frame_of(body);
        break;
      }
      case Shape::capsule: {
        const Eigen::Isometry3d start = start_of(body);
        const int a = add_point(body, start * settings.points[0]),
                  b = add_point(body, start * settings.points[1]);
        add_triangle({a, b, b}, -1);
        contact.radius = settings.radius;
        contact.frame = frame_of(body);
        break;
      }
      case Shape::box:
      case Shape::mesh:
        add_mesh(body, triangulate(body.mesh), contact);
        return;
    }
    finish_body(body, contact);
  }

  static bool turns(const Motion& motion) {
    return std::any_of(motion.keys.begin(), motion.keys.end(), [&](const Motion::Key& key) {
      return !key.rotate.isApprox(motion.keys.front().rotate, 1e-12);
    });
  }

  /// Returns the vertices that carry a round body, from which friction gets its rotation.
  static std::array<int, 4> frame_of(const Body& body) {
    const int first = body.first_vertex;
    return {first, first + 1, first + 2, first + 3};
  }

  /// Returns the motion of a collider from its given shape at time 0.
  Eigen::Isometry3d start_of(const Body& body) const {
    for (const Prescribed& p : model_.prescribed)
      if (p.first == body.first_vertex) return p.motion.at(0);
    return Eigen::Isometry3d::Identity();
  }

  void note_size(const Body& body, double edge) {
    largest_ = std::max(largest_, body.mesh.bounds().sizes().maxCoeff());
    shortest_edge_ = std::min(shortest_edge_, edge);
  }

  /// Adds a point of the current body.
  int add_point(const Body& body, const Vec3& at) {
    const auto weights = body.frame.weights(at);
    for (int i = 0; i < 4; ++i)
      entries_.push_back({body.first_vertex + i, weights[static_cast<std::size_t>(i)]});
    return close_point(at);
  }

  int close_point(const Vec3& at) {
    offsets_.push_back(static_cast<int>(entries_.size()));
    body_of_point_.push_back(static_cast<int>(bodies_.size()));
    rest_.push_back(at);
    return static_cast<int>(rest_.size()) - 1;
  }

  void add_triangle(const Vec3i& points, int face) {
    triangles_.push_back(points);
    faces_.push_back(face);
  }

  void finish_body(const Body& body, const ContactBody& contact) {
    bodies_.push_back(contact);
    names_.push_back(body.name);
    const auto points = std::count(body_of_point_.begin(), body_of_point_.end(), static_cast<int>(bodies_.size()) - 1);
    weights_.push_back(gravity * body.statistics.mass / static_cast<double>(std::max<std::ptrdiff_t>(points, 1)));
  }

  void add_mesh(const Body& body, const Triangulation& cut, const ContactBody& contact) {
    const int first = static_cast<int>(rest_.size());
    for (std::size_t p = 0; p < body.skin.size(); ++p) {
      // A vertex may occur twice, with weight 0.
      for (std::size_t s = 0; s < 8; ++s) {
        if (body.skin.weights[p][s] == 0) continue;
        entries_.push_back({body.first_vertex + body.skin.vertices[p][s], body.skin.weights[p][s]});
      }
      close_point(body.mesh.positions[p]);
    }
    for (std::size_t t = 0; t < cut.triangles.size(); ++t)
      add_triangle(cut.triangles[t] + Vec3i::Constant(first), cut.faces[t]);
    finish_body(body, contact);
  }

  void finish() {
    const auto model = std::make_shared<ContactModel>();
    model->distance =
        scene_.contact.distance.value_or(std::min(size_share * largest_, edge_share * shortest_edge_));
    model->friction = scene_.contact.friction;
    model->limits.gap_floor = floor_share * model->distance;
    model->limits.prescribed = std::move(prescribed_);
    model->limits.groups = std::move(groups_);
    model->rest = std::move(rest_);
    model->names = std::move(names_);
    model->faces = std::move(faces_);
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      const double force = -contact_law(0.5 * model->distance, model->distance).slope;
      const double carrying = weights_[b] / (carrying_share * force);
      bodies_[b].stiffness = std::max(bodies_[b].stiffness, carrying);
    }
    model->surface = std::make_shared<ContactSurface>(std::move(triangles_), std::move(body_of_point_),
                                                      std::move(bodies_), std::move(planes_));
    model->map =
        std::make_shared<SurfaceMap>(is_identity() ? SurfaceMap::identity(model_.vertex_count())
                                                   : SurfaceMap(model_.vertex_count(), offsets_, entries_));
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
  candidates.update(contact.rest, contact.rest, 0);
  std::map<std::pair<int, int>, double> gaps;  // the smallest, by bodies
  for (const ContactPair& pair : candidates.pairs()) {
    const int first = surface.body_of(pair.points[0]);
    const int second = surface.body_of(pair.points[static_cast<std::size_t>(pair.point_count() - 1)]);
    if (first == second) continue;
    const double gap = pair_geometry(surface, pair, contact.rest).distance - pair.thickness;
    if (gap >= pressed_share * pair.range) continue;
    const auto [at, is_new] = gaps.try_emplace(std::minmax(first, second), gap);
    if (!is_new) at->second = std::min(at->second, gap);
  }
  if (gaps.empty()) return;
  for (const Crossing& crossing : find_crossings(contact, model.rest_positions))
    gaps.erase(std::minmax(crossing.first_body, crossing.second_body));
  if (gaps.empty()) return;
  const auto closest = std::min_element(gaps.begin(), gaps.end(),
                                        [](const auto& a, const auto& b) { return a.second < b.second; });
  const auto name = [&](int body) { return contact.names[static_cast<std::size_t>(body)]; };
  std::string others;
  if (gaps.size() > 1) others = fmt::format(" (the closest of {} such pairs)", gaps.size());
  model.warnings.push_back(fmt::format(
      "\"{}\" and \"{}\" start with a gap of {:.3g} m{}, and contact, which acts within {:.3g} m, pushes "
      "them apart at once; set `contact.distance` below the gap, or move them apart",
      name(closest->first.first), name(closest->first.second), closest->second, others, contact.distance));
}

}  // namespace

void build_contact(Model& model) {
  ContactBuilder(model).build();
  if (model.contact) warn_of_pressed_start(model);
}

}  // namespace muslin
