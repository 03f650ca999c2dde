// RenderMesh holds the triangles of a surface for the ray tracer: in float about a centre, with smooth
// normals, and with two sides and a rim where a sheet is drawn with its thickness.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "muslin/render/scene_view.hpp"

namespace muslin {

/// Corners of triangles that share one smooth normal at rest: #T by 3 indices, counted from 0. Corners
/// meet in one group when a path of edges around their vertex joins them without a crease.
struct SmoothingGroups {
  std::vector<Vec3i> corners;
  std::size_t count = 0;
};
SmoothingGroups smoothing_groups(const std::vector<Vec3i>& triangles, ConstVectors rest_positions,
                                 double crease_angle);

class RenderMesh {
 public:
  /// Throws Error(usage) if indices are out of range or array sizes do not match.
  explicit RenderMesh(const Surface& surface);

  enum class Layer { front, back, rim };
  struct Primitive {
    Layer layer;
    std::size_t triangle;  ///< of the surface (of a rim, the triangle whose edge it closes)
    Vec3i corners;         ///< which corner of that triangle each corner is
  };

  /// Moves the vertices. Throws Error(input) where a position is not finite, Error(usage) on a wrong count.
  void update(ConstVectors positions, const Vec3& centre);

  std::size_t vertex_count() const { return positions_.size(); }
  std::size_t primitive_count() const { return indices_.size(); }
  const std::vector<Eigen::Vector3f>& positions() const { return positions_; }
  const std::vector<std::array<std::uint32_t, 3>>& indices() const { return indices_; }
  Primitive primitive(std::size_t p) const;
  /// Returns the unit normals of the primitive's corners.
  std::array<Eigen::Vector3f, 3> normals(std::size_t p) const;

 private:
  Surface const* surface_;
  SmoothingGroups groups_;
  std::vector<std::array<std::uint32_t, 2>> rim_;  // triangle, edge: each gives two primitives
  std::vector<Eigen::Vector3f> positions_;
  std::vector<std::array<std::uint32_t, 3>> indices_;
  std::vector<Eigen::Vector3f> group_normals_;
};

}  // namespace muslin
