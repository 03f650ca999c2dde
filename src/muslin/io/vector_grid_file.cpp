#include "muslin/io/vector_grid_file.hpp"

#include <cstdint>

#include <fmt/format.h>

#include "muslin/core/input_file.hpp"
#include "muslin/io/npy_file.hpp"

namespace muslin {

VectorGrid read_vector_grid_from(std::string_view bytes, const std::string& file) {
  const NpyArray array(bytes, file,
                       "save an array of shape (nx, ny, nz, 3), as numpy.save(file, "
                       "numpy.ascontiguousarray(vectors))");
  const std::vector<std::uint64_t>& shape = array.shape();
  if (shape.size() != 4 || shape[3] != 3)
    array.refuse(fmt::format("its shape is ({})", fmt::join(shape, ", ")));
  if (array.has_fortran_order()) array.refuse("its order is that of Fortran");
  VectorGrid grid;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (shape[axis] < 2)
      array.refuse(fmt::format("an axis has {} nodes, but 2 or more are needed", shape[axis]));
    grid.size[axis] = shape[axis];
  }
  grid.vectors.resize(array.size() / 3);
  for (std::size_t n = 0; n < grid.vectors.size(); ++n)
    grid.vectors[n] = {array[3 * n], array[3 * n + 1], array[3 * n + 2]};
  return grid;
}

VectorGrid read_vector_grid(const std::filesystem::path& path) {
  return read_vector_grid_from(read_file(path), path.string());
}

}  // namespace muslin
