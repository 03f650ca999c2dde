// Mesh is a polygon mesh as authored: vertex order, polygons, texture seams and groups are kept, because the
// simulated skin must match the input file.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/topology/topology.hpp"

namespace muslin {

/// A named set of faces or of vertices, as in OBJ `g` statements. Indices ascend, each once.
struct MeshGroup {
  std::string name;
  std::vector<int> faces;     ///< indices of faces
  std::vector<int> vertices;  ///< vertices of those faces, or of a vertex group
};

/// The faces to which a file gives a material: `usemtl` of OBJ, the materials of glTF.
struct MeshMaterial {
  std::string name;
  std::vector<int> faces;  ///< ascending
};

struct MUSLIN_API Mesh : Topology {
  std::string name;             ///< object name, may be empty
  std::vector<Vec3> positions;  ///< #V by 3
  std::vector<Vec2> uvs;        ///< #T texture coordinates; a vertex on a seam has several
  std::vector<int> corner_uvs;  ///< #C index into uvs, −1 where a corner has none; empty if none has
  std::vector<MeshGroup> groups;
  std::vector<MeshMaterial> materials;  ///< a face has one of them, or none

  /// Returns for each face (#F) the index of its material, −1 for none.
  std::vector<int> material_of_face() const;
  std::size_t vertex_count() const { return positions.size(); }
  /// Appends a polygon of at least three corners, without texture coordinates. Errors: usage.
  void add_face(std::span<const int> vertices);
  /// Returns the smallest box around all faces; around all positions if there are no faces.
  Box bounds() const;
};

/// A mesh with opened edges, and the vertex of the earlier one that each of its vertices comes from.
struct MeshCut {
  Mesh mesh;
  std::vector<int> origins;  ///< #V of the new mesh
};
/// Opens edges as `cut` does for a topology. Faces, their order and their texture coordinates stay; new
/// vertices come last, have the positions of their origins and belong to their groups. Errors: as for the
/// `cut` of a topology.
MUSLIN_API MeshCut cut(const Mesh& mesh, std::span<const std::array<int, 2>> edges);

/// The polygons cut into triangles, in face order, n − 2 from n corners, with the orientation of their
/// polygon. Concave polygons are cut inside their outline, seen along their normal; vertices are neither
/// added nor dropped, so a polygon without area gives triangles without area.
struct Triangulation {
  std::vector<Vec3i> triangles;  ///< #T vertex indices
  std::vector<int> faces;        ///< #T the polygon each triangle comes from
};
/// Indices must be in range (require_usable).
MUSLIN_API Triangulation triangulate(const Mesh& mesh);

/// Returns twice the area of a polygon times its unit normal (Newell's sum): exact for planar polygons, that
/// of the best-fitting plane for others. Zero or not finite if the polygon is degenerate.
MUSLIN_API Vec3 newell_normal(ConstVectors positions, std::span<const int> face);

}  // namespace muslin
