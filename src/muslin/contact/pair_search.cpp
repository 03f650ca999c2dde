#include "muslin/contact/pair_search.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <numeric>
#include <utility>

#include "muslin/contact/float_box.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/core/vector_code.hpp"

namespace muslin {
namespace {

constexpr int leaf_size = 8;
constexpr std::size_t grain = 4096;

struct LeafPair {
  int a, b;  ///< first slots
};

/// The boxes of eight triangles, one array for each side.
struct LeafBoxes {
  alignas(32) float low[3][leaf_size], high[3][leaf_size];
};

/// bits[i] bit j: triangle i of leaf a overlaps triangle j of leaf b.
MUSLIN_INLINE void compare_leaves(const LeafBoxes& a, const LeafBoxes& b, std::uint8_t* bits) {
  for (int i = 0; i < leaf_size; ++i) {
    std::uint32_t row = 0;
    for (int j = 0; j < leaf_size; ++j) {
      const bool hit = (a.low[0][i] <= b.high[0][j]) & (b.low[0][j] <= a.high[0][i]) &
                       (a.low[1][i] <= b.high[1][j]) & (b.low[1][j] <= a.high[1][i]) &
                       (a.low[2][i] <= b.high[2][j]) & (b.low[2][j] <= a.high[2][i]);
      row |= static_cast<std::uint32_t>(hit) << j;
    }
    bits[i] = static_cast<std::uint8_t>(row);
  }
}

MUSLIN_VECTOR_CODE
void compare_all_leaves(const LeafBoxes* leaves, const LeafPair* pairs, std::size_t count,
                        std::uint8_t* bits) {
  for (std::size_t k = 0; k < count; ++k)
    compare_leaves(leaves[pairs[k].a], leaves[pairs[k].b], bits + leaf_size * k);
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
  /// What a thread needs for a task; kept from call to call.
  struct Task {
    NodePair root{};
    std::vector<NodePair> stack;
    std::vector<LeafPair> leaves;
    std::vector<std::uint8_t> bits;
    FeaturePairs found;
  };
  /// A triangle in the order of the tree, with what it owns.
  struct Slot {
    int triangle = -1;
    int body = -1;
    std::int8_t points = 0, edges = 0;  ///< how many it owns
    bool is_point = false;              ///< (a, a, a)
    int first_point = 0, first_edge = 0;
    Vec3i corners = Vec3i::Constant(-1);
  };

  std::shared_ptr<const ContactSurface> surface;
  bool ask_bodies = false;
  std::vector<Node> nodes;
  std::vector<Slot> slots;
  std::vector<int> points, edges;          ///< owned ones, in the order of the slots
  std::vector<ContactSurface::Edge> ends;  ///< of the owned edges
  std::vector<Task> tasks;

  std::vector<FloatBox> node_boxes, slot_boxes, owned_point_boxes, owned_edge_boxes, point_boxes;
  std::vector<LeafBoxes> leaf_boxes;

  Tree(std::shared_ptr<const ContactSurface> surface_, ConstVectors positions)
      : surface(std::move(surface_)) {
    const std::size_t count = surface->triangles().size();
    std::vector<int> order(count);
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
    if (count > 0) build(centres, order, 0, static_cast<int>(count));
    number_features();
    for (const ContactBody& body : surface->bodies()) ask_bodies |= body.fixed || !body.self_contact;
    node_boxes.resize(nodes.size());
    slot_boxes.resize(slots.size());
    leaf_boxes.resize(slots.size() / leaf_size);
    owned_point_boxes.resize(points.size());
    owned_edge_boxes.resize(edges.size());
    point_boxes.resize(surface->point_count());
    make_tasks();
  }

  int build(const std::vector<Vec3>& centres, std::vector<int>& order, int begin, int end) {
    const int index = static_cast<int>(nodes.size());
    nodes.emplace_back();
    if (end - begin <= leaf_size) {
      nodes.back().leaf = static_cast<int>(slots.size()) / leaf_size;
      for (int i = 0; i < leaf_size; ++i) {
        Slot slot;
        if (begin + i < end) {
          slot.triangle = order[static_cast<std::size_t>(begin + i)];
          const Vec3i& c = surface->triangles()[static_cast<std::size_t>(slot.triangle)];
          slot.body = surface->body_of(c[0]);
          slot.is_point = c[0] == c[1] && c[1] == c[2];
          slot.corners = c;
        }
        slots.push_back(slot);
      }
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
      const double p = centres[static_cast<std::size_t>(a)][axis],
                   q = centres[static_cast<std::size_t>(b)][axis];
      return p != q ? p < q : a < b;
    });
    build(centres, order, begin, middle);
    const int right = build(centres, order, middle, end);
    nodes[static_cast<std::size_t>(index)].right = right;
    return index;
  }

