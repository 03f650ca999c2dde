#include "muslin/component/lattice/lattice_body.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "muslin/component/body_maps.hpp"
#include "muslin/component/body_mesh.hpp"
#include "muslin/core/disjoint_sets.hpp"
#include "muslin/core/hash.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/geometry/edge_length.hpp"
#include "muslin/lattice/lattice_moduli.hpp"
#include "muslin/schema/over_time.hpp"

namespace muslin {
namespace {

constexpr double weight_tolerance = 1e-6;  // of a vertex that carries a point of a group

/// Points of the group no farther apart than half a voxel width: its vertices, and samples of its faces.
std::vector<Vec3> group_points(const Mesh& mesh, const MeshGroup& group, double width) {
  std::vector<Vec3> points;
  for (const int v : group.vertices) points.push_back(mesh.positions[static_cast<std::size_t>(v)]);
  std::vector<std::uint8_t> member(mesh.face_count(), 0);
  for (const int f : group.faces) member[static_cast<std::size_t>(f)] = 1;
  const Triangulation cut = triangulate(mesh);
  for (std::size_t t = 0; t < cut.triangles.size(); ++t) {
    if (!member[static_cast<std::size_t>(cut.faces[t])]) continue;
    const Vec3& a = mesh.positions[static_cast<std::size_t>(cut.triangles[t][0])];
    const Vec3 u = mesh.positions[static_cast<std::size_t>(cut.triangles[t][1])] - a;
    const Vec3 v = mesh.positions[static_cast<std::size_t>(cut.triangles[t][2])] - a;
    const double longest = std::max({u.norm(), v.norm(), (u - v).norm()});
    const int pieces = static_cast<int>(std::clamp(std::ceil(longest / (width / 2)), 1.0, 2000.0));
    for (int i = 0; i <= pieces; ++i) {
      for (int j = 0; i + j <= pieces; ++j) points.push_back(a + u * i / pieces + v * j / pieces);
    }
  }
  return points;
}

}  // namespace

std::vector<double> LatticeBody::voxel_shares() const {
  if (own().mass == LatticeBodySettings::Mass::solid) return lattice.fill;
  return std::vector<double>(lattice.voxel_count(), 1.0);
}

std::vector<double> LatticeBody::voxel_factors(std::string_view key) const {
  std::vector<double> factors(lattice.voxel_count(), 1.0);
  const MappedNumber* map = find_map(vertex_maps, key);
  if (map == nullptr || map->variation.nominal() == 0) return factors;
  for (std::size_t c = 0; c < factors.size(); ++c)
    factors[c] = map->mean(lattice.voxel_vertices[c]) / map->variation.nominal();
  return factors;
}

/// Each voxel gives an eighth of density·share·width³ to each of its corners.
std::vector<double> LatticeBody::masses() const {
  std::vector<double> shares = voxel_shares();
  const std::vector<double> factors = voxel_factors("density");
  for (std::size_t c = 0; c < shares.size(); ++c) shares[c] *= factors[c];
  const double corner = settings.material.density * lattice.width * lattice.width * lattice.width / 8;
  std::vector<double> masses(lattice.vertex_count(), 0.0);
  for (std::size_t c = 0; c < lattice.voxel_count(); ++c) {
    for (const int v : lattice.voxel_vertices[c]) masses[static_cast<std::size_t>(v)] += corner * shares[c];
  }
  return masses;
}

std::vector<Vec3> LatticeBody::velocities() const {
  return std::vector<Vec3>(lattice.vertex_count(), settings.velocity);
}

std::vector<int> LatticeBody::parts() const {
  DisjointSets parts(lattice.vertex_count());
  for (const SpringRun& run : springs.runs)
    for (int i = 0; i < run.length; ++i) parts.join(run.a + i, run.b + i);
  return parts.find_all();
}

double LatticeBody::max_stretch(ConstVectors x) const {
  if (springs.count == 0) return 1;
  struct Largest {
    double ratio = 0;
    Largest operator+(const Largest& other) const { return {std::max(ratio, other.ratio)}; }
  };
  constexpr std::size_t runs_per_block = 64;
  return parallel_sum(springs.runs.size(), runs_per_block, Largest{},
                      [&](std::size_t begin, std::size_t end) {
                        Largest largest;
                        for (std::size_t r = begin; r < end; ++r) {
                          const SpringRun& run = springs.runs[r];
                          const auto& direction = springs.directions[static_cast<std::size_t>(run.direction)];
                          const double rest = lattice.width * direction.offset.cast<double>().norm();
                          double squared = 0;
                          for (int i = 0; i < run.length; ++i) {
                            const auto a = static_cast<std::size_t>(run.a + i);
                            const auto b = static_cast<std::size_t>(run.b + i);
                            squared = std::max(squared, (x[b] - x[a]).squaredNorm());
                          }
                          largest.ratio = std::max(largest.ratio, std::sqrt(squared) / rest);
                        }
                        return largest;
                      })
      .ratio;
}

std::vector<std::uint8_t> LatticeBody::in_group(const MeshGroup& group) const {
  const Embedding carriers = carry(group_points(mesh, group, lattice.width));
  std::vector<std::uint8_t> member(lattice.vertex_count(), 0);
  for (std::size_t p = 0; p < carriers.size(); ++p) {
    for (std::size_t s = 0; s < 8; ++s) {
      if (std::abs(carriers.weights[p][s]) < weight_tolerance) continue;
      member[static_cast<std::size_t>(carriers.vertices[p][s])] = 1;
    }
  }
  return member;
}

AttachedPoint LatticeBody::attach(const Vec3& at) const {
  AttachedPoint attached{carry(std::span(&at, 1)), ""};
  const auto& weights = attached.point.weights.front();
  if (*std::min_element(weights.begin(), weights.end()) < -0.01)
    attached.warning = fmt::format("lies outside of body `{}`; it moves with the nearest voxel", name);
  return attached;
}

std::optional<ContactPart> LatticeBody::contact_part() const {
  if (!settings.contact) return std::nullopt;
  const Triangulation cut = triangulate(mesh);
  ContactPart part;
  part.edge = mean_edge(mesh.positions, cut.triangles);
  part.size = mesh.bounds().sizes().maxCoeff();
  part.body.self_contact = settings.self_contact;
  part.body.friction = schema::over_time(settings.variations, "friction", settings.friction);
  if (const MappedNumber* map = find_map(maps, "friction")) {
    const std::vector<double> numbers = map->numbers();
    part.varying.friction.assign(numbers.begin(), numbers.end());
  }
  part.body.layer = settings.layer;
  part.body.radius = sheet ? thickness / 2 : 0;
  part.body.solid = !sheet;
  const Material& m = settings.material;
  const ElasticModuli moduli = elastic_moduli(
      {m.edge_modulus, m.face_diagonal_modulus, m.body_diagonal_modulus}, own().bracing, m.volume_modulus);
  // The springs of a sheet have the stiffness of its thickness, unless every voxel counts full.
  const bool thin = sheet && own().mass == LatticeBodySettings::Mass::solid;
  part.body.stiffness = contact_stiffness_share * (moduli.youngs + m.youngs_modulus.value_or(0)) *
                        (thin ? std::min(lattice.width, thickness) : lattice.width);
  // A body without stretch resistance still needs contact to carry its weight.
  if (!(part.body.stiffness > 0)) part.body.mass = statistics.mass / vertex_count;
  part.add_mesh(mesh, cut, source ? carry(mesh.positions) : skin);
  if (part.edge > 2 * lattice.width) {
    part.warning = fmt::format(
        "body {}: contact sees its mesh, whose edges of {:.3g} m do not bend as its voxels do; "
        "subdivide the mesh",
        name, part.edge);
  }
  return part;
}

std::uint64_t LatticeBody::shape_hash(std::uint64_t seed) const { return range_hash(seed, springs.count); }

std::uint64_t LatticeBody::material_hash(std::uint64_t seed) const {
  const Material& m = settings.material;
  std::uint64_t hash = muslin::material_hash(m, static_cast<double>(own().boundary_springs), seed);
  if (m.yield_strain) {
    const std::array yield = {*m.yield_strain, m.strain_hardening};
    hash = hash_bytes(yield.data(), sizeof yield, hash);
  }
  return maps_hash(maps, hash);
}

const LatticeBody* as_lattice(const Component& component) {
  return dynamic_cast<const LatticeBody*>(&component);
}

}  // namespace muslin
