#include "muslin/geometry/closest_point.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Eigenvalues>
#include <tbb/parallel_invoke.h>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

constexpr int closest_leaf_size = 4;
constexpr int closest_parallel_leaves = 512;

// Below this squared sine of the angle between two edges the signs of the barycentric coordinates are
// unreliable, and every edge is tested.
constexpr double thin_sine_squared = 1e-8;

// Boxes are this share larger and nearer than computed, so that rounding never hides a triangle.
constexpr double slack = 1e-13;

struct Triangle {
  Vec3 a, ab, ac;
  int index;
  bool thin;
};

struct Node {
  Vec3 centre;
  Mat3 axes;  // its rows
  Vec3 half;  // extent on either side of the centre, along the axes
  int begin = 0, end = 0;
  int right = 0;  // second child; the first follows this node; 0 for a leaf

  double squared_distance(const Vec3& point) const {
    const Vec3 local = axes * (point - centre);
    return (local.cwiseAbs() - half).cwiseMax(0).squaredNorm() * (1 - slack);
  }
};

struct Candidate {
  double squared_distance = std::numeric_limits<double>::infinity();
  double v = 0, w = 0;  // weights of the second and third corner
  Vec3 difference = Vec3::Zero();
  int triangle = -1;
};

Triangle make_triangle(const Vec3& a, const Vec3& b, const Vec3& c, int index) {
  Triangle triangle{a, b - a, c - a, index, false};
  const double area = triangle.ab.cross(triangle.ac).squaredNorm();
  triangle.thin = !(area > thin_sine_squared * triangle.ab.squaredNorm() * triangle.ac.squaredNorm());
  return triangle;
}

// Keeps the point a + v·ab + w·ac if it is nearer. The difference is formed from vectors relative to a, so
// that no digits are lost far from the origin.
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
  std::vector<Triangle> triangles;  // in the order of the leaves
  std::vector<int> places;          // where each triangle, as the caller counts, went
  std::vector<Node> nodes;

  void build(int node, int leaves, int begin, int end);
  void fit_box(Node& node, int begin, int end) const;

  static void try_triangle(const Triangle& triangle, const Vec3& point, Candidate& best) {
    Candidate candidate = nearest_on(triangle, point);
    if (candidate.squared_distance > best.squared_distance) return;
    if (candidate.squared_distance == best.squared_distance && best.triangle >= 0 &&
        best.triangle <= triangle.index)
      return;
    candidate.triangle = triangle.index;
    best = candidate;
  }
  void search(const Vec3& point, Candidate& best) const;
};

// Along the principal axes of the corners; the last axis is the longest.
void ClosestPointQuery::Tree::fit_box(Node& node, int begin, int end) const {
  const std::span<const Triangle> patch(triangles.data() + begin, static_cast<std::size_t>(end - begin));
  const auto for_each_corner = [&](const auto& visit) {
    for (const Triangle& triangle : patch) {
      visit(triangle.a);
      visit(triangle.a + triangle.ab);
      visit(triangle.a + triangle.ac);
    }
  };
  const Vec3 origin = patch.front().a;
  Vec3 mean = Vec3::Zero();
  for_each_corner([&](const Vec3& p) { mean += p - origin; });
  mean /= 3.0 * static_cast<double>(patch.size());
  Mat3 covariance = Mat3::Zero();
  for_each_corner([&](const Vec3& p) {
    const Vec3 d = p - origin - mean;
    covariance += d * d.transpose();
  });
  node.axes = Eigen::SelfAdjointEigenSolver<Mat3>(covariance).eigenvectors().transpose();
  Box box;
  for_each_corner([&](const Vec3& p) { box.extend(node.axes * (p - origin)); });
  node.centre = origin + node.axes.transpose() * box.center();
  node.half.setZero();
  for_each_corner(
      [&](const Vec3& p) { node.half = node.half.cwiseMax((node.axes * (p - node.centre)).cwiseAbs()); });
  node.half.array() += slack * node.half.norm();
}

