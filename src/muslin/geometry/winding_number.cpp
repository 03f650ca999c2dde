#include "muslin/geometry/winding_number.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <tbb/parallel_invoke.h>

namespace muslin {
namespace {

constexpr int winding_leaf_size = 8;
constexpr double far_factor = 2;  // the series is used beyond this many cluster radii
constexpr int winding_parallel_leaves = 512;

}  // namespace

double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double determinant = a.dot(b.cross(c));
  const double denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return 2 * std::atan2(determinant, denominator);
}

// The moments of a cluster in full, about its own area-weighted centre.
struct WindingNumber::Moments {
  Box box;
  double magnitude = 0;  // ∫ 1
  Vec3 centre = Vec3::Zero();
  Vec3 area = Vec3::Zero();                                              // ∫ n
  Mat3 first = Mat3::Zero();                                             // ∫ n xᵀ
  std::array<Mat3, 3> second{Mat3::Zero(), Mat3::Zero(), Mat3::Zero()};  // ∫ n_i x xᵀ

  void add_about(const Vec3& origin, const Moments& other) {
    const Vec3 d = other.centre - origin;
    area += other.area;
    first += other.first + other.area * d.transpose();
    for (int i = 0; i < 3; ++i) {
      const Vec3 row = other.first.row(i).transpose();
      second[i] +=
          other.second[i] + row * d.transpose() + d * row.transpose() + other.area[i] * d * d.transpose();
    }
  }

  static Moments of(const Triangle& triangle) {
    Moments moments;
    moments.box.extend(triangle.a);
    moments.box.extend(triangle.b);
    moments.box.extend(triangle.c);
    moments.area = 0.5 * (triangle.b - triangle.a).cross(triangle.c - triangle.a);
    moments.magnitude = moments.area.norm();
    moments.centre = (triangle.a + triangle.b + triangle.c) / 3;
    Mat3 spread = Mat3::Zero();
    for (const Vec3* corner : {&triangle.a, &triangle.b, &triangle.c}) {
      const Vec3 x = *corner - moments.centre;
      spread += x * x.transpose() / 12;
    }
    for (int i = 0; i < 3; ++i) moments.second[i] = moments.area[i] * spread;
    return moments;
  }

  template <class Parts>
  static Moments sum(const Parts& parts) {
    Moments total;
    for (const Moments& part : parts) {
      total.box.extend(part.box);
      total.magnitude += part.magnitude;
      total.centre += part.magnitude * part.centre;
    }
    total.centre = total.magnitude > 0 ? Vec3(total.centre / total.magnitude) : total.box.center();
    for (const Moments& part : parts) total.add_about(total.centre, part);
    return total;
  }
};

