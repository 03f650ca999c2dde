// Reads and writes VTK's XML files, as ParaView uses them: unstructured grids (.vtu), images (.vti), time
// series (.pvd). Arrays are appended raw, little-endian, each behind its length in bytes (UInt64). Source:
// VTK File Formats, docs.vtk.org.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "muslin/core/vectors.hpp"

namespace muslin {

/// A named array with `components` numbers per point or cell.
struct VtkArray {
  std::string name;
  int components = 1;
  std::variant<std::vector<float>, std::vector<double>, std::vector<std::int64_t>, std::vector<std::uint8_t>>
      values;
};

/// Cell types by VTK's numbers.
enum class VtkCell : std::uint8_t { line = 3, triangle = 5, polygon = 7, tetrahedron = 10, hexahedron = 12 };

struct VtkGrid {
  std::variant<std::vector<float>, std::vector<double>> points;  ///< 3 per point [m]
  std::vector<std::int64_t> connectivity;                        ///< corners of all cells
  std::vector<std::int64_t> offsets;                             ///< #cells, the end of each in connectivity
  std::vector<std::uint8_t> types;                               ///< #cells, VtkCell
  std::vector<VtkArray> point_data, cell_data;

  std::size_t point_count() const;
  void add_cell(VtkCell type, const std::int64_t* corners, int count);
  /// A voxel, its corners in the order of Lattice::voxel_vertices.
  void add_voxel(const std::array<int, 8>& corners);
};

/// A scalar sampled at the corners of a grid of cubes.
struct VtkImage {
  Vec3 origin = Vec3::Zero();     ///< of the first sample [m]
  double width = 1;               ///< between samples [m]
  Vec3i samples = Vec3i::Zero();  ///< along x, y, z
  std::string name;               ///< of the scalar
  std::vector<float> values;      ///< #samples, x fastest
};

/// Errors: file.
void write_vtu(const std::filesystem::path& path, const VtkGrid& grid);
void write_vti(const std::filesystem::path& path, const VtkImage& image);
/// `steps`: time [s] and file name of each, relative to the .pvd.
void write_pvd(const std::filesystem::path& path, const std::vector<std::pair<double, std::string>>& steps);

/// Voxels and rest positions of a .vtu file written by write_vtu with hexahedra and double points. Errors:
/// file; input, if it is another kind of file.
struct VtkVoxels {
  std::vector<Vec3> points;
  std::vector<std::array<int, 8>> voxels;
};
VtkVoxels read_voxels(const std::filesystem::path& path);

/// Returns the components of the vectors as one list, three per vector.
std::vector<float> flat(const std::vector<Eigen::Vector3f>& vectors);
std::vector<double> flat(ConstVectors vectors);

}  // namespace muslin
