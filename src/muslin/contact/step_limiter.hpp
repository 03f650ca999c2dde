// StepLimiter limits a displacement locally so that surfaces never touch, which guarantees that nothing
// crosses.
//
//  1. A few passes remove only the excess normal approach of each pair; the rest of the motion stays.
//  2. Displacements that would leave the boxes in which the pairs are known are shortened to stay within,
//     unless a box moves away from its point: then the caller has to check where the point ends.
//  3. Conservative advancement of each pair shortens the displacement of the vertices that still come too
//     close; repeated for all pairs of these vertices, until none is left.
//
// The third part alone gives the guarantee (docs/theory/contact.md), the first makes it rarely needed. There
// is no common step length for all: one tight spot would stop all motion.
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
  /// Least gap that a step leaves to every pair that had more [m]. Absolute: a share of the gap at the start
  /// would let gaps shrink step by step until rounding lets features through.
  double gap_floor = 1e-5;
  /// Least share of its gap that a pair keeps, so that contact is not far stiffer at the end of a step.
  double kept_share = 0;
  /// #V, 1 for kinematic vertices: others give way to these. Empty: none.
  std::vector<std::uint8_t> prescribed;
  /// #V, vertices of the same number ≥ 0 are shortened together, −1: alone. Empty: all alone. For rigid
  /// bodies.
  std::vector<int> groups;
};

struct LimitReport {
  std::size_t deflected = 0;   ///< vertices that lost normal approach
  std::size_t clipped = 0;     ///< vertices stopped at the boxes: if any, update the candidates soon
  std::size_t shortened = 0;   ///< vertices shortened by conservative advancement
  std::size_t rounds = 0;      ///< of conservative advancement
  double smallest_factor = 1;  ///< of a vertex
};

class StepLimiter {
 public:
  /// Errors: usage, if sizes do not fit or the floor is not positive.
  StepLimiter(std::shared_ptr<const SurfaceMap> map, StepLimits limits);

  /// Changes the step `dq` (#V by 3, [m]) from q such that, on the whole straight path to q + dq, no
  /// candidate pair comes closer than its thickness + gap floor; a pair that is closer than that at q does
  /// not come closer. `at` holds the distances at J q, which must lie in the boxes of the candidates; missing
  /// ones are computed. Pairs at distance zero are ignored. `held`, #V or none: vertices that others give way
  /// to in this step, instead of those prescribed.
  LimitReport limit(PairDistances& at, Vectors dq, std::span<const std::uint8_t> held = {}) const;

 private:
  struct Work;
  std::shared_ptr<const SurfaceMap> map_;
  StepLimits limits_;
};

}  // namespace muslin
