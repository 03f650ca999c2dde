#include "muslin/component/component.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "muslin/component/description.hpp"
#include "muslin/component/select.hpp"
#include "muslin/core/hash.hpp"
#include "muslin/geometry/closest_point.hpp"
#include "muslin/io/mesh_file.hpp"

namespace muslin {
namespace {

/// The linear solver works in single precision while ‖block‖ dt² / mass is below 3e5. In units of
/// BodyStatistics::undamped_step, which is 2/√ratio or less, that is a step of this length.
constexpr double undamped_steps = 150;

}  // namespace

Component::~Component() = default;

std::vector<Vec3> Component::velocities() const {
  return std::vector<Vec3>(static_cast<std::size_t>(vertex_count), Vec3::Zero());
}

std::vector<int> Component::parts() const {
  return std::vector<int>(static_cast<std::size_t>(vertex_count), 0);
}

double Component::longest_step() const { return undamped_steps * statistics.undamped_step; }

void Component::predict(Integrator /*integrator*/, const State& /*state*/,
                        std::span<const std::uint8_t> /*fixed*/, StepContext& /*context*/) const {}

double Component::max_stretch(ConstVectors /*x*/) const { return 1; }

std::vector<std::uint8_t> Component::in_group(const MeshGroup& group) const {
  std::vector<std::uint8_t> member(mesh.vertex_count(), 0);
  for (const int v : group.vertices) member[static_cast<std::size_t>(v)] = 1;
  for (const int f : group.faces) {
    for (const int v : mesh.face(static_cast<std::size_t>(f))) member[static_cast<std::size_t>(v)] = 1;
  }
  return member;
}

std::vector<int> Component::held_vertices(const Selection& where, const std::string& what) const {
  if (selects_vertices()) return select_vertices(*this, where, what);
  std::vector<int> all(static_cast<std::size_t>(vertex_count));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

LoadedVertices Component::loaded_vertices(const std::optional<Selection>& where,
                                          const std::string& what) const {
  if (selects_vertices() && where) return {select_vertices(*this, *where, what), {}};
  LoadedVertices loaded;
  loaded.vertices.resize(static_cast<std::size_t>(vertex_count));
  std::iota(loaded.vertices.begin(), loaded.vertices.end(), 0);
  loaded.shares.assign(loaded.vertices.size(), where ? 0.0 : 1.0 / vertex_count);
  if (!where) return loaded;
  for (const int p : select_vertices(*this, *where, what)) {
    const auto point = static_cast<std::size_t>(p);
    for (std::size_t s = 0; s < 8; ++s)
      loaded.shares[static_cast<std::size_t>(skin.vertices[point][s])] += skin.weights[point][s];
  }
  return loaded;
}

AttachedPoint Component::attach(const Vec3& at) const {
  const std::vector<Vec3i> triangles = triangulate(mesh).triangles;
  const ClosestPoint nearest = ClosestPointQuery(mesh.positions, triangles)(at);
  const Vec3i& triangle = triangles[static_cast<std::size_t>(nearest.triangle)];
  AttachedPoint attached;
  attached.point.vertices.emplace_back().fill(triangle[0]);
  attached.point.weights.emplace_back().fill(0);
  for (int c = 0; c < 3; ++c) {
    attached.point.vertices[0][static_cast<std::size_t>(c)] = triangle[c];
    attached.point.weights[0][static_cast<std::size_t>(c)] = nearest.barycentric[c];
  }
  if (nearest.distance > spacing()) {
    attached.warning =
        fmt::format("lies {:.3g} m from body `{}`; it moves with the nearest point", nearest.distance, name);
  }
  return attached;
}

std::optional<ContactPart> Component::contact_part() const { return std::nullopt; }

std::uint64_t Component::range_hash(std::uint64_t seed, std::int64_t springs) const {
  const std::uint64_t hash = hash_bytes(name.data(), name.size(), seed);
  const std::array<std::int64_t, 3> shape = {first_vertex, vertex_count, springs};
  return hash_bytes(shape.data(), sizeof shape, hash);
}

std::uint64_t Component::shape_hash(std::uint64_t seed) const { return range_hash(seed, 0); }

void Component::write_stages(const std::filesystem::path& folder, const Progress& /*progress*/) const {
  write_mesh(folder / (name + ".skin.obj"), skin_mesh());
}

std::string Component::description_json() const {
  const nlohmann::ordered_json json = {
      {"name", name}, {"model", kind()}, {"vertices", vertex_count}, {"mass", statistics.mass}};
  return to_line(json);
}

std::string Component::description() const {
  return fmt::format("body {}: {} of {} vertices, {:.6g} kg\n", name, kind(), vertex_count, statistics.mass);
}

Embedding identity_embedding(std::size_t count) {
  Embedding embedding;
  for (std::size_t v = 0; v < count; ++v) {
    embedding.vertices.emplace_back().fill(static_cast<int>(v));
    embedding.weights.push_back({1});
  }
  embedding.prepare_transpose(count);
  return embedding;
}

Embedding embed_source(const Component::Source& source) {
  Embedding embedding;
  const std::size_t count = source.vertices.size();
  embedding.offsets.assign(count, Vec3::Zero());
  for (std::size_t p = 0; p < count; ++p) {
    const int v = source.vertices[p];
    embedding.vertices.emplace_back().fill(std::max(v, 0));
    embedding.weights.push_back({v < 0 ? 0.0 : 1.0});
    if (v < 0) embedding.offsets[p] = source.mesh.positions[p];
  }
  embedding.prepare_transpose(source.origins.size());
  return embedding;
}

void weigh(Component& component) {
  component.statistics.mass = 0;
  for (const double mass : component.masses()) component.statistics.mass += mass;
}

}  // namespace muslin
