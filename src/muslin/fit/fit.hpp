// Fits a fabric to measurements: the material, with the origin and the uncertainty of each number.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "muslin/core/progress.hpp"
#include "muslin/fit/drape.hpp"
#include "muslin/fit/inversion.hpp"
#include "muslin/fit/measurements.hpp"
#include "muslin/material/material.hpp"

namespace muslin {

struct Fit {
  std::vector<FittedValue> values;
  std::vector<std::string> notes;
  std::vector<std::string> warnings;       ///< of measurements that contradict each other
  std::optional<Measured> measured_drape;  ///< coefficient, a share
  std::optional<double> simulated_drape;   ///< of the material
  std::string text;                        ///< the material file
  Material material;                       ///< as read from it
};

/// Fits a material: first every number by formulas (fit/inversion.hpp), then, if a drape is measured and
/// bending is not, bending by simulated drapes (fit/drape.hpp); with bending measured, the drape is only
/// simulated. Uncertainties are linear: every measured number is shifted by its own, and the squares of what
/// that changes are summed. The same input gives the same bits for any number of threads. Errors: input, with
/// the place of the test; solver.
Fit fit_fabric(const Measurements& measurements, const DrapeOptions& options = {},
               const Progress& progress = {});

/// Returns the values as a table for people: key, value, uncertainty, residual, origin; then the notes.
std::string fit_table(const Fit& fit);

}  // namespace muslin
