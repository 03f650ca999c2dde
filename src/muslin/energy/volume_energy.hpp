// VolumeEnergy conserves the volume of each voxel of a lattice.
//
//   W = Σ ½ κ f V₀ (V/V₀ − 1)²,   V₀ = width³
//
// with f the fill of the voxel and V the volume within its eight corners, whose faces are bilinear patches.
// Each voxel has one volume, in which all corners have equal roles: the six tetrahedra of a voxel are biased
// towards one diagonal, deflect a bouncing body sideways, and lock. V is a polynomial, so W is smooth
// everywhere, and a flat or inverted voxel (V ≤ 0) has a restoring force too. Volume terms beside the springs
// of a mass-spring system were proposed by Teschner, Heidelberger, Müller, Gross 2004, and for whole bodies
// by Diziol, Bender, Bayer 2009. docs/theory/volume.md.
#pragma once

#include <array>
#include <vector>

#include "muslin/lattice/lattice.hpp"
#include "muslin/potential/potential.hpp"

namespace muslin {

class VolumeEnergy : public Potential {
 public:
  /// volume_modulus κ [N/m²] ≥ 0; the positions are the lattice's vertices.
  VolumeEnergy(const Lattice& lattice, double volume_modulus);

  double value(ConstVectors x) const override;
  void add_gradient(ConstVectors x, Vectors g) const override;
  void add_hessian_product(ConstVectors x, ConstVectors p, Vectors y) const override;
  void add_diagonal_blocks(ConstVectors x, std::span<Mat3> blocks) const override;

 private:
  struct Cell {
    std::array<int, 8> vertices;
    double modulus = 0;  ///< κ f [N/m²]
    std::size_t vertex(std::size_t corner) const { return static_cast<std::size_t>(vertices[corner]); }
  };
  template <class Kernel>
  void for_each_cell(const Kernel& kernel) const;

  double rest_volume_ = 0;  ///< of a voxel [m³]
  /// By parity of the voxel's coordinates: cells of one colour share no vertex, so each colour can be
  /// added in parallel, and every vertex sums its cells in the order of the colours.
  std::array<std::vector<Cell>, 8> colours_;
};

}  // namespace muslin
