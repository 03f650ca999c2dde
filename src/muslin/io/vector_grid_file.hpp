// Reads vectors on a regular grid from NumPy's `.npy` files.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "muslin/core/vectors.hpp"

namespace muslin {

struct VectorGrid {
  std::array<std::size_t, 3> size{};  ///< nodes along x, y, z, at least 2 each
  std::vector<Vec3> vectors;          ///< of node (i, j, k) at (i size[1] + j) size[2] + k
};

/// Reads an array of shape (nx, ny, nz, 3) of floats or integers in C order (io/npy_file.hpp). Errors: file;
/// input, with the file, if it is malformed, has another shape or order, less than two nodes along an axis,
/// or a number that is not finite.
VectorGrid read_vector_grid(const std::filesystem::path& path);

/// From memory; `file` is for messages.
VectorGrid read_vector_grid_from(std::string_view bytes, const std::string& file);

}  // namespace muslin
