#include "muslin/contact/pair_search.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <initializer_list>
#include <numeric>
#include <utility>

#include "muslin/contact/feature_lanes.hpp"
#include "muslin/contact/float_box.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/core/vector_code.hpp"

namespace muslin {
namespace {

constexpr int leaf_size = 8;
constexpr std::size_t search_grain = 4096;

/// Numbers of two leaves.
struct LeafPair {
  int a, b;
};

/// Features owned by eight triangles, as ranges of groups of eight.
struct Leaf {
  MovingBox box;
  int first_points = 0, last_points = 0;
  int first_edges = 0, last_edges = 0;
};

/// Pairs found in vector code: grown before each group, cut to size at the end.
template <class Pair>
struct Output {
  std::vector<Pair>& pairs;
  std::size_t count = 0;

  void reserve() {
    if (pairs.size() < count + lane_count * lane_count) pairs.resize(2 * (count + lane_count * lane_count));
  }
  MUSLIN_INLINE void add(int first, int second) { pairs[count++] = {first, second}; }
};

/// The groups of all leaves; triangles of leaf l are group l.
struct Groups {
  std::vector<Leaf> leaves;
  FeatureGroups points, edges, triangles;
};

template <int ends>
MUSLIN_INLINE void points_against_triangles(const Groups& groups, const Leaf& a, int leaf_b,
                                            Output<VertexTriangle>& out) {
  const MovingBox& box = groups.leaves[static_cast<std::size_t>(leaf_b)].box;
  const FeatureLanes& triangles = groups.triangles.lanes[static_cast<std::size_t>(leaf_b)];
  for (int g = a.first_points; g < a.last_points; ++g) {
    const FeatureLanes& points = groups.points.lanes[static_cast<std::size_t>(g)];
    out.reserve();
    for (LaneBits rows = lanes_in_box<ends>(groups.points, g, box); rows != 0; rows &= rows - 1) {
      const int i = first_lane(rows);
      LaneBits hits = lanes_near<ends, 1, 3>(groups.points, g, i, groups.triangles, leaf_b);
      for (; hits != 0; hits &= hits - 1) out.add(points.id[i], triangles.id[first_lane(hits)]);
    }
  }
}

template <int ends>
MUSLIN_INLINE void edges_against_edges(const Groups& groups, const LeafPair& pair, Output<EdgeEdge>& out) {
  const Leaf &a = groups.leaves[static_cast<std::size_t>(pair.a)],
             &b = groups.leaves[static_cast<std::size_t>(pair.b)];
  for (int g = a.first_edges; g < a.last_edges; ++g) {
    const FeatureLanes& first = groups.edges.lanes[static_cast<std::size_t>(g)];
    const LaneBits rows = lanes_in_box<ends>(groups.edges, g, b.box);
    if (rows == 0) continue;
    // Each pair within a leaf once: later groups, and later lanes of the same group.
    for (int h = pair.a == pair.b ? g : b.first_edges; h < b.last_edges; ++h) {
      if (lanes_in_box<ends>(groups.edges, h, a.box) == 0) continue;
      const FeatureLanes& second = groups.edges.lanes[static_cast<std::size_t>(h)];
      out.reserve();
      for (LaneBits left = rows; left != 0; left &= left - 1) {
        const int i = first_lane(left);
        LaneBits hits = lanes_near<ends, 2, 2>(groups.edges, g, i, groups.edges, h);
        if (g == h) hits &= lanes_after(i);
        for (; hits != 0; hits &= hits - 1) {
          const int e = first.id[i], f = second.id[first_lane(hits)];
          out.add(e < f ? e : f, e < f ? f : e);
        }
      }
    }
  }
}

template <int ends>
MUSLIN_INLINE void compare_in(const Groups& groups, const std::vector<LeafPair>& pairs, FeaturePairs& found) {
  Output<VertexTriangle> vertex_triangle{found.vertex_triangle};
  Output<EdgeEdge> edge_edge{found.edge_edge};
  for (const LeafPair& pair : pairs) {
    points_against_triangles<ends>(groups, groups.leaves[static_cast<std::size_t>(pair.a)], pair.b,
                                   vertex_triangle);
    if (pair.a != pair.b)
      points_against_triangles<ends>(groups, groups.leaves[static_cast<std::size_t>(pair.b)], pair.a,
                                     vertex_triangle);
    edges_against_edges<ends>(groups, pair, edge_edge);
  }
  found.vertex_triangle.resize(vertex_triangle.count);
  found.edge_edge.resize(edge_edge.count);
}

MUSLIN_VECTOR_CODE
void compare_leaves(const Groups& groups, const std::vector<LeafPair>& pairs, FeaturePairs& found) {
  compare_in<1>(groups, pairs, found);
}
MUSLIN_VECTOR_CODE
void compare_moving_leaves(const Groups& groups, const std::vector<LeafPair>& pairs, FeaturePairs& found) {
  compare_in<2>(groups, pairs, found);
}

}  // namespace

struct PairSearch::Tree {
  struct Node {
    int right = -1;  ///< second child, the first one follows; −1: a leaf
    int leaf = 0;    ///< number of the leaf, for a leaf
  };
  struct NodePair {
    int a, b;
  };
  /// Memory of a task, kept from call to call.
  struct Task {
    NodePair root{};
    std::vector<NodePair> stack;
    std::vector<LeafPair> leaves;
    FeaturePairs found;
  };
  std::shared_ptr<const ContactSurface> surface;
  bool ask_bodies = false, ask_points = false;  ///< true if pairs have to be removed afterwards
  std::vector<Node> nodes;
  std::vector<int> order;  ///< triangles by leaf
  Groups groups;
  std::vector<Task> tasks;
  std::vector<MovingBox> node_boxes;
  std::vector<FloatBox> point_boxes[2];  ///< at both ends
  int ends = 1;                          ///< ends of boxes in use: two if any moves
  std::vector<std::uint8_t> lone;        ///< points that are a triangle (a, a, a)
  std::span<const std::uint8_t> moved;   ///< of the present search; empty: all
  std::vector<std::uint8_t> node_moved;  ///< true if the node has such a point

