#include "muslin/render/render_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

using Normal = Eigen::Vector3f;

struct HalfEdge {
  int low, high;  // vertices
  std::uint32_t triangle, edge;
};

std::vector<HalfEdge> sorted_edges(const std::vector<Vec3i>& triangles) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const int a = triangles[t][i];
      const int b = triangles[t][(i + 1) % 3];
      edges.push_back(
          {std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(t), static_cast<std::uint32_t>(i)});
    }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return std::tie(a.low, a.high, a.triangle, a.edge) < std::tie(b.low, b.high, b.triangle, b.edge);
  });
  return edges;
}

int find_root(std::vector<int>& parent, int i) {
  while (parent[static_cast<std::size_t>(i)] != i) {
    int& up = parent[static_cast<std::size_t>(i)];
    up = parent[static_cast<std::size_t>(up)];
    i = up;
  }
  return i;
}

Normal unit_or_up(const Normal& n) {
  const float length = n.norm();
  return length > 0 ? Normal(n / length) : Normal(0, 1, 0);
}

}  // namespace

SmoothingGroups smoothing_groups(const std::vector<Vec3i>& triangles, ConstVectors rest_positions,
                                 double crease_angle) {
  std::vector<Vec3> face_normals(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto at = [&](int i) -> const Vec3& {
      return rest_positions[static_cast<std::size_t>(triangles[t][i])];
    };
    const Vec3 n = (at(1) - at(0)).cross(at(2) - at(0));
    face_normals[t] = n.norm() > 0 ? Vec3(n.normalized()) : Vec3::Zero();
  }
  std::vector<int> parent(3 * triangles.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto corner_of = [&](std::uint32_t t, int vertex) {
    int i = 0;
    while (triangles[t][i] != vertex) ++i;
    return static_cast<int>(3 * t) + i;
  };
  const double smooth = std::cos(crease_angle);
  const std::vector<HalfEdge> edges = sorted_edges(triangles);
  for (std::size_t e = 0; e + 1 < edges.size(); ++e) {
    const HalfEdge& a = edges[e];
    const HalfEdge& b = edges[e + 1];
    if (a.low != b.low || a.high != b.high || a.low == a.high) continue;
    if (face_normals[a.triangle].dot(face_normals[b.triangle]) < smooth) continue;
    for (const int vertex : {a.low, a.high}) {
      const int i = find_root(parent, corner_of(a.triangle, vertex));
      const int j = find_root(parent, corner_of(b.triangle, vertex));
      parent[static_cast<std::size_t>(std::max(i, j))] = std::min(i, j);
    }
  }
  SmoothingGroups groups;
  groups.corners.resize(triangles.size());
  std::vector<int> number(parent.size(), -1);
  for (std::size_t c = 0; c < parent.size(); ++c) {
    const std::size_t root = static_cast<std::size_t>(find_root(parent, static_cast<int>(c)));
    if (number[root] < 0) number[root] = static_cast<int>(groups.count++);
    groups.corners[c / 3][static_cast<Eigen::Index>(c % 3)] = number[root];
  }
  return groups;
}

RenderMesh::RenderMesh(const Surface& surface) : surface_(&surface) {
  const int vertices = static_cast<int>(surface.rest_positions.size());
  for (const Vec3i& triangle : surface.triangles)
    if (triangle.minCoeff() < 0 || triangle.maxCoeff() >= vertices)
      throw Error(ErrorKind::usage,
                  "surface '" + surface.name + "' has a triangle that names a missing vertex",
                  "give one rest position for every vertex");
  if (!surface.pattern_positions.empty() && surface.pattern_positions.size() != 3 * surface.triangles.size())
    throw Error(ErrorKind::usage, "surface '" + surface.name + "' has a wrong number of pattern positions",
                "give three for every triangle, or none");
  groups_ = smoothing_groups(surface.triangles, surface.rest_positions, surface.crease_angle);
  for (const Vec3i& t : surface.triangles)
    indices_.push_back({static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[1]),
                        static_cast<std::uint32_t>(t[2])});
  positions_.resize(surface.rest_positions.size());
  group_normals_.resize(groups_.count);
  if (surface.thickness <= 0) return;

  // A copy of the vertices makes the back; edges of one triangle only get a rim.
  const std::uint32_t shift = static_cast<std::uint32_t>(vertices);
  positions_.resize(2 * positions_.size());
  for (const Vec3i& t : surface.triangles)
    indices_.push_back({static_cast<std::uint32_t>(t[0]) + shift, static_cast<std::uint32_t>(t[2]) + shift,
                        static_cast<std::uint32_t>(t[1]) + shift});
  const std::vector<HalfEdge> edges = sorted_edges(surface.triangles);
  const auto same = [](const HalfEdge& a, const HalfEdge& b) { return a.low == b.low && a.high == b.high; };
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if ((e > 0 && same(edges[e - 1], edges[e])) || (e + 1 < edges.size() && same(edges[e], edges[e + 1])))
      continue;
    const Vec3i& t = surface.triangles[edges[e].triangle];
    const auto a = static_cast<std::uint32_t>(t[edges[e].edge]);
    const auto b = static_cast<std::uint32_t>(t[(edges[e].edge + 1) % 3]);
    rim_.push_back({edges[e].triangle, edges[e].edge});
    indices_.push_back({a + shift, b + shift, b});
    indices_.push_back({a + shift, b, a});
  }
}

