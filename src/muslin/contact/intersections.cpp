#include "muslin/contact/intersections.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "muslin/contact/exact_predicates.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

/// Boxes of the triangles in a binary tree, cut at the median of the longest side; nodes in depth-first
/// order.
struct Tree {
  struct Node {
    Box box;
    int begin = 0, end = 0;  ///< of `order`
    int right = -1;          ///< second child, the first one follows; −1: a leaf
  };
  std::vector<Box> boxes;
  std::vector<int> order;
  std::vector<Node> nodes;

  explicit Tree(std::vector<Box> triangle_boxes) : boxes(std::move(triangle_boxes)), order(boxes.size()) {
    std::iota(order.begin(), order.end(), 0);
    if (!order.empty()) build(0, static_cast<int>(order.size()));
  }

  int build(int begin, int end) {
    const int index = static_cast<int>(nodes.size());
    nodes.push_back({Box(), begin, end, -1});
    Box box, centres;
    for (int i = begin; i < end; ++i) {
      const Box& b = boxes[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])];
      box.extend(b);
      centres.extend(centre(b));
    }
    int right = -1;
    if (end - begin > 4) {
      int axis = 0;
      (centres.max() / 2 - centres.min() / 2).maxCoeff(&axis);
      const int middle = (begin + end) / 2;
      std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end, [&](int a, int b) {
        const double p = centre(boxes[static_cast<std::size_t>(a)])[axis];
        const double q = centre(boxes[static_cast<std::size_t>(b)])[axis];
        return p != q ? p < q : a < b;
      });
      build(begin, middle);
      right = build(middle, end);
    }
    nodes[static_cast<std::size_t>(index)].box = box;
    nodes[static_cast<std::size_t>(index)].right = right;
    return index;
  }

  static Vec3 centre(const Box& box) { return box.min() / 2 + box.max() / 2; }

  /// Calls visit(t) for all triangles t > after whose boxes touch `box`.
  template <class Visit>
  void overlapping(const Box& box, int after, const Visit& visit) const {
    std::array<int, 64> stack;
    std::size_t size = 0;
    stack[size++] = 0;
    while (size > 0) {
      const int index = stack[--size];
      const Node& node = nodes[static_cast<std::size_t>(index)];
      if (!touch(node.box, box)) continue;
      if (node.right >= 0) {
        stack[size++] = node.right;
        stack[size++] = index + 1;
        continue;
      }
      for (int i = node.begin; i < node.end; ++i) {
        const int t = order[static_cast<std::size_t>(i)];
        if (t > after && touch(boxes[static_cast<std::size_t>(t)], box)) visit(t);
      }
    }
  }

  static bool touch(const Box& a, const Box& b) {
    return (a.min().array() <= b.max().array()).all() && (b.min().array() <= a.max().array()).all();
  }
};

/// Reorders the triangles with their shared vertices first, in the same order; returns the number of shared
/// ones.
int sort_shared(Vec3i& a, Vec3i& b) {
  int shared = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = shared; j < 3; ++j) {
      if (a[i] != b[j]) continue;
      std::swap(a[i], a[shared]);
      std::swap(b[j], b[shared]);
      ++shared;
      break;
    }
  }
  return shared;
}

