#include "muslin/geometry/orientation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <tuple>

#include "muslin/core/index.hpp"
#include "muslin/geometry/winding_number.hpp"

namespace muslin {
namespace {

// Disjoint sets of faces that also store whether a face runs with or against the root of its set.
class OrientedSets {
 public:
  explicit OrientedSets(std::size_t count) : parent_(count), against_(count, 0), orientable_(count, 1) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  struct Root {
    int face;
    char against;
  };
  Root find(int face) {
    int root = face;
    char against = 0;
    while (parent_[at(root)] != root) {
      against ^= against_[at(root)];
      root = parent_[at(root)];
    }
    const Root found{root, against};
    while (parent_[at(face)] != root && face != root) {  // shorten the path
      const int next = parent_[at(face)];
      const char next_against = static_cast<char>(against ^ against_[at(face)]);
      parent_[at(face)] = root;
      against_[at(face)] = against;
      face = next;
      against = next_against;
    }
    return found;
  }

  void join(int f, int g, bool opposed) {
    const Root a = find(f), b = find(g);
    const char against = static_cast<char>(a.against ^ b.against ^ (opposed ? 1 : 0));
    if (a.face == b.face) {
      if (against) orientable_[at(a.face)] = 0;
      return;
    }
    const int root = std::min(a.face, b.face), child = std::max(a.face, b.face);
    parent_[at(child)] = root;
    against_[at(child)] = against;
    orientable_[at(root)] = static_cast<char>(orientable_[at(root)] & orientable_[at(child)]);
  }

  bool orientable(int root) const { return orientable_[at(root)] != 0; }

 private:
  std::vector<int> parent_;
  std::vector<char> against_;  // relative to the parent
  std::vector<char> orientable_;
};

// Returns the vertex of smallest index at the same position.
std::vector<int> weld(ConstVectors positions) {
  std::vector<int> order(positions.size()), first(positions.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int v) {
    const Vec3& p = positions[static_cast<std::size_t>(v)];
    return std::tuple(p.x(), p.y(), p.z());
  };
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return std::pair(key(a), a) < std::pair(key(b), b); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && key(order[i]) == key(order[i - 1]);
    first[static_cast<std::size_t>(order[i])] =
        same ? first[static_cast<std::size_t>(order[i - 1])] : order[i];
  }
  return first;
}

// A part of the mesh connected through edges of any kind.
struct Component {
  double area = 0;
  double volume = 0;  // about its own centre
  Vec3 centre = Vec3::Zero();
  double largest_triangle = -1;
  Vec3 point = Vec3::Zero();  // in the middle of its largest triangle

  // The volume of flat components is rounding error.
  bool negative(double sign) const { return sign * volume < -1e-9 * area * std::sqrt(area); }
};

std::vector<int> find_components(std::span<const EdgeUse> uses, std::size_t face_count, std::size_t& count) {
  OrientedSets sets(face_count);
  for (std::size_t i = 1; i < uses.size(); ++i)
    if (uses[i].low == uses[i - 1].low && uses[i].high == uses[i - 1].high)
      sets.join(uses[i - 1].face, uses[i].face, false);
  std::vector<int> component(face_count);
  count = 0;
  for (std::size_t f = 0; f < face_count; ++f) {
    const int root = sets.find(static_cast<int>(f)).face;
    component[f] =
        root == static_cast<int>(f) ? static_cast<int>(count++) : component[static_cast<std::size_t>(root)];
  }
  return component;
}

// Returns true if each edge is traversed equally often in both directions.
bool balanced(std::span<const EdgeUse> uses, const std::vector<char>& turn) {
  bool result = true;
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    int balance = 0;
    for (const EdgeUse& use : edge)
      balance += use.ascends != (turn[static_cast<std::size_t>(use.face)] != 0) ? 1 : -1;
    if (balance != 0) result = false;
  });
  return result;
}

// Returns 1 for the triangles to flip so that each patch has the orientation of most of its area.
std::vector<char> turn_within_patches(std::span<const EdgeUse> uses, const std::vector<double>& areas) {
  const Patches patches = find_patches(uses, areas.size());
  std::vector<double> against(patches.orientable.size(), 0);
  for (std::size_t t = 0; t < areas.size(); ++t)
    against[static_cast<std::size_t>(patches.patch[t])] += patches.turned[t] ? areas[t] : -areas[t];
  std::vector<char> turn(areas.size(), 0);
  for (std::size_t t = 0; t < areas.size(); ++t) {
    const auto p = static_cast<std::size_t>(patches.patch[t]);
    if (patches.orientable[p]) turn[t] = (patches.turned[t] != 0) != (against[p] > 0);
  }
  return turn;
}

}  // namespace

