#include "muslin/simulation/model_parts.hpp"

#include <algorithm>
#include <limits>
#include <map>

namespace muslin {
namespace {

/// A rigid body does not bend, so that its fall in a step matters relative to the largest moving body, not to
/// its own size.
void give_rigid_bodies_the_largest_size(const Model& model, ModelParts& parts) {
  double largest = 0;
  const auto part_of = [&](const Component& body) {
    return static_cast<std::size_t>(parts.of_vertex[static_cast<std::size_t>(body.first_vertex)]);
  };
  for (const Component& body : model.bodies)
    if (body.vertex_count > 0 && !body.is_prescribed())
      largest = std::max(largest, parts.sizes[part_of(body)]);
  for (const Component& body : model.bodies)
    if (body.vertex_count > 0 && !body.deforms() && !body.is_prescribed())
      parts.sizes[part_of(body)] = largest;
}

}  // namespace

ModelParts find_parts(const Model& model) {
  const std::size_t count = model.vertex_count();
  constexpr int loose = -1;
  // The parts of components are told apart by their first vertices.
  std::vector<int> label_of(count, loose);
  std::vector<double> edge_of(count, 0.0), longest_of(count, std::numeric_limits<double>::infinity());
  for (const Component& body : model.bodies) {
    const auto first = static_cast<std::size_t>(body.first_vertex),
               size = static_cast<std::size_t>(body.vertex_count);
    const std::vector<int> labels = body.parts();
    std::map<int, int> first_of;
    for (std::size_t v = 0; v < size; ++v)
      label_of[first + v] = first_of.try_emplace(labels[v], static_cast<int>(first + v)).first->second;
    std::fill_n(edge_of.begin() + body.first_vertex, size, body.spacing());
    std::fill_n(longest_of.begin() + body.first_vertex, size, body.longest_step());
  }
  ModelParts parts;
  parts.of_vertex.resize(count);
  std::vector<int> number(count, -1);  // of the part that begins at a vertex
  int number_of_loose = -1;
  std::vector<Box> bounds;
  for (std::size_t v = 0; v < count; ++v) {
    int& part = label_of[v] == loose ? number_of_loose : number[static_cast<std::size_t>(label_of[v])];
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
