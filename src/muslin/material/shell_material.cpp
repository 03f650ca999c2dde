#include "muslin/material/shell_material.hpp"

#include <cmath>

#include <fmt/format.h>

#include "muslin/core/toml_table.hpp"
#include "muslin/schema/declare.hpp"

namespace muslin {
namespace {

constexpr Range sheet_modulus{0, 1e12, false};
constexpr Range sheet_damping{0, 1e6, false};

/// Returns the bias rigidity of an orthotropic plate whose twisting rigidity is the geometric mean of the two
/// bending ones.
double bias_between(double warp, double weft) {
  const double sum = std::sqrt(warp) + std::sqrt(weft);
  return sum * sum / 4;
}

/// Below it the plate would not resist twisting (energy/hinge_coupling.hpp).
double lowest_bias(double warp, double weft, double poisson) {
  return (warp + weft + 2 * poisson * std::sqrt(warp * weft)) / 4;
}

/// Derives missing values from given ones.
void complete(const TomlTable& table, ShellMaterial& m) {
  if (table.has("base")) return;
  if (!table.has("membrane_weft")) m.membrane_weft = m.membrane_warp;
  if (!table.has("poisson")) m.poisson = 0.25;
  if (!table.has("membrane_shear"))
    m.membrane_shear = std::sqrt(m.membrane_warp * m.membrane_weft) / (2 * (1 + m.poisson));
  if (!table.has("bending_weft")) m.bending_weft = m.bending_warp;
  if (!table.has("bending_bias")) m.bending_bias = bias_between(m.bending_warp, m.bending_weft);
  if (!table.has("bending_damping")) m.bending_damping = m.stiffness_damping;
}

void check_bias(const ShellMaterial& m, const schema::Subject& subject) {
  const double lowest = lowest_bias(m.bending_warp, m.bending_weft, m.poisson);
  if (m.bending_bias >= lowest * (1 - 1e-12)) return;
  const bool bias_is_given = subject.table() == nullptr || subject.table()->has("bending_bias");
  throw subject.error(
      bias_is_given ? "bending_bias" : "bending_warp",
      fmt::format(
          "with {:.4g} N·m at 45° between {:.4g} and {:.4g} N·m and a Poisson ratio of {:.4g} the sheet "
          "would twist by itself",
          m.bending_bias, m.bending_warp, m.bending_weft, m.poisson),
      fmt::format("give `bending_bias` at least {:.4g}", lowest));
}

schema::Table declared() {
  using schema::number;
  schema::Table table = schema::table_of<ShellMaterial>(
      "[shell]",
      {number("areal_density", &ShellMaterial::areal_density)
           .unit("kg/m²")
           .range({0, 1e6, true})
           .required_without({"base"})
           .means("mass per area"),
       number("membrane_warp", &ShellMaterial::membrane_warp)
           .unit("N/m")
           .range(sheet_modulus)
           .required_without({"base"})
           .means("force per width and strain along warp: Young's modulus × thickness"),
       number("membrane_weft", &ShellMaterial::membrane_weft)
           .unit("N/m")
           .range(sheet_modulus)
           .otherwise("`membrane_warp`")
           .means("along weft"),
       number("membrane_shear", &ShellMaterial::membrane_shear)
           .unit("N/m")
           .range(sheet_modulus)
           .otherwise("as in an isotropic sheet")
           .means("force per width and radian"),
       number("poisson", &ShellMaterial::poisson)
           .range({-0.99, 0.99, false})
           .otherwise("0.25")
           .means("of stretch and of bending: geometric mean of the two directions' Poisson's ratios"),
       number("bending_warp", &ShellMaterial::bending_warp)
           .unit("N·m")
           .range(sheet_modulus)
           .required_without({"base"})
           .means("moment per width and curvature, warp bent"),
       number("bending_weft", &ShellMaterial::bending_weft)
           .unit("N·m")
           .range(sheet_modulus)
           .otherwise("`bending_warp`")
           .means("weft bent"),
       number("bending_bias", &ShellMaterial::bending_bias)
           .unit("N·m")
           .range(sheet_modulus)
           .otherwise("between the two")
           .means("bent at 45°; at least (warp + weft + 2 ν √(warp weft))/4, where the sheet no longer "
                  "resists twisting"),
       number("mass_damping", &ShellMaterial::mass_damping)
           .unit("1/s")
           .range(sheet_damping)
           .means("Rayleigh's α: slows all motion"),
       number("stiffness_damping", &ShellMaterial::stiffness_damping)
           .unit("s")
           .range(sheet_damping)
           .means("Rayleigh's β of stretch and shear"),
       number("bending_damping", &ShellMaterial::bending_damping)
           .unit("s")
           .range(sheet_damping)
           .otherwise("`stiffness_damping`")
           .means("Rayleigh's β of bending")});
  table.complete = [](const TomlTable& given, void* settings) {
    complete(given, *static_cast<ShellMaterial*>(settings));
  };
  schema::add_rule<ShellMaterial>(table, check_bias);
  return table;
}

}  // namespace

const schema::Table& shell_material_table() {
  static const schema::Table table = declared();
  return table;
}

}  // namespace muslin
