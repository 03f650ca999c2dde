// Measures the parts of a step's time.
#pragma once

#include <map>
#include <string>

#include "problems.hpp"

namespace muslin::bench {

/// Nanoseconds per vertex and call, at the state of the problem and with the threads set: "energy_ns",
/// "gradient_ns", "linearise_ns" (with the factors of the preconditioner), "iteration_ns" (of conjugate
/// gradients); and "iteration_bytes", what such an iteration moves to and from memory per vertex, by count.
std::map<std::string, double> parts_of_a_step(const Problem& problem);

}  // namespace muslin::bench
