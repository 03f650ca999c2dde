#include <cmath>

#include "verify_case.hpp"

namespace muslin::app {

double Comparison::deviation() const {
  const double difference = std::abs(measured - reference);
  return relative ? difference / std::abs(reference) : difference;
}

bool Comparison::passed() const { return deviation() <= tolerance; }

const std::vector<VerifyCase>& verify_cases() {
  static const std::vector<VerifyCase> all = [] {
    std::vector<VerifyCase> cases;
    for (const auto& part : {stepping_cases(),
                             motion_cases(),
                             elasticity_cases(),
                             bending_cases(),
                             shell_cases(),
                             fabric_bending_cases(),
                             fabric_membrane_cases(),
                             fabric_plate_cases(),
                             fabric_roof_cases(),
                             fabric_hemisphere_cases(),
                             fabric_motion_cases(),
                             fabric_hanging_cases(),
                             fabric_stick_slip_cases(),
                             resolution_cases(),
                             drape_cases(),
                             fit_cases(),
                             friction_cases(),
                             impact_cases(),
                             promise_cases(),
                             contact_cases(),
                             trust_cases()})
      cases.insert(cases.end(), part.begin(), part.end());
    return cases;
  }();
  return all;
}

}  // namespace muslin::app
