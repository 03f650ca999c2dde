// VoxelRows loops over the voxels of a lattice by pieces of rows along x, whose corners are four runs of
// consecutive vertices, in parallel and with the same bits for any thread count.
//
// Slabs of pieces reach no farther than the next slab. All even slabs are computed before the odd ones, so
// that tasks that run at the same time write to different vertices. All sizes depend on the lattice alone.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "muslin/core/parallel.hpp"
#include "muslin/lattice/lattice.hpp"

namespace muslin {

/// Voxels first, first + 1, …: corner c (bits x, y, z) of the i-th is vertex rows[c / 2] + c % 2 + i.
struct VoxelPiece {
  static constexpr int longest = 32;
  std::array<int, 4> rows{};
  int length = 0;
  std::size_t first = 0;
  std::size_t number = 0;  ///< among all pieces
};

class VoxelRows {
 public:
  explicit VoxelRows(const Lattice& lattice);

  /// Returns the sum of term(piece) over all pieces. Terms of one vertex are computed in the same order for
  /// any thread count, and never at the same time.
  template <class Term>
  double sum(const Term& term) const {
    double total = 0;
    for (std::size_t parity = 0; parity < 2; ++parity) {
      total +=
          parallel_sum((slabs_.size() + 1 - parity) / 2, 1, 0.0, [&](std::size_t begin, std::size_t end) {
            double of_slabs = 0;
            for (std::size_t s = begin; s < end; ++s)
              for (const VoxelPiece& piece : slabs_[2 * s + parity]) of_slabs += term(piece);
            return of_slabs;
          });
    }
    return total;
  }
  std::size_t piece_count() const { return piece_count_; }
  /// Calls body(piece) in the order of sum().
  template <class Body>
  void for_each(const Body& body) const {
    sum([&](const VoxelPiece& piece) {
      body(piece);
      return 0.0;
    });
  }

 private:
  std::vector<std::vector<VoxelPiece>> slabs_;
  std::size_t piece_count_ = 0;
};

}  // namespace muslin
