#include "muslin/material/shell_material.hpp"

#include <cmath>

#include <fmt/format.h>

#include "muslin/core/toml_table.hpp"

namespace muslin {
namespace {

constexpr Range modulus{0, 1e12, false};
constexpr Range damping{0, 1e6, false};

/// Returns the bias rigidity of an orthotropic plate whose twisting rigidity is the geometric mean of the two
/// bending ones.
double bias_between(double warp, double weft) {
  const double sum = std::sqrt(warp) + std::sqrt(weft);
  return sum * sum / 4;
}

double lowest_bias(double warp, double weft) {
  const double difference = std::sqrt(warp) - std::sqrt(weft);
  return difference * difference / 4;
}

}  // namespace

const std::vector<std::string>& shell_material_keys() {
  static const std::vector<std::string> keys = {"areal_density",     "membrane_warp",  "membrane_weft",
                                                "membrane_shear",    "poisson",        "bending_warp",
                                                "bending_weft",      "bending_bias",   "mass_damping",
                                                "stiffness_damping", "bending_damping"};
  return keys;
}

ShellMaterial read_shell_material(const TomlTable& table, const ShellMaterial* base) {
  ShellMaterial m = base ? *base : ShellMaterial{};
  const auto required = [&](const char* key, const char* unit, const Range& range, double& value) {
    value = base ? table.number(key, unit, range, value) : table.number(key, unit, range);
  };
  const auto optional = [&](const char* key, const char* unit, const Range& range, double fallback,
                            double& value) {
    value = table.number(key, unit, range, base ? value : fallback);
  };
  required("areal_density", "kg/m²", {0, 1e6, true}, m.areal_density);
  required("membrane_warp", "N/m", modulus, m.membrane_warp);
  optional("membrane_weft", "N/m", modulus, m.membrane_warp, m.membrane_weft);
  optional("poisson", "", {-0.99, 0.99, false}, 0.25, m.poisson);
  optional("membrane_shear", "N/m", modulus,
           std::sqrt(m.membrane_warp * m.membrane_weft) / (2 * (1 + m.poisson)), m.membrane_shear);
  required("bending_warp", "N·m", modulus, m.bending_warp);
  optional("bending_weft", "N·m", modulus, m.bending_warp, m.bending_weft);
  optional("bending_bias", "N·m", modulus, bias_between(m.bending_warp, m.bending_weft), m.bending_bias);
  optional("mass_damping", "1/s", damping, 0, m.mass_damping);
  optional("stiffness_damping", "s", damping, 0, m.stiffness_damping);
  optional("bending_damping", "s", damping, m.stiffness_damping, m.bending_damping);
  const double lowest = lowest_bias(m.bending_warp, m.bending_weft);
  if (m.bending_bias < lowest * (1 - 1e-12)) {
    const char* key = table.has("bending_bias") ? "bending_bias" : "bending_warp";
    throw table.error(
        key,
        fmt::format(
            "with {:.4g} N·m at 45° between {:.4g} and {:.4g} N·m some direction would have a negative "
            "bending rigidity",
            m.bending_bias, m.bending_warp, m.bending_weft),
        fmt::format("give `bending_bias` at least {:.4g}", lowest));
  }
  return m;
}

}  // namespace muslin
