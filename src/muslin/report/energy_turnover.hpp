// EnergyTurnover measures the energy account of a run.
#pragma once

#include <span>

#include "muslin/simulation/diagnostics.hpp"

namespace muslin {

/// Energies in joule. The energy turned over is what the scene brings into motion: the kinetic energy at the
/// start, the elastic energy released from it, the range of potential energy, and the range of work. Exchange
/// between kinetic and elastic energy does not count, or a trembling cloth would excuse its own defects.
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
