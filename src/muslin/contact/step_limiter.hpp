// Takes from a step what would make surfaces touch, locally: the guarantee that nothing ever crosses.
//
//  1. A few passes take away only the excess normal approach of each pair; the rest of the motion stays.
//  2. Vertices whose points would leave the boxes in which the pairs are known are shortened to stay within,
//     unless a box goes away from its point: then the caller has to look where the point ends.
//  3. Conservative advancement of each pair shortens the step of the vertices of those that still come too
//     close; again for all pairs that these vertices touch, until there is none.
//
// The third part alone gives the guarantee (docs/theory/contact.md), the first makes it rarely needed. Never
// one step length for all: a tight spot anywhere would freeze everything.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "muslin/contact/pair_distances.hpp"
#include "muslin/contact/surface_map.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

struct StepLimits {
  /// The gap that a step leaves every pair that had more [m]. Absolute: a share of the gap at the start would
  /// let gaps shrink step by step until rounding lets features through.
  double gap_floor = 1e-5;
  /// And this share of what it had, so that no step ends where contact is far stiffer than where it began.
  double kept_share = 0;
  /// #V, 1 for vertices that move along keyframes: others give way to them. Empty: none.
  std::vector<std::uint8_t> prescribed;
  /// #V, vertices of the same number ≥ 0 are shortened together, −1: alone. Empty: all alone. For what must
  /// keep its shape.
  std::vector<int> groups;
};

struct LimitReport {
  std::size_t deflected = 0;   ///< vertices that lost normal approach
  std::size_t clipped = 0;     ///< vertices stopped at the boxes: if any, find the candidates anew soon
  std::size_t shortened = 0;   ///< vertices shortened by conservative advancement
  std::size_t rounds = 0;      ///< of conservative advancement
  double smallest_factor = 1;  ///< by which a vertex was shortened
};

class StepLimiter {
 public:
  /// Errors: usage, if sizes do not fit or the floor is not positive.
  StepLimiter(std::shared_ptr<const SurfaceMap> map, StepLimits limits);

  /// Changes the step `dq` (#V by 3, [m]) from q such that no pair of the candidates comes closer than its
  /// thickness + gap floor, or, if it is closer than that at q, any closer, all along the straight way to
  /// q + dq. `at` are the distances at J q, which must lie in the boxes of the candidates; what is missing
  /// there is found. Pairs at distance zero are left free. `held`, #V or none: vertices that others give way
  /// to in this step, instead of those prescribed.
  LimitReport limit(PairDistances& at, Vectors dq, std::span<const std::uint8_t> held = {}) const;

 private:
  struct Work;
  std::shared_ptr<const SurfaceMap> map_;
  StepLimits limits_;
};

}  // namespace muslin
