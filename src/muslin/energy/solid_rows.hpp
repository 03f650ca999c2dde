// SolidRows computes energies, forces and stiffness of the tetrahedra of a solid, six a voxel, as vector code
// over pieces of the rows of voxels, for any law of the measures of tetrahedron_stencil.hpp.
//
// A Kuhn tetrahedron follows a path from corner 0 to corner 7 of its voxel along the three axes in some
// order. The edges of the path over the width are the columns of F, in that order. Hence no inverse is
// needed, and the six tetrahedra share twelve edges. docs/theory/solids.md has the formulas.
//
// A law whose energy contains a logarithm may provide it by parts,
//
//   ψ = polynomial(I_C, J) + log_factor ln argument(I_C),
//
// so that a voxel needs one logarithm, of the product of six arguments.
//
// A law is instantiated in one source file, which includes solid_rows_methods.hpp.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "muslin/core/vectors.hpp"
#include "muslin/energy/element_energy.hpp"
#include "muslin/energy/voxel_rows.hpp"
#include "muslin/lattice/lattice.hpp"
#include "muslin/potential/hessian_sink.hpp"
#include "muslin/potential/symmetric_pattern.hpp"

namespace muslin {

/// The edges of tetrahedra by row of vertices: from vertex i of row `row` (y and z as bits) to the vertex
/// that lies `along` (bits x, y, z) from it. A piece of n voxels has n of them, n + 1 if x is not among the
/// bits.
struct RowEdge {
  int row, along;
  constexpr int count(int voxels) const { return voxels + 1 - along % 2; }
};
inline constexpr std::array<RowEdge, 14> row_edges = {{{0, 1},
                                                       {0, 2},
                                                       {0, 3},
                                                       {0, 4},
                                                       {0, 5},
                                                       {0, 6},
                                                       {0, 7},
                                                       {1, 1},
                                                       {1, 4},
                                                       {1, 5},
                                                       {2, 1},
                                                       {2, 2},
                                                       {2, 3},
                                                       {3, 1}}};

/// Forces on the corners of a piece's voxels by row of vertices: #longest + 1 a row.
using RowForces = double[4][3][VoxelPiece::longest + 1];
void add_to_vertices(const RowForces& forces, const VoxelPiece& piece, Vectors y);

/// By edge, entry (row by row) and vertex: ∂²W/∂x_from ∂x_to. Entries beyond an edge's count are 0.
using RowBlocks = float[row_edges.size()][9][VoxelPiece::longest + 16];

/// The places of the pieces' blocks in a pattern.
class RowSlots {
 public:
  RowSlots() = default;
  RowSlots(const VoxelRows& rows, const SymmetricPattern& pattern);
  /// Adds the blocks of a piece. With `fresh`, blocks that no earlier piece has are set.
  void add(const RowBlocks& blocks, const VoxelPiece& piece, bool fresh, PairBlocks to) const;

 private:
  // By piece: the blocks of its edges, ~block where no earlier piece has it.
  using Slots = std::array<std::array<int, VoxelPiece::longest + 1>, row_edges.size()>;
  std::vector<Slots> slots_;
};

template <class Law>
class SolidRows {
 public:
  /// `pattern` is the lattice's tetrahedron_pattern, or null.
  SolidRows(const Lattice& lattice, const typename Law::Constants& law, const SymmetricPattern* pattern);

  double value(ConstVectors x) const;
  /// Returns the bits of value().
  double add_gradient_and_value(ConstVectors x, Vectors g) const;
  /// `kind` is exact or material.
  void add_stiffness_product(Stiffness kind, ConstVectors x, ConstVectors p, Vectors y) const;
  /// Adds `factor` times the stiffness, exact or material, to the blocks of the pattern except the diagonal
  /// ones. With `fresh`, the blocks are set.
  void add_pair_blocks(Stiffness kind, ConstVectors x, double factor, bool fresh, PairBlocks to) const;

 private:
  const double* volumes(const VoxelPiece& piece) const { return volumes_.data() + piece.first; }

  typename Law::Constants law_;
  double width_;
  VoxelRows rows_;
  std::vector<double> volumes_;  // of each tetrahedron of a voxel [m³]
  RowSlots slots_;
};

}  // namespace muslin
