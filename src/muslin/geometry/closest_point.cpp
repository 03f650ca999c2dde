#include "muslin/geometry/closest_point.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <embree3/rtcore.h>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

// Below this squared sine of the angle between two edges the signs of the barycentric coordinates are not
// trusted, and every edge is tried.
constexpr double thin_sine_squared = 1e-8;

// Unit of the last place of a float between 1 and 2.
constexpr double float_ulp = std::numeric_limits<float>::epsilon();

// Squares of coordinates beyond this would come near the largest float.
constexpr double farthest_scaled_coordinate = 1e15;

struct Triangle {
  Vec3 a, ab, ac;
  bool thin;
};

struct Candidate {
  double squared_distance = std::numeric_limits<double>::infinity();
  double v = 0, w = 0;  // weights of the second and third corner
  Vec3 difference = Vec3::Zero();
  int triangle = -1;
};

Triangle make_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  Triangle triangle{a, b - a, c - a, false};
  const double area = triangle.ab.cross(triangle.ac).squaredNorm();
  triangle.thin = !(area > thin_sine_squared * triangle.ab.squaredNorm() * triangle.ac.squaredNorm());
  return triangle;
}

// Keeps the point a + v·ab + w·ac if it is nearer. The difference is formed from vectors relative to a, so
// that nothing is lost far from the origin.
void offer(const Triangle& triangle, const Vec3& ap, double v, double w, Candidate& best) {
  const Vec3 difference = ap - v * triangle.ab - w * triangle.ac;
  const double squared = difference.squaredNorm();
  if (!(squared < best.squared_distance)) return;
  best.squared_distance = squared;
  best.v = v;
  best.w = w;
  best.difference = difference;
}

double clamped_ratio(double numerator, double denominator) {
  if (!(numerator > 0)) return 0;
  return numerator < denominator ? numerator / denominator : 1;
}

Candidate nearest_on(const Triangle& triangle, const Vec3& point) {
  const Vec3& ab = triangle.ab;
  const Vec3& ac = triangle.ac;
  const Vec3 ap = point - triangle.a;
  const Vec3 normal = ab.cross(ac);
  const double whole = normal.squaredNorm();
  const double v = ap.cross(ac).dot(normal);
  const double w = ab.cross(ap).dot(normal);
  const double u = whole - v - w;
  Candidate best;
  if (whole > 0 && u >= 0 && v >= 0 && w >= 0) {
    offer(triangle, ap, v / whole, w / whole, best);
    if (!triangle.thin) return best;
  }
  // The nearest point of a convex outline lies on an edge that faces the point.
  const bool all = triangle.thin;
  if (all || w < 0) offer(triangle, ap, clamped_ratio(ap.dot(ab), ab.squaredNorm()), 0, best);
  if (all || v < 0) offer(triangle, ap, 0, clamped_ratio(ap.dot(ac), ac.squaredNorm()), best);
  if (all || u < 0) {
    const Vec3 bc = ac - ab;
    const double t = clamped_ratio((ap - ab).dot(bc), bc.squaredNorm());
    offer(triangle, ap, 1 - t, t, best);
  }
  return best;
}

}  // namespace

struct ClosestPointQuery::Tree {
  std::vector<Triangle> triangles;
  Vec3 centre = Vec3::Zero();
  double scale = 1;  // a power of two: the mesh lies within [−1, 1]³ in the hierarchy's coordinates
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  Tree() = default;
  Tree(const Tree&) = delete;
  Tree& operator=(const Tree&) = delete;
  ~Tree() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }

  void build();
  void try_triangle(int index, const Vec3& point, Candidate& best) const {
    Candidate candidate = nearest_on(triangles[static_cast<std::size_t>(index)], point);
    if (candidate.squared_distance > best.squared_distance) return;
    if (candidate.squared_distance == best.squared_distance && best.triangle >= 0 && best.triangle <= index)
      return;
    candidate.triangle = index;
    best = candidate;
  }
};

namespace {

void triangle_bounds(const RTCBoundsFunctionArguments* arguments) {
  const auto& boxes = *static_cast<const std::vector<RTCBounds>*>(arguments->geometryUserPtr);
  *arguments->bounds_o = boxes[arguments->primID];
}

}  // namespace

