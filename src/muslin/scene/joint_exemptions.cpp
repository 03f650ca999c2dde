#include "muslin/scene/joint_exemptions.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "muslin/constraint/attachment.hpp"
#include "muslin/contact/distance.hpp"

namespace muslin {
namespace {

constexpr double at_point = 1e-6;  // in mean edges: it is the point

class JointExemptions {
 public:
  JointExemptions(const Model& model, const ContactModel& contact)
      : model_(model), contact_(contact), surface_(*contact.surface), of_body_(contact.names.size()) {
    for (int t = 0; t < static_cast<int>(surface_.triangles().size()); ++t)
      of_body_[static_cast<std::size_t>(surface_.body_of(corners(t)[0]))].push_back(t);
  }

  ContactExemptions find() {
    for (const Attached& attached : model_.attachments) {
      const Component &first = model_.bodies[static_cast<std::size_t>(attached.bodies[0])],
                      &second = model_.bodies[static_cast<std::size_t>(attached.bodies[1])];
      const int a = surface_of(first), b = surface_of(second);
      if (a < 0 || b < 0) continue;
      const double touching = radius(a) + radius(b) + contact_.distance;
      const bool joined = attached.springs->rules().rest == AttachmentRules::Rest::joined;
      // The vertices of a lattice are not on its surface.
      const bool is_lattice = first.selects_vertices() && !first.is_mesh();
      const double near_first = (is_lattice ? 1 : at_point) * first.spacing(),
                   near_second = std::min(first.spacing(), second.spacing()) + touching;
      for (const auto& [from, to] : attached.places)
        if (joined || (from - to).norm() <= touching)
          exempt(points_near(a, from, near_first), triangles_near(b, to, near_second), b);
    }
    std::vector<std::array<int, 2>>& pairs = found_.point_triangles;
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return std::move(found_);
  }

 private:
  const Vec3i& corners(int t) const { return surface_.triangles()[static_cast<std::size_t>(t)]; }
  double radius(int body) const { return surface_.bodies()[static_cast<std::size_t>(body)].radius; }
  const Vec3& rest(int point) const { return contact_.rest[static_cast<std::size_t>(point)]; }

  /// Returns the number of a component's surface, −1 if it has none.
  int surface_of(const Component& component) const {
    const auto at = std::find(contact_.names.begin(), contact_.names.end(), component.name);
    return at == contact_.names.end() ? -1 : static_cast<int>(at - contact_.names.begin());
  }

  std::vector<int> triangles_near(int body, const Vec3& place, double reach) const {
    std::vector<int> near;
    for (const int t : of_body_[static_cast<std::size_t>(body)]) {
      const Vec3 &a = rest(corners(t)[0]), &b = rest(corners(t)[1]), &c = rest(corners(t)[2]);
      const double within = reach + radius(body);
      if (((a.cwiseMin(b).cwiseMin(c) - place).array() > within).any() ||
          ((place - a.cwiseMax(b).cwiseMax(c)).array() > within).any())
        continue;
      if (closest_vertex_triangle(place, a, b, c).distance() <= within) near.push_back(t);
    }
    return near;
  }

  std::vector<int> points_near(int body, const Vec3& place, double reach) const {
    std::vector<int> near;
    for (int point = 0; point < static_cast<int>(surface_.point_count()); ++point)
      if (surface_.body_of(point) == body && (rest(point) - place).norm() <= reach + radius_of_round(point))
        near.push_back(point);
    return near;
  }
  /// The points of balls and capsules are inside of them.
  double radius_of_round(int point) const { return surface_.is_round(point) ? surface_.radius_of(point) : 0; }

  void exempt(const std::vector<int>& points, const std::vector<int>& triangles, int second_body) {
    for (const int point : points) {
      for (const int t : triangles) {
        const auto at_point = surface_.triangles_at_point(point);
        if (std::find(at_point.begin(), at_point.end(), t) == at_point.end())
          found_.point_triangles.push_back({point, t});
      }
      for (int k = 0; k < static_cast<int>(surface_.planes().size()); ++k)
        if (surface_.body_of(surface_.planes()[static_cast<std::size_t>(k)].point) == second_body)
          found_.point_planes.push_back({point, k});
    }
  }

  const Model& model_;
  const ContactModel& contact_;
  const ContactSurface& surface_;
  std::vector<std::vector<int>> of_body_;  // triangles
  ContactExemptions found_;
};

}  // namespace

ContactExemptions exemptions_at_joints(const Model& model, const ContactModel& contact) {
  return JointExemptions(model, contact).find();
}

}  // namespace muslin