  Tree(std::shared_ptr<const ContactSurface> surface_, ConstVectors positions)
      : surface(std::move(surface_)) {
    const std::size_t count = surface->triangles().size();
    order.resize(count);
    std::iota(order.begin(), order.end(), 0);
    std::vector<Vec3> centres(count);
    for (std::size_t t = 0; t < count; ++t) {
      const Vec3i& c = surface->triangles()[t];
      Vec3 low = positions[static_cast<std::size_t>(c[0])], high = low;
      for (int i = 1; i < 3; ++i) {
        low = low.cwiseMin(positions[static_cast<std::size_t>(c[i])]);
        high = high.cwiseMax(positions[static_cast<std::size_t>(c[i])]);
      }
      centres[t] = (low + high) / 2;
    }
    if (count > 0) build(centres, 0, static_cast<int>(count));
    for (const ContactBody& body : surface->bodies()) ask_bodies |= body.fixed || !body.self_contact;
    lone.assign(surface->point_count(), 0);
    for (const Vec3i& t : surface->triangles()) {
      if (t[0] != t[1] || t[1] != t[2]) continue;
      lone[static_cast<std::size_t>(t[0])] = 1;
      ask_points = true;
    }
    node_boxes.resize(nodes.size());
    for (auto& boxes : point_boxes) boxes.resize(surface->point_count());
    make_tasks();
  }