Patches find_patches(std::span<const EdgeUse> uses, std::size_t face_count) {
  OrientedSets sets(face_count);
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() == 2 && edge[0].face != edge[1].face)
      sets.join(edge[0].face, edge[1].face, edge[0].ascends == edge[1].ascends);
  });
  Patches patches;
  patches.patch.resize(face_count);
  patches.turned.resize(face_count);
  for (std::size_t f = 0; f < face_count; ++f) {
    const auto root = sets.find(static_cast<int>(f));
    if (root.face == static_cast<int>(f)) {  // a root is the first face of its patch
      patches.patch[f] = static_cast<int>(patches.orientable.size());
      patches.orientable.push_back(sets.orientable(root.face) ? 1 : 0);
    } else {
      patches.patch[f] = patches.patch[static_cast<std::size_t>(root.face)];
    }
    patches.turned[f] = root.against;
  }
  return patches;
}

OrientedTriangles orient(ConstVectors positions, std::span<const Vec3i> triangles) {
  const std::vector<int> first = weld(positions);
  Topology welded;
  welded.face_offsets.resize(triangles.size() + 1);
  welded.face_vertices.resize(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    welded.face_offsets[t + 1] = static_cast<int>(3 * (t + 1));
    for (int k = 0; k < 3; ++k)
      welded.face_vertices[3 * t + static_cast<std::size_t>(k)] =
          first[static_cast<std::size_t>(triangles[t][k])];
  }
  const std::vector<EdgeUse> uses = edge_uses(welded);

  const auto corner = [&](std::size_t t, int k) -> const Vec3& {
    return positions[static_cast<std::size_t>(triangles[t][k])];
  };
  std::vector<Vec3> area_vectors(triangles.size());
  std::vector<double> areas(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    area_vectors[t] = 0.5 * (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0));
    areas[t] = area_vectors[t].norm();
  }
  std::vector<char> turn = turn_within_patches(uses, areas);

  std::size_t component_count = 0;
  const std::vector<int> component_of = find_components(uses, triangles.size(), component_count);
  std::vector<Component> components(component_count);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    Component& component = components[static_cast<std::size_t>(component_of[t])];
    const Vec3 centre = (corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3;
    component.area += areas[t];
    component.centre += areas[t] * centre;
    if (areas[t] > component.largest_triangle) {
      component.largest_triangle = areas[t];
      component.point = centre;
    }
  }
  for (Component& component : components)
    if (component.area > 0) component.centre /= component.area;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    Component& component = components[static_cast<std::size_t>(component_of[t])];
    const double volume = area_vectors[t].dot(corner(t, 0) - component.centre) / 3;
    component.volume += turn[t] ? -volume : volume;
  }
  double total = 0;
  for (const Component& component : components) total += component.volume;
  const double sign = total < 0 ? -1 : 1;

  const auto oriented = [&](std::size_t t) {
    const Vec3i& triangle = triangles[t];
    return turn[t] ? Vec3i(triangle.x(), triangle.z(), triangle.y()) : triangle;
  };
  std::vector<Vec3i> positive;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    turn[t] = (turn[t] != 0) != (sign < 0);
    if (!components[static_cast<std::size_t>(component_of[t])].negative(sign))
      positive.push_back(oriented(t));
  }
  if (positive.size() < triangles.size()) {
    const WindingNumber around(positions, positive);
    std::vector<char> turn_component(components.size(), 0);
    for (std::size_t c = 0; c < components.size(); ++c)
      if (components[c].negative(sign)) turn_component[c] = around(components[c].point) < 0.5;
    for (std::size_t t = 0; t < triangles.size(); ++t)
      turn[t] ^= turn_component[static_cast<std::size_t>(component_of[t])];
  }

  OrientedTriangles result;
  result.watertight = balanced(uses, turn);
  result.triangles.reserve(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) result.triangles.push_back(oriented(t));
  return result;
}

}  // namespace muslin
