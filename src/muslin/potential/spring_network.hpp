// SpringNetwork lists the central springs of a body: pairs of vertices whose force is along the line between
// them.
#pragma once

#include <vector>

namespace muslin {

/// Springs between vertices a + i and b + i, 0 ≤ i < length.
struct CouplingRun {
  int kind = 0;  ///< the owner's own number, 0 … 255
  int a = 0, b = 0, length = 0;
};

struct SpringNetwork {
  std::vector<CouplingRun> runs;
  int vertex_count = 0;
  std::vector<float> weights;  ///< of the stiffness, by spring, counted through the runs; empty: all 1
};

/// Data of the springs of one kind.
struct CentralSpring {
  float stiffness = 0;  ///< k, in the caller's unit
  float rest = 0;       ///< r [m]
};

/// A spring shorter than this times its rest length has no direction.
inline constexpr double shortest_spring = 1e-12;

}  // namespace muslin
