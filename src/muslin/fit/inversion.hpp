// Inverts measurements to the numbers of a shell's material by formulas that are exact for its laws.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "muslin/fit/measurements.hpp"
#include "muslin/material/shell_material.hpp"

namespace muslin {

/// A number as material files have it, with six digits.
std::string written_number(double value);

/// A key of [shell] and how its value was found.
struct FittedValue {
  std::string key;
  double value = 0;                    ///< unless there is a curve
  std::optional<MeasuredCurve> curve;  ///< in the units of the key
  std::string unit;                    ///< of the value
  std::string from;                    ///< the measurement, or the rule of a guess
  bool guess = false;
  std::optional<double> plus_minus = {};  ///< standard uncertainty; of a curve: as a share of its forces
  /// Misfit of a curve: the root of Σ (measured − fitted)² / Σ measured² of its stresses; none of a number.
  std::optional<double> residual = {};
};

struct Inversion {
  std::vector<FittedValue> values;  ///< in the order of the keys of [shell]
  std::vector<std::string> notes;   ///< for the user
};

/// Fits every key without its uncertainty. Those that were not measured get a value by a rule that `from`
/// states. Errors: input, with the place of the test.
Inversion invert(const Measurements& measurements);

/// Returns the value of the key; null if there is none.
const FittedValue* find_value(const Inversion& inversion, const std::string& key);

}  // namespace muslin
