// Simulates Cusick's drape test: a disc of cloth, held between two smaller discs, hangs over their edge. The
// drape coefficient is the share of the overhanging ring that the shadow of the cloth covers (BS 5058, ISO
// 9073-9).
#pragma once

#include <string>
#include <vector>

#include "muslin/core/progress.hpp"
#include "muslin/fit/measurements.hpp"
#include "muslin/material/material.hpp"

namespace muslin {

struct DrapeOptions {
  int rings = 9;               ///< of cells from the support to the edge of the cloth
  int drops = 2;               ///< simulated drapes, each from another small unevenness
  int most = 12;               ///< of the materials that a fit tries
  std::string mesh = "right";  ///< triangulation of the ring, a kind of geometry/triangulated_strip
};

struct Drape {
  double coefficient = 0;
  int folds = 0;  ///< maxima of the outline's distance from the middle that rise by a tenth of the overhang
};

/// Drapes a material with [shell], once for each drop. Limits of stretch do not act. Errors: solver.
std::vector<Drape> simulate_drapes(const Material& material, const DrapeTest& test,
                                   const DrapeOptions& options, const Progress& progress = {});

/// Returns the mean coefficient of the drops.
double drape_coefficient(const Material& material, const DrapeTest& test, const DrapeOptions& options,
                         const Progress& progress = {});

}  // namespace muslin
