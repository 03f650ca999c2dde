#include "verify_referee.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace muslin::app {
namespace {

/// Least distance of the segments a b and c d, which may be points: the least of a quadratic on a square,
/// where its derivative vanishes or on the border.
double segment_distance(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = d - c, w = a - c;
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), uw = u.dot(w), vw = v.dot(w);
  const auto at = [&](double s, double t) { return (w + s * u - t * v).norm(); };
  const auto best_t = [&](double s) { return vv > 0 ? std::clamp((vw + s * uv) / vv, 0.0, 1.0) : 0.0; };
  const auto best_s = [&](double t) { return uu > 0 ? std::clamp((t * uv - uw) / uu, 0.0, 1.0) : 0.0; };
  double least = std::min({at(0, best_t(0)), at(1, best_t(1)), at(best_s(0), 0), at(best_s(1), 1)});
  const double det = uu * vv - uv * uv;
  if (det > 0) {
    const double s = (uv * vw - vv * uw) / det, t = (uu * vw - uv * uw) / det;
    if (s >= 0 && s <= 1 && t >= 0 && t <= 1) least = std::min(least, at(s, t));
  }
  return least;
}

/// Returns whether a point lies over a triangle and, if so, its distance from the plane.
double height_over(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = (b - a).cross(c - a);
  const bool over = (b - a).cross(p - a).dot(n) >= 0 && (c - b).cross(p - b).dot(n) >= 0 &&
                    (a - c).cross(p - c).dot(n) >= 0 && n.squaredNorm() > 0;
  return over ? std::abs((p - a).dot(n)) / n.norm() : std::numeric_limits<double>::infinity();
}

}  // namespace

Vec3 Referee::Anchor::at(ConstVectors q) const {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < 4; ++i) sum += weights[i] * q[first + i];
  return sum;
}

Referee::Referee(std::shared_ptr<const Model> model) : model_(std::move(model)) {
  const Scene& scene = model_->scene;
  const auto place_of = [&](const std::string& name) {
    return static_cast<std::size_t>(model_->bodies.index_of(model_->body(name)));
  };
  touches_itself_.assign(model_->bodies.size(), false);
  const auto add_mesh = [&](std::size_t b) {
    const Mesh& mesh = model_->bodies[b].mesh;
    for (const Vec3i& t : triangulate(mesh).triangles) {
      triangles_.emplace_back(t + Vec3i::Constant(static_cast<int>(body_of_point_.size())));
      body_of_triangle_.push_back(b);
    }
    meshes_.push_back(b);
    body_of_point_.resize(body_of_point_.size() + mesh.positions.size(), b);
  };
  for (const BodySettings& settings : scene.bodies) {
    if (!settings.contact) continue;
    const std::size_t b = place_of(settings.name);
    touches_itself_[b] = settings.self_contact;
    add_mesh(b);
  }
  for (const ColliderSettings& settings : scene.colliders) {
    if (!settings.contact) continue;
    const std::size_t b = place_of(settings.name);
    const Component& body = model_->bodies[b];
    const Eigen::Isometry3d start =
        body.is_prescribed() ? body.motion()->motion.at(0) : Eigen::Isometry3d::Identity();
    const auto anchor = [&](const Vec3& given) {
      const auto weights = body.attach(start * given).point.weights.front();
      return Anchor{static_cast<std::size_t>(body.first_vertex),
                    {weights[0], weights[1], weights[2], weights[3]}};
    };
    using Shape = ColliderSettings::Shape;
    if (settings.shape == Shape::plane) {
      halves_.push_back({b, anchor(settings.center), anchor(settings.center + settings.normal)});
    } else if (settings.shape == Shape::sphere) {
      rounds_.push_back({b, anchor(settings.center), anchor(settings.center), settings.radius});
    } else if (settings.shape == Shape::capsule) {
      rounds_.push_back({b, anchor(settings.points[0]), anchor(settings.points[1]), settings.radius});
    } else {
      add_mesh(b);
    }
  }
  for (const Round& round : rounds_) {
    const int first = static_cast<int>(body_of_point_.size());
    triangles_.emplace_back(first, first + 1, first + 1);
    body_of_triangle_.push_back(round.body);
    body_of_point_.resize(body_of_point_.size() + 2, round.body);
  }
}

bool Referee::may_touch(std::size_t body_a, std::size_t body_b) const {
  if (body_a == body_b) return touches_itself_[body_a];
  return !(model_->bodies[body_a].is_prescribed() && model_->bodies[body_b].is_prescribed());
}

std::size_t Referee::crossings(ConstVectors q) const {
  std::vector<Vec3> x;
  for (const std::size_t b : meshes_) {
    const Component& body = model_->bodies[b];
    std::vector<Vec3> part(body.mesh.positions.size());
    body.skin.apply(model_->of(body, q), part);
    x.insert(x.end(), part.begin(), part.end());
  }
  for (const Round& round : rounds_) {
    x.push_back(round.a.at(q));
    x.push_back(round.b.at(q));
  }
  const auto body_of = [&](int triangle) { return body_of_triangle_[static_cast<std::size_t>(triangle)]; };
  IntersectionOptions options;
  options.wanted = [&](int first, int second) { return may_touch(body_of(first), body_of(second)); };
  std::size_t found = find_intersections(x, triangles_, options).size();

  const auto corner = [&](const Vec3i& t, int i) -> const Vec3& {
    return x[static_cast<std::size_t>(t[i % 3])];
  };
  for (std::size_t r = 0; r < rounds_.size(); ++r) {
    const Round& round = rounds_[r];
    const Vec3 a = round.a.at(q), b = round.b.at(q);
    for (std::size_t i = 0; i + rounds_.size() < triangles_.size(); ++i) {
      if (!may_touch(round.body, body_of_triangle_[i])) continue;
      const Vec3i& t = triangles_[i];
      double least = std::min(height_over(a, corner(t, 0), corner(t, 1), corner(t, 2)),
                              height_over(b, corner(t, 0), corner(t, 1), corner(t, 2)));
      for (int k = 0; k < 3; ++k)
        least = std::min(least, segment_distance(corner(t, k), corner(t, k + 1), a, b));
      if (!(least > round.radius)) ++found;
    }
    for (std::size_t s = 0; s < r; ++s) {
      const Round& other = rounds_[s];
      if (may_touch(round.body, other.body) &&
          !(segment_distance(a, b, other.a.at(q), other.b.at(q)) > round.radius + other.radius))
        ++found;
    }
  }
  for (const Half& half : halves_) {
    const Vec3 point = half.point.at(q), normal = (half.above.at(q) - point).normalized();
    for (std::size_t p = 0; p + 2 * rounds_.size() < x.size(); ++p)
      if (may_touch(half.body, body_of_point_[p]) && !(normal.dot(x[p] - point) > 0)) ++found;
    for (const Round& round : rounds_)
      for (const Anchor& end : {round.a, round.b})
        if (may_touch(half.body, round.body) && !(normal.dot(end.at(q) - point) > round.radius)) ++found;
  }
  return found;
}

}  // namespace muslin::app
