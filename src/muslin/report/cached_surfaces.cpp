#include "muslin/report/cached_surfaces.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <Eigen/Cholesky>

#include "muslin/contact/contact_candidates.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/index.hpp"
#include "muslin/geometry/mesh.hpp"
#include "muslin/geometry/weld.hpp"

namespace muslin {
namespace {

std::vector<Vec3> in_double(const std::vector<Vec3f>& points) {
  std::vector<Vec3> result;
  for (const Vec3f& p : points) result.push_back(p.cast<double>());
  return result;
}

/// The affine map that takes `from` to `to`, by least squares. A rigid motion is found to rounding.
class Placement {
 public:
  Placement(ConstVectors from, ConstVectors to) {
    for (std::size_t i = 0; i < from.size(); ++i) from_ += from[i], to_ += to[i];
    from_ /= static_cast<double>(from.size());
    to_ /= static_cast<double>(from.size());
    Mat3 moment = Mat3::Zero(), mixed = Mat3::Zero();
    for (std::size_t i = 0; i < from.size(); ++i) {
      moment += (from[i] - from_) * (from[i] - from_).transpose();
      mixed += (to[i] - to_) * (from[i] - from_).transpose();
    }
    linear_ = moment.ldlt().solve(mixed.transpose()).transpose();
  }
  Vec3 operator()(const Vec3& point) const { return to_ + linear_ * (point - from_); }

 private:
  Vec3 from_ = Vec3::Zero(), to_ = Vec3::Zero();
  Mat3 linear_ = Mat3::Identity();
};

/// The middle of a patch of a plane, and two points beside it on its outer side.
std::array<Vec3, 3> points_of_plane(ConstVectors corners) {
  const Vec3 middle = (corners[0] + corners[1] + corners[2] + corners[3]) / 4;
  const Vec3 across = (corners[1] - corners[0]).normalized(), up = (corners[3] - corners[0]).normalized();
  return {middle, middle + across, middle + up};
}

/// A plane has three points here, and may have had one in the run. Returns how many were added before a point
/// of the run.
int points_added_before(const ContactRecord& record, int point) {
  constexpr std::size_t of_plane = 3;
  std::size_t seen = 0, added = 0;
  for (const ContactRecord::Body& body : record.bodies) {
    seen += body.points;
    if (seen > static_cast<std::size_t>(point)) break;
    if (body.points < of_plane && body.axis.empty()) added += of_plane - body.points;
  }
  return static_cast<int>(added);
}

}  // namespace

CachedSurfaces::CachedSurfaces(const RunReader& run, const ContactRecord& record) : run_(run) {
  std::vector<Vec3i> triangles;
  std::vector<int> body_of_point;
  std::vector<ContactBody> bodies;
  std::vector<ContactPlane> planes;
  ContactPointNumbers varying;
  for (const ContactRecord::Body& body : record.bodies) {
    const int place = run.find_body(body.name), first = static_cast<int>(body_of_point.size());
    const Mesh& skin = run.mesh(place, SurfaceKind::skin);
    const auto owner = static_cast<int>(bodies.size());
    std::vector<Vec3> rest = skin.positions;
    origins_.emplace_back();
    if (!body.axis.empty()) {
      rest = body.axis;
      const int last = first + static_cast<int>(rest.size()) - 1;
      triangles.emplace_back(first, last, last);
      contact_.faces.push_back(-1);
    } else if (run.is_plane(place)) {
      const std::array<Vec3, 3> points = points_of_plane(skin.positions);
      rest.assign(points.begin(), points.end());
      ContactPlane plane;
      plane.point = first;
      plane.span = {first + 1, first + 2};
      planes.push_back(plane);
    } else {
      // A mesh that was welded, or had loose vertices, has more points in the caches.
      ReducedMesh surface{skin, {}, {}};
      if (body.points != rest.size()) surface = weld(skin, 0);
      if (body.points != surface.mesh.vertex_count())
        throw Error(ErrorKind::input, {run.directory().string()},
                    "the surface with which \"" + body.name + "\" touches others is not in the caches",
                    "only skins can be examined");
      rest = surface.mesh.positions;
      origins_.back() = std::move(surface.origins);
      const Triangulation cut = triangulate(surface.mesh);
      for (const Vec3i& triangle : cut.triangles) triangles.emplace_back(triangle + Vec3i::Constant(first));
      contact_.faces.insert(contact_.faces.end(), cut.faces.begin(), cut.faces.end());
    }
    body_of_point.resize(body_of_point.size() + rest.size(), owner);
    if (!body.radii.empty()) {
      varying.radius.resize(contact_.rest.size(), -1.0);
      varying.radius.insert(varying.radius.end(), body.radii.begin(), body.radii.end());
    }
    contact_.rest.insert(contact_.rest.end(), rest.begin(), rest.end());
    contact_.names.push_back(body.name);
    ContactBody contact_body;
    contact_body.radius = body.radius;
    contact_body.self_contact = body.self_contact;
    contact_body.fixed = body.fixed;
    contact_body.range = body.range;
    bodies.push_back(contact_body);
    bodies_.push_back(body);
    places_.push_back(place);
  }
  contact_.exempt = record.exempt;
  for (auto* pairs : {&contact_.exempt.point_triangles, &contact_.exempt.point_planes})
    for (std::array<int, 2>& pair : *pairs) pair[0] += points_added_before(record, pair[0]);
  std::vector<ContactRule> rules = record.rules;
  for (ContactRule& rule : rules)
    for (std::vector<int>& side : rule.sides)
      for (int& point : side) point += points_added_before(record, point);
  contact_.distance = record.distance;
  contact_.map = std::make_shared<SurfaceMap>(SurfaceMap::identity(contact_.rest.size()));
  if (!varying.radius.empty()) varying.radius.resize(contact_.rest.size(), -1.0);
  contact_.surface = std::make_shared<ContactSurface>(
      std::move(triangles), std::move(body_of_point), std::move(bodies), std::move(planes),
      ContactRules(std::move(rules), contact_.rest.size()), std::move(varying));
}

std::vector<Vec3> CachedSurfaces::points(int frame) const {
  std::vector<Vec3> all;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const std::vector<Vec3> skin = in_double(run_.points(places_[b], SurfaceKind::skin, frame));
    if (run_.is_plane(places_[b])) {
      const std::array<Vec3, 3> points = points_of_plane(skin);
      all.insert(all.end(), points.begin(), points.end());
    } else if (bodies_[b].axis.empty()) {
      if (origins_[b].empty()) all.insert(all.end(), skin.begin(), skin.end());
      for (const int point : origins_[b]) all.push_back(skin[at(point)]);
    } else {
      const Placement moved(run_.mesh(places_[b], SurfaceKind::skin).positions, skin);
      for (const Vec3& point : bodies_[b].axis) all.push_back(moved(point));
    }
  }
  return all;
}

