#include "muslin/simulation/model_parts.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace muslin {
namespace {

/// The linear solver works in single precision while ‖block‖ dt² / mass is below 3e5. In units of
/// BodyStatistics::stable_step, which is 2/√ratio or less, that is a step of this length.
constexpr double stable_steps = 150;
/// The longest step of a rigid body in single precision [s]; its stiffness is that of build_materials.cpp.
constexpr double longest_rigid = 1.0 / 16;

/// A rigid body does not bend, so that its fall in a step matters relative to the largest moving body, not to its
/// own size.
void give_rigid_bodies_the_largest_size(const Model& model, ModelParts& parts) {
  double largest = 0;
  const auto part_of = [&](const Body& body) {
    return static_cast<std::size_t>(parts.of_vertex[static_cast<std::size_t>(body.first_vertex)]);
  };
  for (const Body& body : model.bodies)
    if (!body.prescribed) largest = std::max(largest, parts.sizes[part_of(body)]);
  for (const Body& body : model.bodies)
    if (body.is_rigid() && !body.prescribed) parts.sizes[part_of(body)] = largest;
}

class Joined {
 public:
  explicit Joined(std::size_t count) : above_(count) { std::iota(above_.begin(), above_.end(), 0); }
  int of(int v) {
    while (above_[index(v)] != v) v = above_[index(v)] = above_[index(above_[index(v)])];
    return v;
  }
  void join(int a, int b) {
    a = of(a), b = of(b);
    above_[index(std::max(a, b))] = std::min(a, b);
  }

 private:
  static std::size_t index(int v) { return static_cast<std::size_t>(v); }
  std::vector<int> above_;
};

void join_body(const Body& body, Joined& joined) {
  const int first = body.first_vertex;
  if (body.is_shell()) {
    for (const Vec3i& t : body.shell.triangles) {
      joined.join(first + t[0], first + t[1]);
      joined.join(first + t[1], first + t[2]);
    }
  } else if (body.has_lattice()) {
    for (const SpringRun& run : body.springs.runs)
      for (int i = 0; i < run.length; ++i) joined.join(first + run.a + i, first + run.b + i);
  } else {
    for (int v = 1; v < body.vertex_count; ++v) joined.join(first, first + v);
  }
}

}  // namespace

ModelParts find_parts(const Model& model) {
  const std::size_t count = model.vertex_count();
  Joined joined(count);
  std::vector<double> edge_of(count, 0.0), longest_of(count, std::numeric_limits<double>::infinity());
  std::vector<std::uint8_t> covered(count, 0);
  for (const Body& body : model.bodies) {
    join_body(body, joined);
    const auto first = static_cast<std::size_t>(body.first_vertex), size = static_cast<std::size_t>(body.vertex_count);
    std::fill_n(edge_of.begin() + body.first_vertex, size, body.spacing());
    if (body.is_rigid()) std::fill_n(longest_of.begin() + body.first_vertex, size, longest_rigid);
    if (body.statistics.stable_step > 0)
      std::fill_n(longest_of.begin() + body.first_vertex, size, stable_steps * body.statistics.stable_step);
    std::fill_n(covered.begin() + static_cast<std::ptrdiff_t>(first), size, std::uint8_t{1});
  }
  int loose = -1;
  for (std::size_t v = 0; v < count; ++v) {
    if (covered[v] != 0) continue;
    if (loose >= 0) joined.join(loose, static_cast<int>(v));
    loose = static_cast<int>(v);
  }
  ModelParts parts;
  parts.of_vertex.resize(count);
  std::vector<int> number(count, -1);
  std::vector<Box> bounds;
  for (std::size_t v = 0; v < count; ++v) {
    int& part = number[static_cast<std::size_t>(joined.of(static_cast<int>(v)))];
    if (part < 0) {
      part = static_cast<int>(bounds.size());
      bounds.emplace_back();
      parts.edges.push_back(edge_of[v]);
      parts.longest_steps.push_back(longest_of[v]);
    }
    parts.of_vertex[v] = part;
    bounds[static_cast<std::size_t>(part)].extend(model.rest_positions[v]);
  }
  for (std::size_t p = 0; p < bounds.size(); ++p) {
    parts.sizes.push_back(bounds[p].sizes().norm());
    // Neighbours of a rigid frame are its corners; of a part without a body nothing is known.
    if (!(parts.edges[p] > 0)) parts.edges[p] = parts.sizes[p] > 0 ? parts.sizes[p] / 10 : 1;
  }
  give_rigid_bodies_the_largest_size(model, parts);
  return parts;
}

}  // namespace muslin