void RenderMesh::update(ConstVectors positions, const Vec3& centre) {
  const std::size_t vertices = surface_->rest_positions.size();
  if (positions.size() != vertices)
    throw Error(ErrorKind::usage,
                "surface '" + surface_->name + "' has " + std::to_string(vertices) +
                    " vertices, but a frame gives " + std::to_string(positions.size()) + " positions",
                "give one position for every vertex");
  for (std::size_t v = 0; v < vertices; ++v) {
    if (!positions[v].allFinite())
      throw Error(
          ErrorKind::input,
          "surface '" + surface_->name + "': the position of vertex " + std::to_string(v) + " is not finite",
          "leave this frame out");
    positions_[v] = (positions[v] - centre).cast<float>();
  }
  std::fill(group_normals_.begin(), group_normals_.end(), Normal::Zero());
  for (std::size_t t = 0; t < surface_->triangles.size(); ++t) {
    const auto& p = indices_[t];
    const Normal n = (positions_[p[1]] - positions_[p[0]]).cross(positions_[p[2]] - positions_[p[0]]);
    // Weighting by the corner's angle makes the normal independent of how polygons were cut.
    for (int i = 0; i < 3; ++i) {
      const auto at = [&](int k) -> const Normal& { return positions_[p[static_cast<std::size_t>(k % 3)]]; };
      const Normal e = at(i + 1) - at(i);
      const Normal f = at(i + 2) - at(i);
      const float angle = std::atan2(n.norm(), e.dot(f));
      group_normals_[static_cast<std::size_t>(groups_.corners[t][i])] += angle * unit_or_up(n);
    }
  }
  for (Normal& n : group_normals_) n = unit_or_up(n);
  if (surface_->thickness <= 0) return;

  std::vector<Normal> offsets(vertices, Normal::Zero());
  for (std::size_t t = 0; t < surface_->triangles.size(); ++t)
    for (int i = 0; i < 3; ++i)
      offsets[static_cast<std::size_t>(surface_->triangles[t][i])] +=
          group_normals_[static_cast<std::size_t>(groups_.corners[t][i])];
  const float half = static_cast<float>(surface_->thickness / 2);
  for (std::size_t v = 0; v < vertices; ++v) {
    const Normal offset = half * unit_or_up(offsets[v]);
    positions_[vertices + v] = positions_[v] - offset;
    positions_[v] += offset;
  }
}

RenderMesh::Primitive RenderMesh::primitive(std::size_t p) const {
  const std::size_t triangles = surface_->triangles.size();
  if (p < triangles) return {Layer::front, p, Vec3i(0, 1, 2)};
  if (p < 2 * triangles) return {Layer::back, p - triangles, Vec3i(0, 2, 1)};
  const auto [triangle, edge] = rim_[(p - 2 * triangles) / 2];
  const int a = static_cast<int>(edge);
  const int b = (a + 1) % 3;
  return {Layer::rim, triangle, (p - 2 * triangles) % 2 == 0 ? Vec3i(a, b, b) : Vec3i(a, b, a)};
}

std::array<Eigen::Vector3f, 3> RenderMesh::normals(std::size_t p) const {
  const Primitive primitive = this->primitive(p);
  if (primitive.layer == Layer::rim) {
    const auto& i = indices_[p];
    const Normal n =
        unit_or_up((positions_[i[1]] - positions_[i[0]]).cross(positions_[i[2]] - positions_[i[0]]));
    return {n, n, n};
  }
  const float sign = primitive.layer == Layer::back ? -1.0f : 1.0f;
  std::array<Normal, 3> normals;
  for (std::size_t i = 0; i < 3; ++i) {
    const int corner = primitive.corners[static_cast<Eigen::Index>(i)];
    normals[i] = sign * group_normals_[static_cast<std::size_t>(groups_.corners[primitive.triangle][corner])];
  }
  return normals;
}

}  // namespace muslin
