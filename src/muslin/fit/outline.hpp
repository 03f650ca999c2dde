// Reads the outline of a drape's shadow, as a photograph or a scanner gives it.
#pragma once

#include <filesystem>

#include "muslin/fit/measurements.hpp"

namespace muslin {

/// Returns the drape coefficient, a share, of a file of points in order around the shadow, in units of `unit`
/// metres; the test states the diameters. Errors: file; input with the line of the point, if the outline
/// crosses or touches itself, leaves the specimen or runs over the support.
double outline_coefficient(const std::filesystem::path& file, double unit, const DrapeTest& test);

}  // namespace muslin