  int build(const std::vector<Vec3>& centres, int begin, int end) {
    const int index = static_cast<int>(nodes.size());
    nodes.emplace_back();
    if (end - begin <= leaf_size) {
      nodes.back().leaf = static_cast<int>(groups.leaves.size());
      add_leaf(begin, end);
      return index;
    }
    Box box;
    for (int i = begin; i < end; ++i)
      box.extend(centres[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])]);
    int axis = 0;
    box.sizes().maxCoeff(&axis);
    const int leaves = (end - begin + leaf_size - 1) / leaf_size;
    const int middle = begin + (leaves + 1) / 2 * leaf_size;
    std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end, [&](int a, int b) {
      const double p = centres[static_cast<std::size_t>(a)][axis];
      const double q = centres[static_cast<std::size_t>(b)][axis];
      return p != q ? p < q : a < b;
    });
    build(centres, begin, middle);
    const int right = build(centres, middle, end);
    nodes[static_cast<std::size_t>(index)].right = right;
    return index;
  }

  /// Puts a feature into the last group from `first` on, or a new one.
  static void append(FeatureGroups& all, int first, int& used, int id, std::initializer_list<int> points) {
    if (used % lane_count == 0) all.lanes.emplace_back(), all.ends.emplace_back();
    FeatureLanes& lanes = all.lanes[static_cast<std::size_t>(first + used / lane_count)];
    const int lane = used++ % lane_count;
    lanes.id[lane] = id;
    int k = 0;
    for (const int p : points) lanes.points[k++][lane] = p;
  }

  void add_leaf(int begin, int end) {
    Leaf leaf;
    leaf.first_points = static_cast<int>(groups.points.lanes.size());
    leaf.first_edges = static_cast<int>(groups.edges.lanes.size());
    const int first_triangles = static_cast<int>(groups.triangles.lanes.size());
    int points = 0, edges = 0, triangles = 0;
    for (int i = begin; i < end; ++i) {
      const int triangle = order[static_cast<std::size_t>(i)];
      const auto t = static_cast<std::size_t>(triangle);
      const Vec3i& c = surface->triangles()[t];
      append(groups.triangles, first_triangles, triangles, triangle, {c[0], c[1], c[2]});
      const ContactSurface::Ownership own = surface->ownership()[t];
      for (int k = 0; k < 3; ++k) {
        if ((own.vertices >> k & 1) != 0) append(groups.points, leaf.first_points, points, c[k], {c[k]});
        if ((own.edges >> k & 1) == 0) continue;
        const int e = surface->triangle_edges()[t][k];
        const ContactSurface::Edge& ends = surface->edges()[static_cast<std::size_t>(e)];
        append(groups.edges, leaf.first_edges, edges, e, {ends[0], ends[1]});
      }
    }
    leaf.last_points = static_cast<int>(groups.points.lanes.size());
    leaf.last_edges = static_cast<int>(groups.edges.lanes.size());
    groups.leaves.push_back(leaf);
  }

  bool is_leaf(int node) const { return nodes[static_cast<std::size_t>(node)].right < 0; }
  int right(int node) const { return nodes[static_cast<std::size_t>(node)].right; }

  /// Calls push for the child pairs that replace (a, b).
  template <class Push>
  void descend(NodePair pair, const Push& push) const {
    const auto [a, b] = pair;
    if (a == b) {
      push(NodePair{a + 1, a + 1});
      push(NodePair{right(a), right(a)});
      push(NodePair{a + 1, right(a)});
    } else if (is_leaf(a)) {
      push(NodePair{a, b + 1});
      push(NodePair{a, right(b)});
    } else if (is_leaf(b)) {
      push(NodePair{a + 1, b});
      push(NodePair{right(a), b});
    } else {
      push(NodePair{a + 1, b + 1});
      push(NodePair{a + 1, right(b)});
      push(NodePair{right(a), b + 1});
      push(NodePair{right(a), right(b)});
    }
  }

  /// Splits the traversal into tasks, by the shape of the tree alone.
  void make_tasks() {
    std::vector<NodePair> level;
    if (!nodes.empty()) level.push_back({0, 0});
    constexpr std::size_t enough = 64;
    for (bool grew = true; grew && level.size() < enough;) {
      grew = false;
      std::vector<NodePair> next;
      for (const NodePair& pair : level) {
        if (is_leaf(pair.a) && is_leaf(pair.b)) {
          next.push_back(pair);
          continue;
        }
        descend(pair, [&](NodePair p) { next.push_back(p); });
        grew = true;
      }
      level = std::move(next);
    }
    tasks.resize(level.size());
    for (std::size_t i = 0; i < level.size(); ++i) tasks[i].root = level[i];
  }

  void fit(const MovingBoxes& boxes, double reach) {
    ends = boxes.moving() ? 2 : 1;
    for (int end = 0; end < ends; ++end) fit_end(boxes.at(end), end, reach);
    find_moved_nodes();
  }

  void fit_end(const std::vector<PointBox>& boxes, int e, double reach) {
    std::vector<FloatBox>& points = point_boxes[e];
    parallel_for(points.size(), search_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        if (!moved.empty() && moved[p] == 0) continue;
        const double pad = surface->radius_of(static_cast<int>(p)) + reach / 2;
        FloatBox& box = points[p];
        const Vec3 &low = boxes[p].lower, &high = boxes[p].upper;
        box.low =
            Float4{rounded_down(low[0] - pad), rounded_down(low[1] - pad), rounded_down(low[2] - pad), 0};
        box.high = Float4{rounded_up(high[0] + pad), rounded_up(high[1] + pad), rounded_up(high[2] + pad), 0};
      }
    });
    const auto fit_lanes = [&](FeatureGroups& all, int points_each) {
      parallel_for(all.lanes.size(), search_grain / lane_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t g = begin; g < end; ++g) {
          const FeatureLanes& lanes = all.lanes[g];
          if (!moved.empty() && !has_moved(lanes, points_each)) continue;
          BoxLanes& boxes = all.boxes(e, g);
          for (int i = 0; i < lane_count && lanes.id[i] >= 0; ++i) {
            FloatBox box = points[static_cast<std::size_t>(lanes.points[0][i])];
            for (int k = 1; k < points_each; ++k)
              box.extend(points[static_cast<std::size_t>(lanes.points[k][i])]);
            boxes.set(i, box);
          }
        }
      });
    };
    fit_lanes(groups.points, 1);
    fit_lanes(groups.edges, 2);
    fit_lanes(groups.triangles, 3);
    // Children come after their parents.
    for (std::size_t n = nodes.size(); n-- > 0;) {
      const Node& node = nodes[n];
      FloatBox box;
      if (node.right < 0) {
        const auto l = static_cast<std::size_t>(node.leaf);
        const BoxLanes& lanes = groups.triangles.boxes(e, l);
        for (int i = 0; i < lane_count; ++i) {
          box.extend({Float4{lanes.low[0][i], lanes.low[1][i], lanes.low[2][i], 0},
                      Float4{lanes.high[0][i], lanes.high[1][i], lanes.high[2][i], 0}});
        }
        groups.leaves[l].box.ends[e] = box;
      } else {
        box = node_boxes[n + 1].ends[e];
        box.extend(node_boxes[static_cast<std::size_t>(node.right)].ends[e]);
      }
      node_boxes[n].ends[e] = box;
    }
  }

  /// Boxes separated along an axis at both ends, on the same side, are separated in between.
  bool overlap(int a, int b) const {
    const FloatBox *const p = node_boxes[static_cast<std::size_t>(a)].ends,
                          *const q = node_boxes[static_cast<std::size_t>(b)].ends;
    Int4 above = p[0].low > q[0].high, below = q[0].low > p[0].high;
    if (ends == 2) above &= p[1].low > q[1].high, below &= q[1].low > p[1].high;
    return !any(above | below);
  }

  bool has_moved(int point) const { return moved[static_cast<std::size_t>(point)] != 0; }
  bool has_moved(const FeatureLanes& lanes, int points_each) const {
    for (int i = 0; i < lane_count && lanes.id[i] >= 0; ++i)
      for (int k = 0; k < points_each; ++k)
        if (has_moved(lanes.points[k][i])) return true;
    return false;
  }

  void find_moved_nodes() {
    if (moved.empty()) return;
    node_moved.resize(nodes.size());
    for (std::size_t n = nodes.size(); n-- > 0;) {
      const Node& node = nodes[n];
      if (node.right >= 0) {
        node_moved[n] = node_moved[n + 1] | node_moved[static_cast<std::size_t>(node.right)];
        continue;
      }
      node_moved[n] = has_moved(groups.triangles.lanes[static_cast<std::size_t>(node.leaf)], 3) ? 1 : 0;
    }
  }
  bool concerns(const NodePair& pair) const {
    return moved.empty() ||
           (node_moved[static_cast<std::size_t>(pair.a)] | node_moved[static_cast<std::size_t>(pair.b)]) != 0;
  }

  void leave_out_unmoved(FeaturePairs& found) const {
    if (moved.empty()) return;
    std::erase_if(found.vertex_triangle, [&](const VertexTriangle& pair) {
      const Vec3i& t = surface->triangles()[static_cast<std::size_t>(pair.triangle)];
      return !has_moved(pair.point) && !has_moved(t[0]) && !has_moved(t[1]) && !has_moved(t[2]);
    });
    std::erase_if(found.edge_edge, [&](const EdgeEdge& pair) {
      const auto &e = surface->edges()[static_cast<std::size_t>(pair.first)],
                 &f = surface->edges()[static_cast<std::size_t>(pair.second)];
      return !has_moved(e[0]) && !has_moved(e[1]) && !has_moved(f[0]) && !has_moved(f[1]);
    });
  }

  /// Pairs that boxes cannot exclude: bodies that may not touch, and a vertex against a lone point, which is
  /// also found as that point against the vertex's triangles.
  bool unwanted(int p, int q) const {
    return ask_bodies && !surface->may_touch(surface->body_of(p), surface->body_of(q));
  }
  bool is_lone(int p) const {
    return lone[static_cast<std::size_t>(p)] != 0 && surface->triangles_at_point(p).size() == 1;
  }

  void leave_out_unwanted(FeaturePairs& found) const {
    if (!ask_bodies && !ask_points) return;
    std::erase_if(found.vertex_triangle, [&](const VertexTriangle& pair) {
      const Vec3i& t = surface->triangles()[static_cast<std::size_t>(pair.triangle)];
      return unwanted(pair.point, t[0]) || (t[0] == t[1] && t[1] == t[2] && !is_lone(pair.point));
    });
    std::erase_if(found.edge_edge, [&](const EdgeEdge& pair) {
      return unwanted(surface->edges()[static_cast<std::size_t>(pair.first)][0],
                      surface->edges()[static_cast<std::size_t>(pair.second)][0]);
    });
  }

  void run(Task& task) const {
    task.leaves.clear();
    task.stack.assign(1, task.root);
    while (!task.stack.empty()) {
      const NodePair pair = task.stack.back();
      task.stack.pop_back();
      if (!concerns(pair)) continue;
      if (pair.a != pair.b && !overlap(pair.a, pair.b)) continue;
      if (is_leaf(pair.a) && is_leaf(pair.b)) {
        task.leaves.push_back(
            {nodes[static_cast<std::size_t>(pair.a)].leaf, nodes[static_cast<std::size_t>(pair.b)].leaf});
      } else {
        descend(pair, [&](NodePair p) { task.stack.push_back(p); });
      }
    }
    (ends == 2 ? compare_moving_leaves : compare_leaves)(groups, task.leaves, task.found);
    leave_out_unwanted(task.found);
    leave_out_unmoved(task.found);
  }
};