bool has_repeated_vertex(const Vec3i& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

bool cross(ConstVectors x, Vec3i a, Vec3i b) {
  const auto at = [&](int v) -> const Vec3& { return x[static_cast<std::size_t>(v)]; };
  if (has_repeated_vertex(a) || has_repeated_vertex(b)) {
    // A segment or point that shares a vertex with a triangle is part of its outline.
    for (const int v : a)
      if ((b.array() == v).any()) return false;
    return triangles_meet({at(a[0]), at(a[1]), at(a[2])}, {at(b[0]), at(b[1]), at(b[2])});
  }
  switch (sort_shared(a, b)) {
    case 0:
      return triangles_meet({at(a[0]), at(a[1]), at(a[2])}, {at(b[0]), at(b[1]), at(b[2])});
    case 1:
      return triangles_meet_beyond_vertex(at(a[0]), {at(a[1]), at(a[2])}, {at(b[1]), at(b[2])});
    case 2:
      return triangles_meet_beyond_edge({at(a[0]), at(a[1])}, at(a[2]), at(b[2]));
    default:
      return true;
  }
}

/// Returns a point near the intersection: where edges of one pierce the other, or the middle of the common
/// box.
Vec3 place(ConstVectors x, const Vec3i& a, const Vec3i& b, const Box& common) {
  Vec3 sum = Vec3::Zero();
  int count = 0;
  const auto pierce = [&](const Vec3i& s, const Vec3i& t) {
    const Triangle plane = {x[static_cast<std::size_t>(t[0])], x[static_cast<std::size_t>(t[1])],
                            x[static_cast<std::size_t>(t[2])]};
    const Vec3 normal = (plane[1] - plane[0]).cross(plane[2] - plane[0]);
    for (int i = 0; i < 3; ++i) {
      const int v = s[i], w = s[(i + 1) % 3];
      if ((t.array() == v).any() || (t.array() == w).any()) continue;
      const Vec3 &p = x[static_cast<std::size_t>(v)], &q = x[static_cast<std::size_t>(w)];
      const double from = normal.dot(p - plane[0]), to = normal.dot(q - plane[0]);
      if (from == to || !segment_meets_triangle({p, q}, plane)) continue;
      sum += p + from / (from - to) * (q - p);
      ++count;
    }
  };
  pierce(a, b);
  pierce(b, a);
  const Vec3 middle = Tree::centre(common);
  if (count == 0) return middle;
  const Vec3 mean = sum / count;
  return mean.allFinite() ? mean : middle;
}

}  // namespace

std::vector<Intersection> find_intersections(ConstVectors positions, std::span<const Vec3i> triangles,
                                             const IntersectionOptions& options) {
  for (const Vec3& p : positions) {
    if (!p.allFinite())
      throw Error(ErrorKind::usage, "a position is not finite", "check the simulation that made it");
  }
  for (const Vec3i& t : triangles) {
    if (t.minCoeff() < 0 || static_cast<std::size_t>(t.maxCoeff()) >= positions.size())
      throw Error(ErrorKind::usage, "a triangle has a vertex that does not exist", "check the indices");
  }
  std::vector<Box> boxes(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    boxes[t].setEmpty();
    for (const int v : triangles[t]) boxes[t].extend(positions[static_cast<std::size_t>(v)]);
  }
  const Tree tree(boxes);
  constexpr std::size_t grain = 256;
  std::vector<std::vector<Intersection>> found((triangles.size() + grain - 1) / grain);
  parallel_for(triangles.size(), grain, [&](std::size_t begin, std::size_t end) {
    std::vector<Intersection>& mine = found[begin / grain];
    std::vector<int> others;
    for (std::size_t t = begin; t < end && mine.size() < options.limit; ++t) {
      const int first = static_cast<int>(t);
      others.clear();
      tree.overlapping(boxes[t], first, [&](int second) { others.push_back(second); });
      std::sort(others.begin(), others.end());
      for (const int second : others) {
        const Vec3i &a = triangles[t], &b = triangles[static_cast<std::size_t>(second)];
        if ((options.wanted && !options.wanted(first, second)) || !cross(positions, a, b)) continue;
        const Box common = boxes[t].intersection(boxes[static_cast<std::size_t>(second)]);
        mine.push_back({first, second, place(positions, a, b, common)});
      }
    }
  });
  std::vector<Intersection> all;
  for (const std::vector<Intersection>& part : found) {
    for (const Intersection& i : part)
      if (all.size() < options.limit) all.push_back(i);
  }
  return all;
}

}  // namespace muslin
