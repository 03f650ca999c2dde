#include "muslin/fit/kes.hpp"

#include <cmath>

#include <fmt/format.h>

namespace muslin {
namespace {

double linearity_of(const KesSide& side) {
  if (side.linearity) return side.linearity->value;
  return 2 * side.tensile_energy->value / (kes_tension * side.extension->value);
}

}  // namespace

void check_kes_tension(const KesSide& side, const std::string& name) {
  const auto refuse = [&](const std::string& problem, const std::string& remedy) {
    return Error(ErrorKind::input, side.place, fmt::format("`{}` of [kes]{}", name, problem), remedy);
  };
  if (!side.linearity && !side.tensile_energy) return;
  if (!side.extension) throw refuse(" has no `EMT`", "add EMT, the strain in % at 500 gf/cm");
  if (!side.tensile_energy) return;
  const double linearity = 2 * side.tensile_energy->value / (kes_tension * side.extension->value);
  const char* remedy = "correct one of them: LT = 2 WT/(500 gf/cm · EMT)";
  if (side.linearity && std::abs(linearity / side.linearity->value - 1) > 0.1)
    throw refuse(
        fmt::format(": LT is {:.3g}, but WT and EMT make it {:.3g}", side.linearity->value, linearity),
        remedy);
  if (!fits(linearity, kes_linearities))
    throw refuse(fmt::format(": WT and EMT make LT {:.3g}, which no fabric has", linearity), remedy);
}

std::optional<TensileTest> kes_strip(const KesSide& side, Thread direction) {
  if (!side.extension) return std::nullopt;
  TensileTest test;
  test.direction = direction;
  test.held = side.held;
  test.place = side.place;
  const double extension = side.extension->value;
  if (!side.linearity && !side.tensile_energy) {
    test.points.emplace_back(extension, kes_tension);
    return test;
  }
  const double exponent = 2 / linearity_of(side) - 1;
  constexpr int count = 8;
  for (int i = 1; i <= count; ++i) {
    const double share = static_cast<double>(i) / count;
    test.points.emplace_back(share * extension, kes_tension * std::pow(share, exponent));
  }
  return test;
}

}  // namespace muslin
