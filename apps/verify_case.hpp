// Declares the cases of `muslin verify`: physics with a known answer, run through the library as a user
// would.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace muslin::app {

/// One number against its reference.
struct Comparison {
  std::string quantity;
  double reference = 0;
  double measured = 0;
  double tolerance = 0;
  bool relative = true;  ///< deviation and tolerance are shares of |reference|, else in its unit

  double deviation() const;
  bool passed() const;  ///< false also for NaN
};

struct VerifyCase {
  std::string name;
  std::string claim;   ///< one sentence
  std::string source;  ///< of the reference values
  bool slow = false;   ///< takes more than about a second
  std::function<std::vector<Comparison>()> run;
};

/// All cases, in the order they are run. Names are unique.
const std::vector<VerifyCase>& verify_cases();

/// Return the cases of each source file.
std::vector<VerifyCase> stepping_cases();
std::vector<VerifyCase> motion_cases();
std::vector<VerifyCase> elasticity_cases();
std::vector<VerifyCase> bending_cases();
std::vector<VerifyCase> shell_cases();
std::vector<VerifyCase> fabric_bending_cases();
std::vector<VerifyCase> fabric_membrane_cases();
std::vector<VerifyCase> fabric_plate_cases();
std::vector<VerifyCase> fabric_roof_cases();
std::vector<VerifyCase> fabric_hemisphere_cases();
std::vector<VerifyCase> fabric_motion_cases();
std::vector<VerifyCase> fabric_hanging_cases();
std::vector<VerifyCase> fabric_stick_slip_cases();
std::vector<VerifyCase> resolution_cases();
std::vector<VerifyCase> fit_cases();
std::vector<VerifyCase> drape_cases();
std::vector<VerifyCase> friction_cases();
std::vector<VerifyCase> contact_cases();
std::vector<VerifyCase> impact_cases();
std::vector<VerifyCase> promise_cases();
std::vector<VerifyCase> trust_cases();
std::vector<VerifyCase> trust_motion_cases();  ///< a part of trust_cases()

}  // namespace muslin::app