  void number_features() {
    for (Slot& slot : slots) {
      slot.first_point = static_cast<int>(points.size());
      slot.first_edge = static_cast<int>(edges.size());
      if (slot.triangle < 0) continue;
      const auto t = static_cast<std::size_t>(slot.triangle);
      const ContactSurface::Ownership own = surface->ownership()[t];
      for (int i = 0; i < 3; ++i) {
        if ((own.vertices >> i & 1) != 0) points.push_back(surface->triangles()[t][i]);
        if ((own.edges >> i & 1) != 0) edges.push_back(surface->triangle_edges()[t][i]);
      }
      for (std::size_t e = static_cast<std::size_t>(slot.first_edge); e < edges.size(); ++e)
        ends.push_back(surface->edges()[static_cast<std::size_t>(edges[e])]);
      slot.points = static_cast<std::int8_t>(static_cast<int>(points.size()) - slot.first_point);
      slot.edges = static_cast<std::int8_t>(static_cast<int>(edges.size()) - slot.first_edge);
    }
  }

  bool is_leaf(int node) const { return nodes[static_cast<std::size_t>(node)].right < 0; }
  int right(int node) const { return nodes[static_cast<std::size_t>(node)].right; }

  /// The pairs to go on with instead of (a, b).
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

  /// Cuts the descent into tasks, by the shape of the tree alone.
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

