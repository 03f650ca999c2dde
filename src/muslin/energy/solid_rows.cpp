#include "muslin/energy/solid_rows.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "muslin/core/vector_code.hpp"

namespace muslin {
namespace {

MUSLIN_INLINE Float4 load_four(const float* from) {
  Float4 value;
  std::memcpy(&value, from, sizeof(value));
  return value;
}

/// Adds the blocks of one edge of a piece, transposed four at once.
template <bool fresh>
void add_edge(const float (&entries)[9][VoxelPiece::longest + 16], const int* slots, int count,
              const PairBlocks& to) {
  for (int i = 0; i < count; i += 4) {
    const int group = std::min(4, count - i);
    for (int c = 0; c < 3; ++c) {
      const Float4 x = load_four(entries[c] + i), y = load_four(entries[3 + c] + i),
                   z = load_four(entries[6 + c] + i);
      const Float4 xy01 = __builtin_shufflevector(x, y, 0, 4, 1, 5),
                   xy23 = __builtin_shufflevector(x, y, 2, 6, 3, 7),
                   z01 = __builtin_shufflevector(z, Float4{}, 0, 4, 1, 5),
                   z23 = __builtin_shufflevector(z, Float4{}, 2, 6, 3, 7);
      const Float4 columns[4] = {
          __builtin_shufflevector(xy01, z01, 0, 1, 4, 5), __builtin_shufflevector(xy01, z01, 2, 3, 6, 7),
          __builtin_shufflevector(xy23, z23, 0, 1, 4, 5), __builtin_shufflevector(xy23, z23, 2, 3, 6, 7)};
      for (int l = 0; l < group; ++l) {
        const int slot = slots[i + l];
        Float4& column = to.block(slot < 0 ? ~slot : slot)[c];
        column = fresh && slot < 0 ? columns[l] : column + columns[l];
      }
    }
  }
}

}  // namespace

void add_to_vertices(const RowForces& forces, const VoxelPiece& piece, Vectors y) {
  for (std::size_t r = 0; r < 4; ++r) {
    Vec3* const to = &y[static_cast<std::size_t>(piece.rows[r])];
    for (int i = 0; i <= piece.length; ++i) to[i] += Vec3(forces[r][0][i], forces[r][1][i], forces[r][2][i]);
  }
}

RowSlots::RowSlots(const VoxelRows& rows, const SymmetricPattern& pattern) : slots_(rows.piece_count()) {
  std::vector<std::uint8_t> met(pattern.block_count(), 0);
  rows.for_each([&](const VoxelPiece& piece) {
    for (std::size_t e = 0; e < row_edges.size(); ++e) {
      const auto [row, along] = row_edges[e];
      const int from = piece.rows[static_cast<std::size_t>(row)],
                to = piece.rows[static_cast<std::size_t>(row + along / 2)] + along % 2;
      for (int i = 0; i < row_edges[e].count(piece.length); ++i) {
        const int block = pattern.find(from + i, to + i);
        std::uint8_t& known = met[static_cast<std::size_t>(block)];
        slots_[piece.number][e][static_cast<std::size_t>(i)] = known != 0 ? block : ~block;
        known = 1;
      }
    }
  });
}

void RowSlots::add(const RowBlocks& blocks, const VoxelPiece& piece, bool fresh, PairBlocks to) const {
  for (std::size_t e = 0; e < row_edges.size(); ++e)
    (fresh ? add_edge<true> : add_edge<false>)(blocks[e], slots_[piece.number][e].data(),
                                               row_edges[e].count(piece.length), to);
}

}  // namespace muslin
