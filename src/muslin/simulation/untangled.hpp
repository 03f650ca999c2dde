// Untangled reports what was pulled apart at the start of a run.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "muslin/api.hpp"

namespace muslin {

/// Work of a repair.
struct MUSLIN_API Untangled {
  std::size_t crossings = 0;  ///< pairs of triangles that crossed
  std::size_t lost = 0;       ///< points that were on a wrong side
  std::size_t close = 0;      ///< pairs of features that were closer than their thickness
  std::size_t left = 0;       ///< pairs of triangles that still cross
  std::size_t lost_left = 0;  ///< points that are still on a wrong side
  double depth = 0;           ///< of the deepest point [m]
  double moved = 0;           ///< greatest displacement [m]
  int steps = 0;
  std::vector<std::string> places;  ///< the first of those left, in words

  bool needed() const { return crossings + lost + close > 0; }
};

/// Returns sentences for the user; empty if nothing was needed.
MUSLIN_API std::string describe(const Untangled& repair);

}  // namespace muslin