PairSearch::PairSearch(std::shared_ptr<const ContactSurface> surface, ConstVectors positions) {
  if (positions.size() != surface->point_count())
    throw Error(ErrorKind::usage, "a contact search needs one position for each point", "give #P positions");
  tree_ = std::make_unique<Tree>(std::move(surface), positions);
}
PairSearch::~PairSearch() = default;
PairSearch::PairSearch(PairSearch&&) noexcept = default;
PairSearch& PairSearch::operator=(PairSearch&&) noexcept = default;

void PairSearch::find(const MovingBoxes& boxes, double reach, FeaturePairs& found,
                      std::span<const std::uint8_t> moved) {
  Tree& tree = *tree_;
  tree.moved = moved;
  tree.fit(boxes, reach);
  parallel_for(tree.tasks.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) tree.run(tree.tasks[i]);
  });
  found.vertex_triangle.clear();
  found.edge_edge.clear();
  for (const Tree::Task& task : tree.tasks) {
    const FeaturePairs& part = task.found;
    found.vertex_triangle.insert(found.vertex_triangle.end(), part.vertex_triangle.begin(),
                                 part.vertex_triangle.end());
    found.edge_edge.insert(found.edge_edge.end(), part.edge_edge.begin(), part.edge_edge.end());
  }
}

}  // namespace muslin
