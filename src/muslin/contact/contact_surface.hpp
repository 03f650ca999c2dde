// ContactSurface holds the surfaces of all bodies and colliders for contact: triangles, their edges and
// vertices, each feature owned by one triangle, so that each feature pair is found once.
//
// A triangle with repeated indices is codimensional: (a, b, b) is a segment, such as the axis of a capsule,
// (a, a, a) a point, such as the centre of a sphere; their body's radius makes them round.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "muslin/contact/contact_rules.hpp"
#include "muslin/core/keyed_number.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

struct ContactBody {
  double radius = 0;         ///< half the (greatest) thickness, or the radius of a sphere or capsule [m]
  bool self_contact = true;  ///< true if it touches itself
  bool fixed = false;        ///< a collider: two fixed bodies do not touch each other
  /// Stiffness of a contact with this body [N/m]; a pair uses the smaller one. For cloth about 0.15 × Young's
  /// modulus × thickness of the membrane; infinite if the other body's stiffness is to be used.
  double stiffness = 150;
  /// For a body with a radius: the four vertices (degrees of freedom, not surface points) that carry it,
  /// corners of a tetrahedron that is not flat. Friction computes the rotation of the surface from them. −1:
  /// none.
  std::array<int, 4> frame = {-1, -1, -1, -1};
  /// Coulomb's μ of this body; none: the scene's default. A pair uses the geometric mean.
  std::optional<KeyedNumber> friction = std::nullopt;
  /// Above 0: the stiffness is 4 m/dt², which stops this mass within a step; `stiffness` is ignored [kg].
  double mass = 0;
  /// Its contact distance d̂ [m]; none: that of the model. A pair uses the smaller one, unless one of them is
  /// rigid (has a `mass`) or fixed: then that of the other.
  std::optional<double> range = std::nullopt;
  bool solid = false;  ///< true if closed surfaces of it have an inside, where nothing else belongs
  /// The order of bodies outward; none: unknown. A body of a higher layer belongs outside one of a lower.
  std::optional<int> layer = std::nullopt;
};

/// An impenetrable half-space: gap = normal·(x − x_point). The plane moves with its point.
struct ContactPlane {
  int point = 0;                ///< of the surface; it is the plane's own body
  Vec3 normal = Vec3(0, 1, 0);  ///< outward, of length 1; unused for a turning plane
  /// Two more points of that body, −1: none. With them the plane turns: it passes through the three points,
  /// and its outward normal is along (span[0] − point) × (span[1] − point).
  std::array<int, 2> span = {-1, -1};
  bool turns() const { return span[0] >= 0; }
};

/// Numbers that vary over the points of a surface, #P each; empty, or negative at a point: that of the body.
struct ContactPointNumbers {
  std::vector<KeyedNumber> friction;  ///< Coulomb's μ
  std::vector<double> radius;         ///< half the thickness [m], at most the radius of the body
};

/// Immutable.
class ContactSurface {
 public:
  using Edge = std::array<int, 2>;

  /// The features that a triangle owns; the vertices and edges of a triangle are numbered 0, 1, 2, edge i
  /// from corner i to corner i + 1 mod 3.
  struct Ownership {
    std::uint8_t vertices = 0, edges = 0;  ///< bit i: owns corner or edge i
  };

  /// Points are numbered 0 … body_of_point.size() − 1. A body's triangles use points of that body only.
  /// Errors: usage, if an index is out of range, a triangle joins two bodies, a radius or friction is
  /// negative, a stiffness not positive, two bodies that may touch both have an infinite one, or a normal is
  /// not of length 1 (to 1e-9), `varying` has another count, or a radius is greater than that of its body.
  ContactSurface(std::vector<Vec3i> triangles, std::vector<int> body_of_point,
                 std::vector<ContactBody> bodies, std::vector<ContactPlane> planes = {},
                 ContactRules rules = {}, ContactPointNumbers varying = {});

  std::size_t point_count() const { return body_of_point_.size(); }
  std::span<const Vec3i> triangles() const { return triangles_; }
  std::span<const Edge> edges() const { return edges_; }
  std::span<const ContactBody> bodies() const { return bodies_; }
  std::span<const ContactPlane> planes() const { return planes_; }
  const ContactRules& rules() const { return rules_; }
  /// #T by 3; −1 where a codimensional triangle has no edge.
  std::span<const Vec3i> triangle_edges() const { return triangle_edges_; }
  /// Returns the corner opposite to an edge with one triangle; −1 if it has several or no such corner.
  int lone_corner(int edge) const { return lone_corners_[static_cast<std::size_t>(edge)]; }
  std::span<const Ownership> ownership() const { return ownership_; }

