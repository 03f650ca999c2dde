// EnergyTurnover measures the energy account of a run.
#pragma once

#include <span>

#include "muslin/simulation/diagnostics.hpp"

namespace muslin {

/// Energies in joule. Every joule that leaves one account (kinetic, elastic, potential, supplied by work,
/// dissipated) enters another, so the energy turned over is half the sum of the changes of all accounts from
/// frame to frame.
struct EnergyTurnover {
  double turned_over = 0;
  double unbalanced = 0;  ///< the largest work of residuals since the start, by magnitude
  int frame_of_unbalanced = 0;
  /// The largest change of the sum of accounts that residuals do not explain.
  double account_error = 0;
  double rounding = 0;  ///< 1e-9 of the largest account: smaller defects are noise

  /// Returns the larger defect over the energy turned over; 0 if it is noise.
  double share() const;
};
EnergyTurnover measure_turnover(std::span<const Diagnostics> rows);

}  // namespace muslin
