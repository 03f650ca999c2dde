// The tensile test of a sheet of the Kawabata Evaluation System: EMT, LT and WT state a curve,
//
//   F = F_m (e/EMT)ⁿ,  F_m = 500 gf/cm,  n = 2/LT − 1,  LT = 2 WT/(F_m · EMT),
//
// with strain e and force per width F (Kawabata, The standardization and analysis of hand evaluation, 1980).
#pragma once

#include <optional>
#include <string>

#include "muslin/core/toml_table.hpp"
#include "muslin/fit/measurements.hpp"

namespace muslin {

inline constexpr Range kes_linearities{0.1, 1.5, false};  ///< of LT

/// Checks what a side states of tension; `name` is its key. LT or WT alone is enough beside EMT. Errors:
/// input, if EMT is missing, if LT and WT disagree by more than 10 %, or if WT means an LT that no fabric
/// has.
void check_kes_tension(const KesSide& side, const std::string& name);

/// Returns the strip test that a side stands for; none without EMT. It is a straight line of one point if the
/// side states neither LT nor WT.
std::optional<TensileTest> kes_strip(const KesSide& side, Thread direction);

}  // namespace muslin
