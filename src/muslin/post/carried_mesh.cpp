#include "muslin/post/carried_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "muslin/contact/intersections.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/index.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/geometry/closest_point.hpp"
#include "muslin/geometry/orientation.hpp"

namespace muslin {
namespace {

constexpr std::size_t grain = 1024;
constexpr int most_halvings = 10;
constexpr double least_size = 0.02;  // of a carried mesh, as a share of the surface: millimetres are none
/// A triangulated curved surface comes nearer to a point than its foot by some hundredths of the distance.
constexpr double tangency = 0.9;

/// Returns the triangles of the mesh, with neighbours turned the same way as far as the surface has two
/// sides.
std::vector<Vec3i> oriented_triangles(const Mesh& mesh) {
  const std::vector<EdgeUse> uses = edge_uses(mesh);
  const Patches patches = find_patches(uses, mesh.face_count());
  Triangulation cut = triangulate(mesh);
  for (std::size_t t = 0; t < cut.triangles.size(); ++t)
    if (patches.turned[at(cut.faces[t])] != 0) std::swap(cut.triangles[t][1], cut.triangles[t][2]);
  return std::move(cut.triangles);
}

Vec3 point_of(const Vec3i& triangle, const Vec3& weights, ConstVectors values) {
  return weights[0] * values[at(triangle[0])] + weights[1] * values[at(triangle[1])] +
         weights[2] * values[at(triangle[2])];
}

/// Returns the orthonormal frame of a triangle: along its first side, its normal last. A triangle without
/// area has the axes of the world.
Mat3 frame_of(const Vec3i& triangle, ConstVectors positions) {
  const Vec3 side = positions[at(triangle[1])] - positions[at(triangle[0])];
  const Vec3 normal = side.cross(positions[at(triangle[2])] - positions[at(triangle[0])]);
  Mat3 frame = Mat3::Identity();
  if (!(normal.norm() > 0)) return frame;
  frame.col(0) = side.normalized();
  frame.col(2) = normal.normalized();
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return frame;
}

/// Returns the interpolated unit normal; that of the triangle where the normals cancel.
Vec3 normal_at(const Vec3i& triangle, const Vec3& weights, ConstVectors positions, ConstVectors normals) {
  const Vec3 sum = point_of(triangle, weights, normals);
  const double length = sum.norm();
  return length > 1e-6 ? Vec3(sum / length) : Vec3(frame_of(triangle, positions).col(2));
}

/// Returns the weights of the corners for the point of the triangle's plane where the line from `point` along
/// `direction` meets it; nothing sensible if they are parallel, which the caller finds out.
Vec3 weights_along(const Vec3i& triangle, ConstVectors positions, const Vec3& point, const Vec3& direction) {
  Mat3 system;
  system.col(0) = positions[at(triangle[1])] - positions[at(triangle[0])];
  system.col(1) = positions[at(triangle[2])] - positions[at(triangle[0])];
  system.col(2) = direction;
  const Vec3 solution = system.partialPivLu().solve(point - positions[at(triangle[0])]);
  return {1 - solution[0] - solution[1], solution[0], solution[1]};
}

/// Moves from the nearest point of the triangle to the point from which the interpolated normal leads to
/// `point`, if there is one in this triangle.
Vec3 foot_along_normal(const Vec3i& triangle, const Vec3& nearest, ConstVectors positions,
                       ConstVectors normals, const Vec3& point) {
  Vec3 weights = nearest;
  for (int round = 0; round < 20; ++round) {
    const Vec3 next =
        weights_along(triangle, positions, point, normal_at(triangle, weights, positions, normals));
    if (!next.allFinite() || next.minCoeff() < -1e-9) return nearest;
    const double change = (next - weights).norm();
    weights = next;
    if (change < 1e-12) break;
  }
  return weights;
}

std::vector<std::pair<int, int>> crossing_pairs(ConstVectors positions, std::span<const Vec3i> triangles) {
  std::vector<std::pair<int, int>> pairs;
  for (const Intersection& found : find_intersections(positions, triangles))
    pairs.emplace_back(found.first, found.second);
  return pairs;
}

}  // namespace

std::vector<Vec3> CarriedMesh::normals(ConstVectors coarse) const {
  std::vector<Vec3> sums(coarse.size(), Vec3::Zero());
  for (const Vec3i& t : coarse_triangles_) {
    const Vec3 normal = frame_of(t, coarse).col(2);
    for (int i = 0; i < 3; ++i) {
      const Vec3& x = coarse[at(t[i])];
      const Vec3 next = coarse[at(t[(i + 1) % 3])] - x, last = coarse[at(t[(i + 2) % 3])] - x;
      sums[at(t[i])] += std::atan2(next.cross(last).norm(), next.dot(last)) * normal;
    }
  }
  for (Vec3& sum : sums) sum.normalize();
  return sums;
}

CarriedMesh::CarriedMesh(const Mesh& coarse, const Mesh& fine)
    : coarse_triangles_(oriented_triangles(coarse)), triangles_(triangulate(fine).triangles) {
  if (coarse_triangles_.empty())
    throw Error(ErrorKind::usage, "a surface without faces cannot carry a mesh", "use a mesh with faces");
  const ClosestPointQuery nearest(coarse.positions, coarse_triangles_);
  const std::vector<Vec3> rest_normals = normals(coarse.positions);
  const double size = coarse.bounds().diagonal().norm(), reach = 0.5 * size;
  negligible_ = 1e-9 * size;
  anchors_.resize(fine.vertex_count());
  std::vector<double> distances(fine.vertex_count());
  parallel_for(anchors_.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const Vec3& point = fine.positions[v];
      const ClosestPoint found = nearest(point);
      const Vec3i& triangle = coarse_triangles_[at(found.triangle)];
      Anchor& anchor = anchors_[v];
      distances[v] = found.distance;
      anchor.triangle = found.triangle;
      anchor.barycentric =
          foot_along_normal(triangle, found.barycentric, coarse.positions, rest_normals, point);
      const Vec3 normal = normal_at(triangle, anchor.barycentric, coarse.positions, rest_normals);
      const Vec3 offset = point - point_of(triangle, anchor.barycentric, coarse.positions);
      anchor.height = offset.dot(normal);
      if (const double length = offset.norm(); length > 0) anchor.clearance = found.distance / length;
      anchor.remainder =
          frame_of(triangle, coarse.positions).transpose() * Vec3(offset - anchor.height * normal);
    }
  });
  const auto farthest = std::max_element(distances.begin(), distances.end());
  if (farthest != distances.end() && *farthest > reach)
    throw Error(ErrorKind::usage,
                fmt::format("vertex {} of the carried mesh is {:.3g} m from the surface that carries it",
                            farthest - distances.begin(), *farthest),
                "model both in the same place and unit of length");

  if (fine.bounds().diagonal().norm() < least_size * size)
    throw Error(ErrorKind::usage,
                fmt::format("the carried mesh is {:.3g} m large, on a surface of {:.3g} m",
                            fine.bounds().diagonal().norm(), size),
                "give both in the same unit of length");

  std::vector<std::vector<int>> neighbours(fine.vertex_count());
  for_each_edge(triangle_sides(triangles_), [&](std::span<const EdgeUse> edge) {
    neighbours[at(edge[0].low)].push_back(edge[0].high);
    neighbours[at(edge[0].high)].push_back(edge[0].low);
  });
  neighbour_offsets_.assign(1, 0);
  for (const auto& of_vertex : neighbours) {
    neighbours_.insert(neighbours_.end(), of_vertex.begin(), of_vertex.end());
    neighbour_offsets_.push_back(static_cast<int>(neighbours_.size()));
  }
  at_rest_ = crossing_pairs(fine.positions, triangles_);
}

