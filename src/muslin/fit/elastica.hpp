// Shapes of heavy strips: solutions of the planar elastica under its own weight,
//
//   D κ' = H sin θ − w s cos θ,  θ' = κ,  x' = cos θ,  z' = sin θ,
//
// with s from the free end of a cantilever (H = 0) or the lowest point of a loop, H the horizontal tension
// there and w the weight per width and length. Lengths are in any unit; the result is (D/w)^(1/3) in that
// unit, the bending length of Peirce (The "handle" of cloth as a measurable quantity, 1930).
#pragma once

#include "muslin/fit/measurements.hpp"

namespace muslin {

/// Returns the bending length of a strip clamped horizontally whose end is seen from the clamp at `angle`
/// below the horizontal [rad], 0 < angle < π/2.
double cantilever_bending_length(double overhang, double angle);

/// Returns that of a loop of a strip of this length that hangs `height` below its grip. Errors: input, if no
/// bending stiffness makes such a loop.
double loop_bending_length(LoopShape shape, double strip_length, double height);

}  // namespace muslin
