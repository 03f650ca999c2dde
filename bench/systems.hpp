// The linear systems of Newton's method: how many iterations they take as bodies are cut finer.
#pragma once

#include <map>
#include <string>

#include "problems.hpp"

namespace muslin::bench {

/// A lattice's first linear system of a step of `dt` [s] from its state, H projected. Iterations and
/// milliseconds to each tolerance: "iterations_1e-3", "system_1e-3_ms".
std::map<std::string, double> lattice_system(const Problem& problem, double dt);

/// Steps of 1/240 s of a square of cloth of n by n squares that hangs from two corners: 1 m wide, 0.2 kg/m²,
/// 1000 N/m, from rest. "steps_ms" a step, "newton" and "linear" iterations a step.
std::map<std::string, double> cloth_steps(int n, bool coarse_space);

}  // namespace muslin::bench
