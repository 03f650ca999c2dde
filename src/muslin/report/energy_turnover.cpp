#include "muslin/report/energy_turnover.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace muslin {

double EnergyTurnover::share() const {
  const double defect = std::max(std::abs(unbalanced), account_error);
  return defect > rounding ? defect / turned_over : 0;
}

EnergyTurnover measure_turnover(std::span<const Diagnostics> rows) {
  EnergyTurnover result;
  if (rows.empty()) return result;
  const auto constant = [](const Diagnostics& row) { return row.balance() - row.unbalanced; };
  const auto ends = [&](double Diagnostics::* account) {
    const auto [least, most] = std::minmax_element(
        rows.begin(), rows.end(), [&](const auto& a, const auto& b) { return a.*account < b.*account; });
    return std::pair{(*least).*account, (*most).*account};
  };
  const auto range = [&](double Diagnostics::* account) {
    const auto [least, most] = ends(account);
    return most - least;
  };
  result.turned_over = rows[0].kinetic + rows[0].elastic - ends(&Diagnostics::elastic).first +
                       range(&Diagnostics::potential) + range(&Diagnostics::work);
  for (const Diagnostics& row : rows) {
    if (std::abs(row.unbalanced) > std::abs(result.unbalanced)) {
      result.unbalanced = row.unbalanced;
      result.frame_of_unbalanced = row.frame;
    }
    result.account_error = std::max(result.account_error, std::abs(constant(row) - constant(rows[0])));
    for (double Diagnostics::* account :
         {&Diagnostics::kinetic, &Diagnostics::elastic, &Diagnostics::potential, &Diagnostics::work,
          &Diagnostics::dissipated})
      result.rounding = std::max(result.rounding, 1e-9 * std::abs(row.*account));
  }
  return result;
}

}  // namespace muslin