  void fit(ConstVectors lower, ConstVectors upper, double reach) {
    parallel_for(point_boxes.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        const double pad = surface->radius_of(static_cast<int>(p)) + reach / 2;
        FloatBox& box = point_boxes[p];
        const Vec3 &low = lower[p], &high = upper[p];
        box.low =
            Float4{rounded_down(low[0] - pad), rounded_down(low[1] - pad), rounded_down(low[2] - pad), 0};
        box.high = Float4{rounded_up(high[0] + pad), rounded_up(high[1] + pad), rounded_up(high[2] + pad), 0};
      }
    });
    const auto point_box = [&](int p) -> const FloatBox& { return point_boxes[static_cast<std::size_t>(p)]; };
    parallel_for(leaf_boxes.size(), grain / leaf_size, [&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin * leaf_size; s < end * leaf_size; ++s) {
        const Slot& slot = slots[s];
        FloatBox box;
        if (slot.triangle >= 0) {
          const Vec3i& c = surface->triangles()[static_cast<std::size_t>(slot.triangle)];
          box = point_box(c[0]);
          box.extend(point_box(c[1]));
          box.extend(point_box(c[2]));
        }
        slot_boxes[s] = box;
        LeafBoxes& leaf = leaf_boxes[s / leaf_size];
        for (std::size_t k = 0; k < 3; ++k) {
          leaf.low[k][s % leaf_size] = box.low[k];
          leaf.high[k][s % leaf_size] = box.high[k];
        }
      }
    });
    parallel_for(points.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) owned_point_boxes[i] = point_box(points[i]);
    });
    parallel_for(edges.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const ContactSurface::Edge& e = surface->edges()[static_cast<std::size_t>(edges[i])];
        FloatBox box = point_box(e[0]);
        box.extend(point_box(e[1]));
        owned_edge_boxes[i] = box;
      }
    });
    // Children come after their parents.
    for (std::size_t n = nodes.size(); n-- > 0;) {
      const Node& node = nodes[n];
      FloatBox box;
      if (node.right < 0) {
        const std::size_t first = static_cast<std::size_t>(node.leaf) * leaf_size;
        for (std::size_t s = first; s < first + leaf_size; ++s) box.extend(slot_boxes[s]);
      } else {
        box = node_boxes[n + 1];
        box.extend(node_boxes[static_cast<std::size_t>(node.right)]);
      }
      node_boxes[n] = box;
    }
  }

  static bool is_corner(int p, const Slot& slot) {
    return (slot.corners[0] == p) | (slot.corners[1] == p) | (slot.corners[2] == p);
  }

  /// Owned points of slot a against the triangle of slot b.
  void points_against_triangle(const Slot& a, std::size_t b, FeaturePairs& found) const {
    const FloatBox& box = slot_boxes[b];
    const Slot& other = slots[b];
    // A vertex meets a lone point as that point meets the vertex's triangles.
    if (other.is_point && !a.is_point) return;
    for (int i = a.first_point; i < a.first_point + a.points; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (overlap(owned_point_boxes[k], box) && !is_corner(points[k], other))
        found.vertex_triangle.push_back({points[k], other.triangle});
    }
  }

  void compare_slots(std::size_t i, std::size_t j, FeaturePairs& found) const {
    const Slot &a = slots[i], &b = slots[j];
    if (ask_bodies && !surface->may_touch(a.body, b.body)) return;
    points_against_triangle(a, j, found);
    points_against_triangle(b, i, found);
    for (int p = a.first_edge; p < a.first_edge + a.edges; ++p) {
      const FloatBox& box = owned_edge_boxes[static_cast<std::size_t>(p)];
      const ContactSurface::Edge& e = ends[static_cast<std::size_t>(p)];
      for (int q = b.first_edge; q < b.first_edge + b.edges; ++q) {
        const ContactSurface::Edge& f = ends[static_cast<std::size_t>(q)];
        const bool share = (e[0] == f[0]) | (e[0] == f[1]) | (e[1] == f[0]) | (e[1] == f[1]);
        if (share | !overlap(box, owned_edge_boxes[static_cast<std::size_t>(q)])) continue;
        const int first = edges[static_cast<std::size_t>(p)], second = edges[static_cast<std::size_t>(q)];
        found.edge_edge.push_back({std::min(first, second), std::max(first, second)});
      }
    }
  }

  void run(Task& task) const {
    task.found.vertex_triangle.clear();
    task.found.edge_edge.clear();
    task.leaves.clear();
    task.stack.assign(1, task.root);
    while (!task.stack.empty()) {
      const NodePair pair = task.stack.back();
      task.stack.pop_back();
      if (pair.a != pair.b && !overlap(node_boxes[static_cast<std::size_t>(pair.a)],
                                       node_boxes[static_cast<std::size_t>(pair.b)]))
        continue;
      if (is_leaf(pair.a) && is_leaf(pair.b)) {
        task.leaves.push_back(
            {nodes[static_cast<std::size_t>(pair.a)].leaf, nodes[static_cast<std::size_t>(pair.b)].leaf});
      } else {
        descend(pair, [&](NodePair p) { task.stack.push_back(p); });
      }
    }
    task.bits.resize(task.leaves.size() * leaf_size);
    compare_all_leaves(leaf_boxes.data(), task.leaves.data(), task.leaves.size(), task.bits.data());
    for (std::size_t k = 0; k < task.leaves.size(); ++k) {
      const auto [a, b] = task.leaves[k];
      for (unsigned i = 0; i < leaf_size; ++i) {
        unsigned row = task.bits[k * leaf_size + i];
        if (a == b) row &= ~((2U << i) - 1);  // each pair within a leaf once
        for (; row != 0; row &= row - 1) {
          const auto j = static_cast<unsigned>(std::countr_zero(row));
          compare_slots(static_cast<std::size_t>(a) * leaf_size + i,
                        static_cast<std::size_t>(b) * leaf_size + j, task.found);
        }
      }
    }
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

void PairSearch::find(ConstVectors lower, ConstVectors upper, double reach, FeaturePairs& found) {
  Tree& tree = *tree_;
  tree.fit(lower, upper, reach);
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