/// Scales each offset so that the point is not nearer to another part of the surfaces than to its foot:
/// inside the sphere around the point that touches its foot there is no surface, so that offsets from both
/// sides of a gap do not meet.
std::vector<double> CarriedMesh::clear_scales(ConstVectors coarse, ConstVectors feet, ConstVectors offsets,
                                              const Obstacles& obstacles) const {
  std::vector<Vec3> positions(coarse.begin(), coarse.end());
  positions.insert(positions.end(), obstacles.positions.begin(), obstacles.positions.end());
  std::vector<Vec3i> triangles = coarse_triangles_;
  for (const Vec3i& t : obstacles.triangles)
    triangles.emplace_back(t.array() + static_cast<int>(coarse.size()));
  const ClosestPointQuery nearest(positions, triangles);
  std::vector<double> scales(feet.size(), 1);
  parallel_for(feet.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const double length = offsets[v].norm() * anchors_[v].clearance;
      for (int halving = 0; halving < most_halvings; ++halving) {
        const double own = scales[v] * length;
        if (own <= negligible_ || nearest(feet[v] + scales[v] * offsets[v], own).distance >= tangency * own)
          break;
        scales[v] *= 0.5;
      }
    }
  });
  return scales;
}

/// Lets scales rise gradually around vertices whose offset is scaled down.
void CarriedMesh::smooth(std::vector<double>& scales) const {
  const std::vector<double> before = scales;
  for (std::size_t v = 0; v < scales.size(); ++v) {
    double sum = 0;
    const int first = neighbour_offsets_[v], last = neighbour_offsets_[v + 1];
    for (int n = first; n < last; ++n) sum += before[at(neighbours_[at(n)])];
    if (last > first) scales[v] = std::min(before[v], 0.5 * (before[v] + sum / (last - first)));
  }
}

