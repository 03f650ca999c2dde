// Writes the material file of a fit.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "muslin/fit/inversion.hpp"

namespace muslin {

struct MaterialFile {
  std::string name, description, source;
  std::vector<FittedValue> values;
  std::vector<std::pair<std::string, double>> reference;  ///< measured numbers that the material does not use
  std::vector<std::string> warnings;                      ///< of the measurements
  std::string measurements;                               ///< name of their file
};

/// Returns a file that read_material reads: every number with its uncertainty and origin as a comment, those
/// that are not measured as `guesses`, uncertainties and residuals in [reference].
std::string material_text(const MaterialFile& file);

}  // namespace muslin
