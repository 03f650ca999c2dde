// Finds round numbers for the ticks of an axis.
#pragma once

#include <string>
#include <vector>

namespace muslin {

struct Ticks {
  double step = 1;                  ///< 1, 2 or 5 times a power of ten
  std::vector<double> values;       ///< multiples of step within [low, high], ascending
  std::vector<std::string> labels;  ///< each with the digits that step needs
};

/// Returns about `wanted` ticks. A range without extent is widened about its value.
Ticks round_ticks(double low, double high, int wanted);

}  // namespace muslin
