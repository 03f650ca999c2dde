#include "muslin/contact/contact_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

bool is_infinite(const ContactBody& body) { return !(body.mass > 0) && std::isinf(body.stiffness); }

}  // namespace

void ContactSurface::TriangleLists::assign(std::size_t count, const std::vector<std::array<int, 2>>& pairs) {
  begins_.assign(count + 1, 0);
  for (const auto& [i, t] : pairs) ++begins_[static_cast<std::size_t>(i) + 1];
  std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
  std::vector<std::size_t> next(begins_.begin(), begins_.end() - 1);
  all_.resize(pairs.size());
  for (const auto& [i, t] : pairs) all_[next[static_cast<std::size_t>(i)]++] = t;
}

ContactSurface::ContactSurface(std::vector<Vec3i> triangles, std::vector<int> body_of_point,
                               std::vector<ContactBody> bodies, std::vector<ContactPlane> planes,
                               ContactRules rules, ContactPointNumbers varying)
    : triangles_(std::move(triangles)),
      triangle_edges_(triangles_.size(), Vec3i::Constant(-1)),
      ownership_(triangles_.size()),
      body_of_point_(std::move(body_of_point)),
      round_triangles_(body_of_point_.size(), -1),
      bodies_(std::move(bodies)),
      planes_(std::move(planes)),
      rules_(std::move(rules)),
      varying_(std::move(varying)) {
  require(varying_.friction.empty() || varying_.friction.size() == body_of_point_.size(),
          "the friction of contact points has another count", "give one for each point");
  require(varying_.radius.empty() || varying_.radius.size() == body_of_point_.size(),
          "the radii of contact points have another count", "give one for each point");
  const auto points = static_cast<int>(body_of_point_.size());
  for (const int body : body_of_point_) {
    if (body < 0 || static_cast<std::size_t>(body) >= bodies_.size())
      throw Error(ErrorKind::usage, "a contact point has a body that does not exist", "check body_of_point");
  }
  for (std::size_t point = 0; point < varying_.radius.size(); ++point)
    require(varying_.radius[point] <= radius_of(static_cast<int>(point)),
            "the radius of a contact point is greater than that of its body", "give the body the greatest");
  for (const ContactBody& body : bodies_) {
    if (!(body.range.value_or(1) > 0))
      throw Error(ErrorKind::usage, "a contact distance is not positive", "give a length in metres");
    if (!(body.radius >= 0)) throw Error(ErrorKind::usage, "a contact radius is negative", "give 0 or more");
    if (body.friction && !(body.friction->least() >= 0))
      throw Error(ErrorKind::usage, "a friction coefficient is negative", "give 0 or more");
    if (!(body.stiffness > 0) && !(body.mass > 0))
      throw Error(ErrorKind::usage, "a contact stiffness is not positive", "give newtons per metre");
    if (*std::min_element(body.frame.begin(), body.frame.end()) < 0 &&
        *std::max_element(body.frame.begin(), body.frame.end()) >= 0)
      throw Error(ErrorKind::usage, "a body's frame lacks a vertex", "give four or none");
  }
  for (std::size_t a = 0; a < bodies_.size(); ++a) {
    for (std::size_t b = a; b < bodies_.size() && is_infinite(bodies_[a]); ++b) {
      if (is_infinite(bodies_[b]) && may_touch(static_cast<int>(a), static_cast<int>(b)))
        throw Error(ErrorKind::usage, "two bodies that may touch have infinite contact stiffness",
                    "give one of them newtons per metre");
    }
  }
  for (const ContactPlane& plane : planes_) {
    const auto exists = [points](int point) { return point >= 0 && point < points; };
    const bool spanned = plane.span[0] >= 0 || plane.span[1] >= 0;
    if (!exists(plane.point) || (spanned && (!exists(plane.span[0]) || !exists(plane.span[1]))))
      throw Error(ErrorKind::usage, "a contact plane has a point that does not exist", "check the index");
    if (!(std::fabs(plane.normal.norm() - 1) <= 1e-9))
      throw Error(ErrorKind::usage, "the normal of a contact plane is not of length 1", "normalise it");
  }
  struct Corner {
    Edge edge;
    int triangle, side;
  };
  std::vector<Corner> sides;
  std::vector<std::array<int, 2>> at_points, at_edges;
  sides.reserve(3 * triangles_.size());
  std::vector<std::uint8_t> owned(body_of_point_.size(), 0);
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const Vec3i& corners = triangles_[t];
    if (corners.minCoeff() < 0 || corners.maxCoeff() >= points)
      throw Error(ErrorKind::usage, "a contact triangle has a point that does not exist",
                  "check the indices");
    if (body_of(corners[0]) != body_of(corners[1]) || body_of(corners[0]) != body_of(corners[2]))
      throw Error(ErrorKind::usage, "a contact triangle joins two bodies", "give each body its own points");
    for (int i = 0; i < 3; ++i) {
      const int p = corners[i], q = corners[(i + 1) % 3];
      int& round = round_triangles_[static_cast<std::size_t>(p)];
      if (round < 0 && (corners[0] == corners[1] || corners[1] == corners[2])) round = static_cast<int>(t);
      if (p != q) sides.push_back({{std::min(p, q), std::max(p, q)}, static_cast<int>(t), i});
      if ((i > 0 && p == corners[0]) || (i == 2 && p == corners[1])) continue;
      at_points.push_back({p, static_cast<int>(t)});
      std::uint8_t& taken = owned[static_cast<std::size_t>(p)];
      if (taken == 0) ownership_[t].vertices = static_cast<std::uint8_t>(ownership_[t].vertices | 1U << i);
      taken = 1;
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Corner& a, const Corner& b) {
    return std::tie(a.edge, a.triangle, a.side) < std::tie(b.edge, b.triangle, b.side);
  });
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Corner& side = sides[i];
    const auto t = static_cast<std::size_t>(side.triangle);
    const bool is_new = i == 0 || side.edge != sides[i - 1].edge;
    if (is_new) {
      edges_.push_back(side.edge);
      const int opposite = triangles_[t][(side.side + 2) % 3];
      lone_corners_.push_back(opposite == side.edge[0] || opposite == side.edge[1] ? -1 : opposite);
      ownership_[t].edges = static_cast<std::uint8_t>(ownership_[t].edges | 1U << side.side);
    }
    const int edge = static_cast<int>(edges_.size()) - 1;
    // The two sides of a segment (a, b, b) are one edge of one triangle.
    if (is_new || side.triangle != sides[i - 1].triangle) at_edges.push_back({edge, side.triangle});
    if (!is_new && side.triangle != sides[i - 1].triangle) lone_corners_.back() = -1;
    triangle_edges_[t][side.side] = edge;
  }
  at_points_.assign(body_of_point_.size(), at_points);
  at_edges_.assign(edges_.size(), at_edges);
}

std::array<double, 2> ContactSurface::ranges(double common) const {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  const auto take = [&](double range) {
    least = std::min(least, range);
    most = std::max(most, range);
  };
  for (const ContactBody& body : bodies_)
    if (!body.fixed) take(body.range.value_or(common));
  for (const ContactRule& rule : rules_.all())
    if (rule.range) take(*rule.range);
  return most > 0 ? std::array{least, most} : std::array{common, common};
}

}  // namespace muslin
