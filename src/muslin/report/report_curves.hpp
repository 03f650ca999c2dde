// Plots the numbers of a run over time, for its report.
#pragma once

#include <vector>

#include "muslin/render/plot.hpp"
#include "muslin/simulation/diagnostics.hpp"

namespace muslin {

/// Returns plots of energy, stretch, gap, iterations, error and steps; those without a number are left out.
std::vector<Plot> report_curves(const std::vector<Diagnostics>& rows);

}  // namespace muslin
