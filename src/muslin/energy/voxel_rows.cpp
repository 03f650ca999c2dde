#include "muslin/energy/voxel_rows.hpp"

#include <algorithm>

namespace muslin {
namespace {

constexpr int smallest_row_slab = 512;  // vertices
constexpr int most_row_slabs = 16;

}  // namespace

VoxelRows::VoxelRows(const Lattice& lattice) {
  std::vector<VoxelPiece> pieces;
  int reach = 1;
  for (std::size_t v = 0; v < lattice.voxel_count(); ++v) {
    const auto& corners = lattice.voxel_vertices[v];
    reach = std::max(reach, corners[7] - corners[0]);
    const bool goes_on = !pieces.empty() && pieces.back().length < VoxelPiece::longest &&
                         corners[0] == pieces.back().rows[0] + pieces.back().length &&
                         lattice.voxels[v].tail<2>() == lattice.voxels[v - 1].tail<2>();
    if (!goes_on) pieces.push_back({{corners[0], corners[2], corners[4], corners[6]}, 0, v, pieces.size()});
    ++pieces.back().length;
  }
  piece_count_ = pieces.size();
  const int count = static_cast<int>(lattice.vertex_count());
  // The last vertex of a piece is less than `reach` and a piece's length after its first one.
  const int size = std::max(
      {reach + VoxelPiece::longest, smallest_row_slab, (count + most_row_slabs - 1) / most_row_slabs});
  slabs_.resize(static_cast<std::size_t>((count + size - 1) / size));
  for (const VoxelPiece& piece : pieces)
    slabs_[static_cast<std::size_t>(piece.rows[0] / size)].push_back(piece);
}

}  // namespace muslin
