// Anderson's acceleration of a fixed-point iteration (D. G. Anderson, Iterative procedures for nonlinear
// integral equations, 1965; form of Walker and Ni, Anderson acceleration for fixed-point iterations, 2011).
#pragma once

#include <cstddef>
#include <vector>

#include "muslin/core/vectors.hpp"

namespace muslin {

/// Of an iteration x ← x + f(x) over #V by 3 vectors. Deterministic for any thread count.
class AndersonMixing {
 public:
  /// Looks back over so many iterations.
  explicit AndersonMixing(std::size_t depth) : depth_(depth) {}

  void clear() { steps_.clear(), changes_.clear(), last_.clear(); }

  /// The iteration has gone from some x to `there` = x + `step`. Fills `more`: x + step + more is where, for
  /// an affine f, the combination of the last iterates lies whose f is smallest. Returns whether there is
  /// any.
  bool mix(ConstVectors there, ConstVectors step, Vectors more);

 private:
  std::size_t depth_;
  std::vector<Vec3> last_, last_step_;      ///< the last `there` and `step`; empty: none
  std::vector<std::vector<Vec3>> steps_;    ///< differences of steps, the latest last
  std::vector<std::vector<Vec3>> changes_;  ///< differences of `there`
};

}  // namespace muslin
