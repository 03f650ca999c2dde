// NodeMesh merges the nodes of a scene, each with parts and a transform, into one mesh (glTF, FBX, Collada).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "muslin/io/mesh_file.hpp"
#include "muslin/io/weld.hpp"

namespace muslin {

/// Call begin_node, then for each of its parts begin_part, position() for all positions, then the functions
/// for all texture coordinates, attributes and faces. Equal positions of one node become one vertex, which
/// has the mean of their attributes; texture coordinates stay with the corners. Errors: input, naming the
/// file, at a position that cannot be used or a mesh that grows too large.
class NodeMesh {
 public:
  explicit NodeMesh(std::string file) : file_(std::move(file)), welder_(mesh_.positions) {}

  /// `transform` takes the node's coordinates to the scene's. If it mirrors, faces are reversed.
  void begin_node(const std::string& name, const Eigen::Matrix4d& transform);
  /// `uvs`, the number of texture coordinates, is 0 or `positions`. `material` is that of its faces; empty:
  /// none.
  void begin_part(std::size_t positions, std::size_t uvs, const std::string& material = "");
  void position(const Vec3& local);
  void uv(const Vec2& uv);
  /// Takes the numbers of an attribute at all positions of this part. Vertices of parts without it have NaN.
  void attribute(const std::string& name, std::span<const double> values);
  /// Indices into the positions of this part.
  void face(std::span<const std::size_t> corners);

  /// Returns the mesh with one group per node if there are several, its materials, and a note on the changes.
  MeshFile finish(const std::string& reason, const std::string& extra);

 private:
  struct Attribute {
    VertexAttribute mean;     // of the numbers so far, of the first vertices
    std::vector<int> counts;  // of these numbers
  };

  [[noreturn]] void refuse(const std::string& problem) const;
  /// Gives an attribute an entry for each vertex so far.
  void complete(Attribute& attribute) const;

  std::string file_;
  Mesh mesh_;
  Welder welder_;
  Eigen::Matrix4d transform_ = Eigen::Matrix4d::Identity();
  bool mirrored_ = false;
  std::size_t first_uv_ = 0, part_uvs_ = 0, stored_ = 0;
  std::size_t part_material_ = 0;   // counted from 1; 0: none
  std::vector<int> part_vertices_;  // the vertex of each position of the part
  std::vector<Attribute> attributes_;
};

}  // namespace muslin