// A subtree of L leaves takes 2L − 1 nodes, and all its leaves but the last are full: all positions are known
// beforehand, so both halves can be built in parallel.
void ClosestPointQuery::Tree::build(int index, int leaves, int begin, int end) {
  Node& node = nodes[static_cast<std::size_t>(index)];
  node.begin = begin;
  node.end = end;
  fit_box(node, begin, end);
  if (leaves == 1) return;
  const Vec3 axis = node.axes.row(2).transpose();
  const int left_leaves = leaves / 2;
  const int middle = begin + left_leaves * closest_leaf_size;
  const auto along = [&](const Triangle& t) { return axis.dot(3 * t.a + t.ab + t.ac); };
  std::nth_element(triangles.begin() + begin, triangles.begin() + middle, triangles.begin() + end,
                   [&](const Triangle& s, const Triangle& t) {
                     const double x = along(s), y = along(t);
                     return x != y ? x < y : s.index < t.index;
                   });
  node.right = index + 2 * left_leaves;
  const auto build_left = [&] { build(index + 1, left_leaves, begin, middle); };
  const auto build_right = [&] { build(node.right, leaves - left_leaves, middle, end); };
  if (leaves > closest_parallel_leaves) {
    tbb::parallel_invoke(build_left, build_right);
  } else {
    build_left();
    build_right();
  }
}

void ClosestPointQuery::Tree::search(const Vec3& point, Candidate& best) const {
  struct Waiting {
    int node;
    double squared_distance;
  };
  std::array<Waiting, 64> stack;
  int depth = 0;
  stack[depth++] = {0, nodes[0].squared_distance(point)};
  while (depth > 0) {
    const Waiting next = stack[--depth];
    if (next.squared_distance > best.squared_distance) continue;
    const Node& node = nodes[static_cast<std::size_t>(next.node)];
    if (node.right == 0) {
      for (int t = node.begin; t < node.end; ++t)
        try_triangle(triangles[static_cast<std::size_t>(t)], point, best);
      continue;
    }
    Waiting near{next.node + 1, nodes[static_cast<std::size_t>(next.node) + 1].squared_distance(point)};
    Waiting far{node.right, nodes[static_cast<std::size_t>(node.right)].squared_distance(point)};
    if (far.squared_distance < near.squared_distance) std::swap(near, far);
    if (!(far.squared_distance > best.squared_distance)) stack[depth++] = far;
    if (!(near.squared_distance > best.squared_distance)) stack[depth++] = near;
  }
}

ClosestPointQuery::ClosestPointQuery(ConstVectors positions, std::span<const Vec3i> triangles)
    : tree_(std::make_unique<Tree>()) {
  Tree& tree = *tree_;
  tree.triangles.reserve(triangles.size());
  for (const Vec3i& t : triangles)
    tree.triangles.push_back(
        make_triangle(positions[static_cast<std::size_t>(t.x())], positions[static_cast<std::size_t>(t.y())],
                      positions[static_cast<std::size_t>(t.z())], static_cast<int>(tree.triangles.size())));
  if (triangles.empty()) return;
  const int count = static_cast<int>(triangles.size());
  const int leaves = (count + closest_leaf_size - 1) / closest_leaf_size;
  tree.nodes.resize(static_cast<std::size_t>(2 * leaves - 1));
  tree.build(0, leaves, 0, count);
  tree.places.resize(triangles.size());
  for (int place = 0; place < count; ++place)
    tree.places[static_cast<std::size_t>(tree.triangles[static_cast<std::size_t>(place)].index)] = place;
}

ClosestPointQuery::~ClosestPointQuery() = default;
ClosestPointQuery::ClosestPointQuery(ClosestPointQuery&&) noexcept = default;
ClosestPointQuery& ClosestPointQuery::operator=(ClosestPointQuery&&) noexcept = default;

ClosestPoint ClosestPointQuery::operator()(const Vec3& point, double max_distance, int hint) const {
  if (!point.allFinite())
    throw Error(ErrorKind::usage, "the distance of a point that is not finite is undefined",
                "check the coordinates");
  Candidate best;
  best.squared_distance = max_distance * max_distance;
  if (!tree_->nodes.empty()) {
    if (hint >= 0) {
      const int place = tree_->places[static_cast<std::size_t>(hint)];
      Tree::try_triangle(tree_->triangles[static_cast<std::size_t>(place)], point, best);
    }
    tree_->search(point, best);
  }
  ClosestPoint closest;
  if (best.triangle < 0) return closest;
  closest.triangle = best.triangle;
  closest.distance = best.difference.stableNorm();
  closest.point = point - best.difference;
  closest.barycentric = Vec3(std::max(0.0, 1 - best.v - best.w), best.v, best.w);
  return closest;
}

}  // namespace muslin
