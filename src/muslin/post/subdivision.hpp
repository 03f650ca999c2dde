// Subdivides a surface by OpenSubdiv: Loop's scheme on triangle meshes, Catmull and Clark's on all others.
//
// Sources: Catmull and Clark, Recursively generated B-spline surfaces on arbitrary topological meshes,
// Computer-Aided Design 1978; Loop, Smooth Subdivision Surfaces Based on Triangles, 1987.
#pragma once

#include <vector>

#include "muslin/core/vectors.hpp"
#include "muslin/geometry/mesh.hpp"

namespace muslin {

/// The border stays a curve with its corners, and so do edges of three and more faces. Each level has four
/// times the faces. Texture coordinates are subdivided linearly inside their islands' borders, groups hold
/// the parts of their faces and the new vertices that depend on their vertices alone.
class Subdivision {
 public:
  /// `levels` from 1 to 8. Errors: usage, for more than 50 million faces, or for a face that names a vertex
  /// twice.
  Subdivision(const Mesh& mesh, int levels);
  const Mesh& mesh() const { return mesh_; }
  /// Returns the points of mesh() for these positions of the vertices of the mesh that was subdivided.
  std::vector<Vec3> points(ConstVectors positions) const;

 private:
  Mesh mesh_;
  /// Weights of the given vertices in each new one: offsets_[v] … offsets_[v + 1] − 1.
  std::vector<int> offsets_, sources_;
  std::vector<double> weights_;
};

}  // namespace muslin
