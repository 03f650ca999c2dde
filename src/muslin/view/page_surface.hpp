// PageSurface is a surface prepared for drawing on a page.
#pragma once

#include <cstdint>
#include <vector>

#include "muslin/cache/run_reader.hpp"
#include "muslin/geometry/mesh.hpp"

namespace muslin {

/// Corners of triangles are drawn vertices: one for every combination of point, smooth normal and position in
/// the pattern. Edges that are sharp at rest stay crisp; seams of the pattern do not crease.
struct PageSurface {
  std::vector<std::uint32_t> triangles;  ///< 3 × #T drawn vertices
  std::vector<std::uint32_t> points;     ///< #D, the point that moves each drawn vertex
  std::vector<std::uint32_t> normals;    ///< #D, index of its smooth normal
  std::size_t normal_count = 0;
  std::vector<float> pattern;       ///< 2 × #D places in the pattern [m]
  std::vector<std::uint32_t> ends;  ///< 2 × #E points: edges of the polygons
  std::vector<float> rest_lengths;  ///< #E [m]
};

PageSurface page_surface(const Mesh& mesh);

/// The outside of voxels: their faces that belong to one alone, facing outward.
struct CellsOutside {
  Mesh mesh;
  std::vector<int> vertices;  ///< of the cells, of each vertex of the mesh; ascending
};
CellsOutside outside_of(const RunReader::Cells& cells);

}  // namespace muslin
