#include "muslin/simulation/yielding.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include "muslin/contact/contact_model.hpp"
#include "muslin/contact/distance.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/geometry/winding_number.hpp"
#include "muslin/potential/anchor_springs.hpp"

namespace muslin {
namespace {

/// The weight of all bodies on a single vertex moves it by this [m]. A stiffer spring presses cloth beyond
/// its limit of stretch.
constexpr double give = 0.01, gravity = 9.81;
/// Vertices within this share of the contact distance of their paths are not behind.
constexpr double near_share = 0.02;
constexpr std::size_t yielding_grain = 256;
/// Inertia of a vertex as a share of its spring's stiffness times dt².
constexpr double inertia_share = 0.01;
/// Winding numbers: of a point that is not clearly outside, and of a vertex of a surface, whose own part of
/// space counts less than 1, inside another.
constexpr double not_outside = 0.25, inside_another = 1;

/// A vertex that is behind its path or whose path leads into another obstacle; pinched: both.
struct Doubt {
  int vertex;
  bool is_pinched;
};

/// The surfaces of colliders, and the spaces behind planes.
class Obstacles {
 public:
  /// x: #P by 3, points of the surface.
  Obstacles(const ContactSurface& surface, ConstVectors x) : surface_(surface), x_(x), winding_(x, solid()) {}

  /// True if `point` is not outside of all, or if it is a vertex of one, not outside of another.
  bool contain(const Vec3& point, bool is_vertex) const {
    return std::abs(winding_(point)) > (is_vertex ? inside_another : not_outside) ||
           std::any_of(round_.begin(), round_.end(),
                       [&](const Vec3i& t) {
                         const Vec3 &a = at(t[0]), &b = at(t[1]);
                         const double share = a == b ? 0 : closest_on_segment(point, a, b);
                         return (point - a - share * (b - a)).norm() < surface_.radius_of(t[0]);
                       }) ||
           std::any_of(surface_.planes().begin(), surface_.planes().end(), [&](const ContactPlane& plane) {
             const Vec3 normal =
                 plane.turns()
                     ? Vec3((at(plane.span[0]) - at(plane.point)).cross(at(plane.span[1]) - at(plane.point)))
                     : plane.normal;
             return surface_.body_at(plane.point).fixed && normal.dot(point - at(plane.point)) < 0;
           });
  }

 private:
  const Vec3& at(int point) const { return x_[static_cast<std::size_t>(point)]; }
  std::vector<Vec3i> solid() {
    std::vector<Vec3i> triangles;
    for (const Vec3i& t : surface_.triangles()) {
      if (!surface_.body_at(t[0]).fixed) continue;
      (t[1] == t[2] ? round_ : triangles).push_back(t);
    }
    return triangles;
  }

  const ContactSurface& surface_;
  ConstVectors x_;
  std::vector<Vec3i> round_;
  WindingNumber winding_;
};

}  // namespace

Yielding::Yielding(const Model& model) : contact_(model.contact) {
  if (!contact_) return;
  near_ = near_share * contact_->distance;
  stiffness_ = gravity / give * std::accumulate(model.masses.begin(), model.masses.end(), 0.0);
  if (!(stiffness_ > 0)) return;
  clearance_ = contact_->distance;
  for (const ContactBody& body : contact_->surface->bodies())
    if (!body.fixed) clearance_ = std::max(clearance_, contact_->distance + 2 * body.radius);
  for (const Component& body : model.bodies)
    if (body.is_prescribed() && body.deforms() && body.motion()->moves())
      for (const Prescribed& motion : model.prescribed)
        if (motion.first == body.first_vertex) yields_.push_back(&motion);
}

std::unique_ptr<Potential> Yielding::free(const State& before, StepContext& context,
                                          std::span<std::uint8_t> fixed, ConstVectors targets,
                                          std::span<double> masses) {
  vertices_.clear();
  if (yields_.empty()) return nullptr;
  std::vector<Vec3> path(before.positions);
  bool behind = false;
  for (const Prescribed* motion : yields_) {
    const auto first = static_cast<std::size_t>(motion->first), end = first + motion->start.size();
    motion->positions(context.time_begin, Vectors(path).subspan(first, end - first));
    for (std::size_t v = first; v < end; ++v)
      behind = behind || (before.positions[v] - path[v]).norm() > near_;
  }
  if (!behind) return nullptr;
  std::vector<Vec3> end(before.positions), x(contact_->map->point_count());
  for (std::size_t v = 0; v < end.size(); ++v)
    if (fixed[v] != 0) end[v] = targets[v];
  contact_->map->apply(end, x);
  const Obstacles obstacles(*contact_->surface, x);
  for (const Prescribed* motion : yields_) {
    const auto first = static_cast<std::size_t>(motion->first);
    const std::vector<Doubt> doubts = parallel_collect<Doubt>(
        motion->start.size(), yielding_grain, [&](std::size_t begin, std::size_t stop, auto& out) {
          for (std::size_t v = first + begin; v < first + stop; ++v) {
            const Vec3 ahead = targets[v] - before.positions[v];
            const bool is_behind = (before.positions[v] - path[v]).norm() > near_ && ahead.norm() > 0;
            const bool is_inside = obstacles.contain(targets[v], true);
            if (is_behind || is_inside)
              out.push_back(
                  {static_cast<int>(v),
                   is_behind && (is_inside ||
                                 obstacles.contain(targets[v] + clearance_ * ahead.normalized(), false))});
          }
        });
    if (std::none_of(doubts.begin(), doubts.end(), [](const Doubt& doubt) { return doubt.is_pinched; }))
      continue;
    std::transform(doubts.begin(), doubts.end(), std::back_inserter(vertices_),
                   [](const Doubt& doubt) { return doubt.vertex; });
  }
  if (vertices_.empty()) return nullptr;
  std::vector<double> stiffness(fixed.size(), 0.0);
  for (const int vertex : vertices_) {
    const auto v = static_cast<std::size_t>(vertex);
    stiffness[v] = stiffness_;
    fixed[v] = 0;
    masses[v] = inertia_share * stiffness_ * context.dt * context.dt;
    context.inertial_prediction[v] = before.positions[v] + targets[v] - path[v];
  }
  return std::make_unique<AnchorSprings>(std::move(stiffness),
                                         std::vector<Vec3>(targets.begin(), targets.end()));
}

int Yielding::hold(ConstVectors x, std::span<std::uint8_t> fixed, ConstVectors targets,
                   std::span<double> masses) {
  int behind = 0;
  for (const int vertex : vertices_) {
    const auto v = static_cast<std::size_t>(vertex);
    fixed[v] = 1;
    masses[v] = mass_of_prescribed;
    behind += (x[v] - targets[v]).norm() > near_ ? 1 : 0;
  }
  return behind;
}

}  // namespace muslin
