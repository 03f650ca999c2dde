// How the springs of a lattice are walked in parallel with the same bits for any thread count.
//
// Vertices are cut into slabs of consecutive indices (rows and layers of the lattice, since its vertices are
// sorted). A slab's task writes to its own vertices only: a spring between two slabs is computed by both.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "muslin/core/parallel.hpp"
#include "muslin/lattice/springs.hpp"

namespace muslin {

/// Part of a SpringRun whose springs begin in one slab and end in one slab.
struct SpringPiece {
  int direction = 0;
  int a = 0;
  int b = 0;
  int length = 0;
  std::int64_t first = 0;
};

class SpringSlabs {
 public:
  explicit SpringSlabs(const Springs& springs);

  /// Calls inner(piece) for the pieces that lie in a slab, leaving(piece) and entering(piece) for those
  /// whose a or whose b alone does; slabs run in parallel, the pieces of one in a fixed order.
  template <class Inner, class Leaving, class Entering>
  void for_each_piece(const Inner& inner, const Leaving& leaving, const Entering& entering) const {
    parallel_for(slabs_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s) {
        for (const SpringPiece& piece : slabs_[s].inner) inner(piece);
        for (const SpringPiece& piece : slabs_[s].leaving) leaving(piece);
        for (const SpringPiece& piece : slabs_[s].entering) entering(piece);
      }
    });
  }

  /// The sum (or other combination by +) of term(piece) over all springs, each taken once.
  template <class Value, class Term>
  Value sum(Value zero, const Term& term) const {
    return parallel_sum(slabs_.size(), 1, zero, [&](std::size_t begin, std::size_t end) {
      Value total = zero;
      for (std::size_t s = begin; s < end; ++s) {
        for (const SpringPiece& piece : slabs_[s].inner) total = total + term(piece);
        for (const SpringPiece& piece : slabs_[s].leaving) total = total + term(piece);
      }
      return total;
    });
  }

 private:
  struct Slab {
    std::vector<SpringPiece> inner, leaving, entering;
  };
  std::vector<Slab> slabs_;
};

}  // namespace muslin