  int body_of(int point) const { return body_of_point_[static_cast<std::size_t>(point)]; }
  const ContactBody& body_at(int point) const { return bodies_[static_cast<std::size_t>(body_of(point))]; }
  /// Returns the radius of a point's body, which no feature of it exceeds.
  double radius_of(int point) const { return body_at(point).radius; }
  /// Returns the radius of a feature: the greatest of its points.
  double radius_of(std::span<const int> feature) const {
    if (varying_.radius.empty()) return radius_of(feature.front());
    double greatest = 0;
    for (const int point : feature) {
      const double own = varying_.radius[static_cast<std::size_t>(point)];
      greatest = std::max(greatest, own >= 0 ? own : radius_of(point));
    }
    return greatest;
  }
  const ContactPointNumbers& varying() const { return varying_; }
  bool may_touch(int body_a, int body_b) const {
    const ContactBody &a = bodies_[static_cast<std::size_t>(body_a)],
                      &b = bodies_[static_cast<std::size_t>(body_b)];
    return body_a == body_b ? a.self_contact && !a.fixed : !(a.fixed && b.fixed);
  }
  /// Returns the stiffness of a contact between the bodies of two points in a step of `dt` [s] [N/m]: the
  /// smaller one; between a rigid and a deformable body their geometric mean if that is larger, since this
  /// force alone may have to stop the rigid body.
  double stiffness(int point_a, int point_b, double dt) const {
    const auto of = [dt](const ContactBody& b) { return b.mass > 0 ? 4 * b.mass / (dt * dt) : b.stiffness; };
    const ContactBody &a = body_at(point_a), &b = body_at(point_b);
    const double smaller = std::min(of(a), of(b)), larger = std::max(of(a), of(b));
    return (a.mass > 0) != (b.mass > 0) && std::isfinite(larger) ? std::sqrt(smaller * larger) : smaller;
  }
  /// Returns d̂ of a contact between the bodies of two points [m]; `common` is that of bodies without one.
  double range(int point_a, int point_b, double common) const {
    const ContactBody &a = body_at(point_a), &b = body_at(point_b);
    const double of_a = a.range.value_or(common), of_b = b.range.value_or(common);
    if (a.fixed || b.fixed) return a.fixed ? of_b : of_a;
    if ((a.mass > 0) != (b.mass > 0)) return a.mass > 0 ? of_b : of_a;
    return std::min(of_a, of_b);
  }
  /// Returns the smallest and the largest d̂ of all pairs, those of rules included [m].
  std::array<double, 2> ranges(double common) const;
  /// One side of a contact: the weighted mean of points of one body.
  struct Side {
    std::span<const int> points;      ///< at least one
    std::span<const double> weights;  ///< of one sign
  };
  /// Returns Coulomb's μ between two sides: √(μ_a μ_b), so that two bodies of equal μ have that μ between
  /// them, and a frictionless body slides on everything. `common` is the μ of bodies without one at `time`
  /// [s].
  double friction(const Side& side_a, const Side& side_b, double common, double time) const {
    const double a = friction_of(side_a, common, time), b = friction_of(side_b, common, time);
    return a == b ? a : std::sqrt(a * b);
  }
  /// True for points of a codimensional triangle: the centre of a sphere, an end of a capsule's axis.
  bool is_round(int point) const { return round_triangle(point) >= 0; }
  /// Returns the first such triangle of a point; −1: none.
  int round_triangle(int point) const { return round_triangles_[static_cast<std::size_t>(point)]; }
  /// Return the triangles that share a point or an edge, ascending.
  std::span<const int> triangles_at_point(int p) const { return at_points_[static_cast<std::size_t>(p)]; }
  std::span<const int> triangles_at_edge(int e) const { return at_edges_[static_cast<std::size_t>(e)]; }

 private:
  double friction_of_body(int point, double common, double time) const {
    const std::optional<KeyedNumber>& own = body_at(point).friction;
    return own ? own->at(time) : common;
  }
  double friction_of(int point, double common, double time) const {
    const double varied = varying_.friction[static_cast<std::size_t>(point)].at(time);
    return varied >= 0 ? varied : friction_of_body(point, common, time);
  }
  double friction_of(const Side& side, double common, double time) const {
    const int first = side.points.front();
    if (varying_.friction.empty()) return friction_of_body(first, common, time);
    // The differences vanish where all points have one value, which is then returned bit for bit.
    const double base = friction_of(first, common, time);
    double sum = 0, weights = 0;
    for (std::size_t i = 0; i < side.points.size(); ++i) {
      sum += side.weights[i] * (friction_of(side.points[i], common, time) - base);
      weights += side.weights[i];
    }
    return std::max(0.0, base + sum / weights);
  }

  /// Lists of triangles, one after the other.
  class TriangleLists {
   public:
    std::span<const int> operator[](std::size_t i) const {
      return std::span(all_).subspan(begins_[i], begins_[i + 1] - begins_[i]);
    }
    /// Sets list i to the triangles t of all pairs (i, t), in the order of the pairs.
    void assign(std::size_t count, const std::vector<std::array<int, 2>>& pairs);

   private:
    std::vector<std::size_t> begins_;
    std::vector<int> all_;
  };

  std::vector<Vec3i> triangles_, triangle_edges_;
  std::vector<Edge> edges_;
  std::vector<int> lone_corners_;  // by edge
  std::vector<Ownership> ownership_;
  TriangleLists at_points_, at_edges_;
  std::vector<int> body_of_point_;
  std::vector<int> round_triangles_;
  std::vector<ContactBody> bodies_;
  std::vector<ContactPlane> planes_;
  ContactRules rules_;
  ContactPointNumbers varying_;
};

}  // namespace muslin
