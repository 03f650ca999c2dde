// A fabric found again from a test of it.
#include <optional>

#include "verify_case.hpp"

#include "muslin/fit/fit.hpp"

namespace muslin::app {
namespace {

/// The drape of a known fabric on a fine mesh, and the bending that a fit with its usual mesh makes of it.
std::vector<Comparison> bending_from_a_drape() {
  constexpr double warp = 1.2e-5, weft = warp * 8.7 / 13.6;
  Measurements m;
  m.name = "known";
  m.areal_density = Measured{0.15, std::nullopt};
  m.drape.emplace();
  m.drape->coefficient = Measured{0.5, 0.02};
  Measurements with_bending = m;
  for (const auto& [direction, rigidity] : {std::pair{Thread::warp, warp}, {Thread::weft, weft}}) {
    BendingTest test;
    test.direction = direction;
    test.rigidity = Measured{rigidity, std::nullopt};
    with_bending.bending.push_back(test);
  }
  DrapeOptions fine;
  fine.rings = 12;
  fine.drops = 3;
  m.drape->coefficient->value = fit_fabric(with_bending, fine).simulated_drape.value_or(0);
  const ShellMaterial found = fit_fabric(m).material.shell.value_or(ShellMaterial());
  return {{"bending_warp [N m]", warp, found.bending_warp, 0.15},
          {"bending_weft [N m]", weft, found.bending_weft, 0.15}};
}

}  // namespace

std::vector<VerifyCase> fit_cases() {
  return {{"fit-drape", "muslin fit finds the bending of a fabric that was draped on a finer mesh",
           "the fabric", true, bending_from_a_drape}};
}

}  // namespace muslin::app
