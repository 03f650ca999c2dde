#include "muslin/report/energy_turnover.hpp"

#include <algorithm>
#include <cmath>

namespace muslin {

double EnergyTurnover::share() const {
  const double defect = std::max(std::abs(unbalanced), account_error);
  return defect > rounding ? defect / turned_over : 0;
}

EnergyTurnover measure_turnover(std::span<const Diagnostics> rows) {
  EnergyTurnover result;
  if (rows.empty()) return result;
  const auto constant = [](const Diagnostics& row) { return row.balance() - row.unbalanced; };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Diagnostics& row = rows[i];
    if (std::abs(row.unbalanced) > std::abs(result.unbalanced)) {
      result.unbalanced = row.unbalanced;
      result.frame_of_unbalanced = row.frame;
    }
    result.account_error = std::max(result.account_error, std::abs(constant(row) - constant(rows[0])));
    const Diagnostics& before = rows[i == 0 ? 0 : i - 1];
    for (double Diagnostics::* account :
         {&Diagnostics::kinetic, &Diagnostics::elastic, &Diagnostics::potential, &Diagnostics::work,
          &Diagnostics::dissipated}) {
      result.turned_over += std::abs(row.*account - before.*account) / 2;
      result.rounding = std::max(result.rounding, 1e-9 * std::abs(row.*account));
    }
  }
  return result;
}

}  // namespace muslin