// A subtree of L leaves takes 2L − 1 nodes, and all its leaves but the last are full: all positions are known
// beforehand, so both halves can be built in parallel.
WindingNumber::Moments WindingNumber::build(int node, int leaves, std::span<int> order, int begin,
                                            std::span<const Triangle> triangles) {
  Node& self = nodes_[static_cast<std::size_t>(node)];
  self.begin = begin;
  self.end = begin + static_cast<int>(order.size());
  Moments moments;
  if (leaves == 1) {
    std::array<Moments, winding_leaf_size> parts;
    for (std::size_t i = 0; i < order.size(); ++i) {
      const Triangle& triangle = triangles[static_cast<std::size_t>(order[i])];
      triangles_[static_cast<std::size_t>(begin) + i] = triangle;
      parts[i] = Moments::of(triangle);
    }
    moments = Moments::sum(std::span(parts.data(), order.size()));
  } else {
    const auto centre = [&](int t) -> Vec3 {
      const Triangle& triangle = triangles[static_cast<std::size_t>(t)];
      return triangle.a + triangle.b + triangle.c;
    };
    Box centres;
    for (const int t : order) centres.extend(centre(t));
    int axis = 0;
    centres.sizes().maxCoeff(&axis);
    const int left_leaves = leaves / 2;
    const std::size_t middle = static_cast<std::size_t>(left_leaves) * winding_leaf_size;
    std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(middle), order.end(),
                     [&](int s, int t) {
                       const double x = centre(s)[axis], y = centre(t)[axis];
                       return x != y ? x < y : s < t;
                     });
    self.right = node + 2 * left_leaves;
    std::array<Moments, 2> parts;
    const auto build_left = [&] {
      parts[0] = build(node + 1, left_leaves, order.first(middle), begin, triangles);
    };
    const auto build_right = [&] {
      parts[1] = build(self.right, leaves - left_leaves, order.subspan(middle),
                       begin + static_cast<int>(middle), triangles);
    };
    if (leaves > winding_parallel_leaves) {
      tbb::parallel_invoke(build_left, build_right);
    } else {
      build_left();
      build_right();
    }
    moments = Moments::sum(parts);
  }

  self.centre = moments.centre;
  const Vec3 corner = (moments.box.max() - moments.centre).cwiseMax(moments.centre - moments.box.min());
  self.squared_reach = far_factor * far_factor * corner.squaredNorm();
  self.area = moments.area;
  const Mat3& m = moments.first;
  self.first = {m(0, 0), m(1, 1), m(2, 2), m(0, 1) + m(1, 0), m(1, 2) + m(2, 1), m(2, 0) + m(0, 2)};
  const auto& t = moments.second;
  for (int i = 0; i < 3; ++i) {
    self.second_trace += 2 * t[i].row(i).transpose();
    self.second_trace[i] += t[i].trace();
  }
  const auto twice = [&](int i, int j) { return t[i](i, j) * 2 + t[j](i, i); };  // terms of x_i² x_j
  self.second = {
      t[0](0, 0),  t[1](1, 1),  t[2](2, 2),  twice(0, 1), twice(0, 2),
      twice(1, 0), twice(1, 2), twice(2, 0), twice(2, 1), 2 * (t[0](1, 2) + t[1](2, 0) + t[2](0, 1))};
  return moments;
}

WindingNumber::WindingNumber(ConstVectors positions, std::span<const Vec3i> triangles) {
  std::vector<Triangle> corners;
  corners.reserve(triangles.size());
  for (const Vec3i& t : triangles)
    corners.push_back({positions[static_cast<std::size_t>(t.x())], positions[static_cast<std::size_t>(t.y())],
                       positions[static_cast<std::size_t>(t.z())]});
  if (corners.empty()) return;
  const int leaves = (static_cast<int>(corners.size()) + winding_leaf_size - 1) / winding_leaf_size;
  std::vector<int> order(corners.size());
  std::iota(order.begin(), order.end(), 0);
  triangles_.resize(corners.size());
  nodes_.resize(static_cast<std::size_t>(2 * leaves - 1));
  build(0, leaves, order, 0, corners);
}

double WindingNumber::operator()(const Vec3& point) const {
  if (nodes_.empty()) return 0;
  double sum = 0;
  std::array<int, 64> stack;
  int depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const int index = stack[--depth];
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    const Vec3 r = node.centre - point;
    const double squared = r.squaredNorm();
    if (squared > node.squared_reach) {
      const double x = r.x(), y = r.y(), z = r.z();
      const double inverse = 1 / squared;
      const double inverse3 = inverse / std::sqrt(squared);
      const auto& m = node.first;
      const auto& t = node.second;
      const double quadratic =
          m[0] * x * x + m[1] * y * y + m[2] * z * z + m[3] * x * y + m[4] * y * z + m[5] * z * x;
      const double cubic = x * x * (t[0] * x + t[3] * y + t[4] * z) +
                           y * y * (t[1] * y + t[5] * x + t[6] * z) +
                           z * z * (t[2] * z + t[7] * x + t[8] * y) + t[9] * x * y * z;
      const double order0 = node.area.dot(r);
      const double order1 = m[0] + m[1] + m[2] - 3 * quadratic * inverse;
      const double order2 = (-1.5 * node.second_trace.dot(r) + 7.5 * cubic * inverse) * inverse;
      sum += (order0 + order1 + order2) * inverse3;
    } else if (node.right == 0) {
      for (int i = node.begin; i < node.end; ++i) {
        const Triangle& triangle = triangles_[static_cast<std::size_t>(i)];
        sum += solid_angle(triangle.a - point, triangle.b - point, triangle.c - point);
      }
    } else {
      stack[depth++] = node.right;
      stack[depth++] = index + 1;
    }
  }
  return sum / (4 * std::numbers::pi);
}

}  // namespace muslin