std::vector<Crossing> CachedSurfaces::crossings(int frame, ConstVectors points) const {
  std::vector<Crossing> found = find_crossings(contact_, points, time(frame));
  std::erase_if(found, [&](const Crossing& c) {
    const auto is_round = [&](int body) { return !bodies_[at(body)].axis.empty(); };
    return c.kind == Crossing::Kind::too_close && !is_round(c.first_body) && !is_round(c.second_body);
  });
  return one_of_each_pair(contact_, found);
}

std::optional<Gap> CachedSurfaces::smallest_gap(int frame, ConstVectors points) const {
  const ContactSurface& surface = *contact_.surface;
  ContactCandidates candidates(contact_.surface, contact_.rest, contact_.distance);
  candidates.ignore_pairs({}, contact_.exempt);
  candidates.apply_rules(surface.rules().in_force(time(frame)));
  candidates.update(points, points, 0);
  std::optional<Gap> smallest;
  for (const ContactPair& pair : candidates.pairs()) {
    const PairGeometry geometry = pair_geometry(surface, pair, points);
    const double size = geometry.distance - pair.thickness;
    if (size >= (smallest ? smallest->size : candidates.longest_range())) continue;
    const int last = pair.points[at(pair.point_count() - 1)];
    const auto [a, b] = std::minmax({surface.body_of(pair.points[0]), surface.body_of(last)});
    smallest = Gap{size, contact_.names[at(a)], contact_.names[at(b)],
                   visible_point(surface, pair, geometry, points)};
  }
  return smallest;
}

}  // namespace muslin