void ClosestPointQuery::Tree::build() {
  Box bounds;
  for (const Triangle& triangle : triangles) {
    bounds.extend(triangle.a);
    bounds.extend(triangle.a + triangle.ab);
    bounds.extend(triangle.a + triangle.ac);
  }
  centre = bounds.center();
  const double half = 0.5 * bounds.sizes().maxCoeff();
  if (half > std::numeric_limits<double>::min()) scale = std::exp2(-std::ceil(std::log2(half)));

  std::vector<RTCBounds> boxes(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Vec3 a = triangles[t].a - centre;
    const Vec3 b = a + triangles[t].ab, c = a + triangles[t].ac;
    const Eigen::Vector3f low = (scale * a.cwiseMin(b).cwiseMin(c)).cast<float>();
    const Eigen::Vector3f high = (scale * a.cwiseMax(b).cwiseMax(c)).cast<float>();
    boxes[t] = {low.x(), low.y(), low.z(), 0, high.x(), high.y(), high.z(), 0};
  }

  // No "threads=" here: it would limit TBB for the whole process.
  device = rtcNewDevice(nullptr);
  scene = rtcNewScene(device);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(triangles.size()));
  rtcSetGeometryUserData(geometry, &boxes);
  rtcSetGeometryBoundsFunction(geometry, triangle_bounds, nullptr);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
  if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
    throw Error(ErrorKind::solver,
                "the search tree over " + std::to_string(triangles.size()) +
                    " triangles could not be built (Embree error " + std::to_string(error) + ")",
                "free memory or simplify the mesh");
}

ClosestPointQuery::ClosestPointQuery(ConstVectors positions, std::span<const Vec3i> triangles)
    : tree_(std::make_unique<Tree>()) {
  tree_->triangles.reserve(triangles.size());
  for (const Vec3i& t : triangles)
    tree_->triangles.push_back(make_triangle(positions[static_cast<std::size_t>(t.x())],
                                             positions[static_cast<std::size_t>(t.y())],
                                             positions[static_cast<std::size_t>(t.z())]));
  if (!triangles.empty()) tree_->build();
}

ClosestPointQuery::~ClosestPointQuery() = default;
ClosestPointQuery::ClosestPointQuery(ClosestPointQuery&&) noexcept = default;
ClosestPointQuery& ClosestPointQuery::operator=(ClosestPointQuery&&) noexcept = default;

ClosestPoint ClosestPointQuery::operator()(const Vec3& point, double max_distance, int hint) const {
  if (!point.allFinite())
    throw Error(ErrorKind::usage, "the distance of a point that is not finite was asked for",
                "check the coordinates");
  const Tree& tree = *tree_;
  const Vec3 scaled = tree.scale * (point - tree.centre);
  const double largest = std::max(1.0, scaled.cwiseAbs().maxCoeff());

  struct Search {
    const Tree& tree;
    const Vec3& point;
    double margin;  // what rounding to float may hide: the boxes', the point's and the box distance's error
    Candidate best;

    float radius() const {
      const double exact = tree.scale * std::sqrt(best.squared_distance);
      return static_cast<float>(exact * (1 + 4 * float_ulp) + margin);
    }
    static bool visit(RTCPointQueryFunctionArguments* arguments) {
      auto& search = *static_cast<Search*>(arguments->userPtr);
      const double before = search.best.squared_distance;
      search.tree.try_triangle(static_cast<int>(arguments->primID), search.point, search.best);
      if (!(search.best.squared_distance < before)) return false;
      arguments->query->radius = search.radius();
      return true;
    }
  } search{tree, point, 4 * float_ulp * largest, {}};

  search.best.squared_distance = max_distance * max_distance;
  if (hint >= 0) tree.try_triangle(hint, point, search.best);
  if (largest > farthest_scaled_coordinate) {
    for (std::size_t t = 0; t < tree.triangles.size(); ++t)
      tree.try_triangle(static_cast<int>(t), point, search.best);
  } else if (tree.scene) {
    RTCPointQuery query{static_cast<float>(scaled.x()), static_cast<float>(scaled.y()),
                        static_cast<float>(scaled.z()), 0, search.radius()};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(tree.scene, &query, &context, &Search::visit, &search);
  }

  ClosestPoint closest;
  const Candidate& best = search.best;
  if (best.triangle < 0) return closest;
  closest.triangle = best.triangle;
  closest.distance = best.difference.stableNorm();
  closest.point = point - best.difference;
  closest.barycentric = Vec3(std::max(0.0, 1 - best.v - best.w), best.v, best.w);
  return closest;
}

}  // namespace muslin