Carried CarriedMesh::points(ConstVectors coarse, const Obstacles& obstacles) const {
  const std::vector<Vec3> coarse_normals = normals(coarse);
  const std::size_t count = anchors_.size();
  std::vector<Vec3> feet(count), offsets(count);
  parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const Anchor& anchor = anchors_[v];
      const Vec3i& triangle = coarse_triangles_[at(anchor.triangle)];
      feet[v] = point_of(triangle, anchor.barycentric, coarse);
      offsets[v] = anchor.height * normal_at(triangle, anchor.barycentric, coarse, coarse_normals) +
                   frame_of(triangle, coarse) * anchor.remainder;
    }
  });

  // The fine mesh comes first, so that a pair that crosses names it first.
  std::vector<Vec3> positions(count);
  positions.insert(positions.end(), obstacles.positions.begin(), obstacles.positions.end());
  std::vector<Vec3i> triangles = triangles_;
  for (const Vec3i& t : obstacles.triangles) triangles.emplace_back(t.array() + static_cast<int>(count));
  const int own = static_cast<int>(triangles_.size());
  IntersectionOptions options;
  options.wanted = [&](int first, int second) {
    return first < own &&
           (second >= own || !std::binary_search(at_rest_.begin(), at_rest_.end(), std::pair(first, second)));
  };
  Carried result;
  std::vector<double> scales = clear_scales(coarse, feet, offsets, obstacles);
  for (int round = 0; round < 3; ++round) smooth(scales);
  for (int round = 0; true; ++round) {
    for (std::size_t v = 0; v < count; ++v) positions[v] = feet[v] + scales[v] * offsets[v];
    const std::vector<Intersection> found = find_intersections(positions, triangles, options);
    result.crossings = found.size();
    if (found.empty() || round == most_halvings) break;
    std::vector<double> halved = scales;
    for (const Intersection& crossing : found)
      for (const int t : {crossing.first, crossing.second})
        for (int i = 0; t < own && i < 3; ++i) {
          const auto v = at(triangles_[at(t)][i]);
          halved[v] = 0.5 * scales[v];
        }
    scales.swap(halved);
    smooth(scales);
  }
  result.drawn_in = at(std::count_if(scales.begin(), scales.end(), [](double s) { return s < 1; }));
  positions.resize(count);
  result.points = std::move(positions);
  return result;
}

}  // namespace muslin
