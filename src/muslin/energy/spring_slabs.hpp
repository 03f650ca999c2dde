// SpringSlabs loops over the springs of a lattice: in parallel with the same bits for any thread count, and
// with vectors as columns (one array per coordinate), which vector code reads and writes without shuffling.
//
// Vertices are cut into slabs of consecutive indices (rows and layers of the lattice, since its vertices are
// sorted), one task each, and slabs into blocks. A slab's task writes to its own vertices only: a spring
// between two slabs is computed by both. The task turns the vectors it needs into columns block by block
// shortly before they are used, and adds the result of a block to the caller's vectors when its last spring
// is done, so that the data stays in the caches.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "muslin/core/parallel.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/energy/spring_kernels.hpp"
#include "muslin/potential/spring_network.hpp"

namespace muslin {

/// The ends of a piece's springs that lie in the slab that computes it.
enum class Ends : std::uint8_t { both, a, b };

/// Springs a + i — b + i, 0 ≤ i < length, a < b; a in one block and b in one slab.
struct SpringPiece {
  int direction = 0;
  int a = 0;
  int b = 0;
  int length = 0;
  std::int64_t slot = 0;  ///< of the first spring
  Ends ends = Ends::both;
};

/// A piece with its vertices' columns.
template <int inputs>
struct SpringColumns {
  std::array<Columns, inputs> a, b;  ///< of the vectors read
  SpringTargets to;
  double* w = nullptr;  ///< added to: energy by spring
};

class SpringSlabs {
 public:
  static constexpr int block_size = 1024;  // vertices

  SpringSlabs() = default;
  /// Runs with a < b; slots count through them.
  SpringSlabs(const std::vector<CouplingRun>& runs, int vertex_count);

  /// Calls apply(piece, columns) for every spring of every slab; returns the sum of the energies that it
  /// writes to columns.w. load(v, n, columns) loads the vectors of n vertices from v into the columns. The
  /// result is added to y, which may be empty: then each spring is computed once, for its energy.
  template <int inputs, class Load, class Apply>
  double sweep(Vectors y, const Load& load, const Apply& apply) const {
    return parallel_sum(slabs_.size(), 1, 0.0, [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t s = begin; s < end; ++s) sum += sweep_slab<inputs>(slabs_[s], y, load, apply);
      return sum;
    });
  }

  /// blocks of both ends += block(piece, i) over all springs.
  template <class Block3>
  void add_blocks(std::span<Mat3> blocks, const Block3& block) const {
    parallel_for(slabs_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = first_piece(begin); p < first_piece(end); ++p) {
        const SpringPiece& piece = pieces_[p];
        for (int i = 0; i < piece.length; ++i) {
          const Mat3 of_spring = block(piece, i);
          if (piece.ends != Ends::b) blocks[static_cast<std::size_t>(piece.a + i)] += of_spring;
          if (piece.ends != Ends::a) blocks[static_cast<std::size_t>(piece.b + i)] += of_spring;
        }
      }
    });
  }

  /// Returns the sum (or other combination by +) of term(piece) over all springs, each taken once.
  template <class Value, class Term>
  Value sum(Value zero, const Term& term) const {
    return parallel_sum(slabs_.size(), 1, zero, [&](std::size_t begin, std::size_t end) {
      Value total = zero;
      for (std::size_t p = first_piece(begin); p < first_piece(end); ++p)
        if (pieces_[p].ends != Ends::b) total = total + term(pieces_[p]);
      return total;
    });
  }

 private:
  struct Block {
    int begin = 0, end = 0;             // vertices
    int read_end = 0, written_end = 0;  // of the vertices that its pieces need, and add to
    std::size_t piece_begin = 0, piece_end = 0;
  };
  struct Slab {
    int begin = 0, end = 0;            // vertices
    int read_begin = 0, read_end = 0;  // vertices that its pieces need
    std::size_t block_begin = 0, block_end = 0;
  };

  std::size_t first_piece(std::size_t slab) const {
    return slab < slabs_.size() ? blocks_[slabs_[slab].block_begin].piece_begin : pieces_.size();
  }

  template <int inputs, class Load, class Apply>
  double sweep_slab(const Slab& slab, Vectors y, const Load& load, const Apply& apply) const {
    const std::size_t stride = column_stride(slab.read_end - slab.read_begin);
    double* memory = column_memory((inputs + 1) * 3 * stride);
    const auto columns = [&] {
      const Columns c{memory, memory + stride, memory + 2 * stride};
      memory += 3 * stride;
      return c;
    };
    std::array<Columns, inputs> in;
    for (Columns& c : in) c = columns();
    const Columns out = y.empty() ? Columns{} : columns();

    // Energies of springs counted by another slab are discarded.
    alignas(64) double w[block_size], counted_elsewhere[block_size] = {};
    double sum = 0;
    int loaded = slab.read_begin, cleared = slab.begin;
    for (std::size_t b = slab.block_begin; b < slab.block_end; ++b) {
      const Block& block = blocks_[b];
      const auto at = [&](int v) { return static_cast<std::ptrdiff_t>(v - slab.read_begin); };
      if (block.read_end > loaded) {
        std::array<Columns, inputs> to = in;
        for (Columns& c : to) c = c + at(loaded);
        load(static_cast<std::size_t>(loaded), block.read_end - loaded, to);
        loaded = block.read_end;
      }
      if (!y.empty()) {
        if (block.written_end > cleared) clear_columns(out + at(cleared), block.written_end - cleared);
        cleared = std::max(cleared, block.written_end);
      }
      std::fill_n(w, block.end - block.begin, 0.0);
      for (std::size_t p = block.piece_begin; p < block.piece_end; ++p) {
        const SpringPiece& piece = pieces_[p];
        if (piece.ends == Ends::b && y.empty()) continue;
        SpringColumns<inputs> c;
        for (std::size_t k = 0; k < inputs; ++k) c.a[k] = in[k] + at(piece.a), c.b[k] = in[k] + at(piece.b);
        if (!y.empty() && piece.ends != Ends::b) c.to.y_a = out + at(piece.a);
        if (!y.empty() && piece.ends != Ends::a) c.to.y_b = out + at(piece.b);
        c.to.b_after_a = piece.b - piece.a;
        c.w = piece.ends == Ends::b ? counted_elsewhere : w + (piece.a - block.begin);
        apply(piece, c);
      }
      sum += sum_of(w, block.end - block.begin);
      if (!y.empty())
        add_columns(out + at(block.begin), block.end - block.begin,
                    y[static_cast<std::size_t>(block.begin)].data());
    }
    return sum;
  }

  std::vector<SpringPiece> pieces_;  // by block
  std::vector<Block> blocks_;
  std::vector<Slab> slabs_;
};

/// Returns x_b − x_a of spring i of a piece.
inline Vec3 difference(ConstVectors x, const SpringPiece& piece, int i) {
  return x[static_cast<std::size_t>(piece.b + i)] - x[static_cast<std::size_t>(piece.a + i)];
}

}  // namespace muslin
