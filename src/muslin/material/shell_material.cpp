#include "muslin/material/shell_material.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "muslin/core/toml_table.hpp"
#include "muslin/material/derive_anew.hpp"
#include "muslin/material/keyed_material.hpp"
#include "muslin/material/measured_sheet.hpp"
#include "muslin/material/varied_material.hpp"
#include "muslin/schema/declare.hpp"

namespace muslin {
namespace {

constexpr Range sheet_modulus{0, 1e12, false};
constexpr Range sheet_damping{0, 1e6, false};
constexpr schema::VaryingForms shell_forms{.map = true, .keyframes = true};
constexpr schema::VaryingForms unchanging_shell_forms{.map = true, .keyframes = false};

/// Returns the bias rigidity of an orthotropic plate whose twisting rigidity is the geometric mean of the two
/// bending ones.
double bias_between(double warp, double weft) {
  const double sum = std::sqrt(warp) + std::sqrt(weft);
  return sum * sum / 4;
}

/// Return a number in four digits, rounded so that the message's remedy holds.
std::string at_least(double least) {
  const std::string nearest = fmt::format("{:.4g}", least);
  return std::stod(nearest) >= least ? nearest : fmt::format("{:.4g}", least * (1 + 1e-3));
}
std::string at_most(double most) {
  const std::string nearest = fmt::format("{:.4g}", most);
  return std::stod(nearest) <= most ? nearest : fmt::format("{:.4g}", most * (1 - 1e-3));
}

/// Below it the plate would not resist twisting (energy/hinge_coupling.hpp).
double lowest_bias(double warp, double weft, double poisson) {
  return (warp + weft + 2 * poisson * std::sqrt(warp * weft)) / 4;
}

/// A number that follows from others unless it is given.
struct DerivedNumber {
  const char* key;
  const char* curve;  ///< in its place, or the key again
  double ShellMaterial::* value;
  double (*derive)(const ShellMaterial&);
};

constexpr DerivedNumber derived_numbers[] = {
    {"membrane_shear", "shear_curve", &ShellMaterial::membrane_shear,
     [](const ShellMaterial& m) {
       const SheetStress stress = stress_of(m);
       return std::sqrt(stress.warp.slope(0) * stress.weft.slope(0)) / (2 * (1 + m.poisson));
     }},
    {"bending_bias", "bending_bias", &ShellMaterial::bending_bias,
     [](const ShellMaterial& m) {
       const SheetMoments moments = moments_of(m);
       return bias_between(moments.warp.slope(0), moments.weft.slope(0));
     }},
    {"bending_damping", "bending_damping", &ShellMaterial::bending_damping,
     [](const ShellMaterial& m) { return m.stiffness_damping; }},
};

/// Derives numbers anew whose base has the derived ones, unless keep(number).
template <class Keep>
void derive_anew(const ShellMaterial& base, ShellMaterial& material, const Keep& keep) {
  for (const DerivedNumber& number : derived_numbers)
    if (!keep(number) && base.*number.value == number.derive(base))
      material.*number.value = number.derive(material);
}

/// Derives missing values from given ones.
void complete(const TomlTable& table, ShellMaterial& m) {
  // A modulus takes the place of the base's curve.
  for (const auto& [curve, modulus] :
       {std::pair{"warp_curve", "membrane_warp"}, std::pair{"weft_curve", "membrane_weft"},
        std::pair{"shear_curve", "membrane_shear"}, std::pair{"bending_warp_curve", "bending_warp"},
        std::pair{"bending_weft_curve", "bending_weft"}})
    if (table.has(curve)) schema::forget_variation(m.variations, modulus);
  if (table.has("membrane_warp")) m.warp_curve.reset();
  if (table.has("membrane_weft")) m.weft_curve.reset();
  if (table.has("membrane_shear")) m.shear_curve.reset();
  if (table.has("bending_warp")) m.bending_warp_curve.reset();
  if (table.has("bending_weft")) m.bending_weft_curve.reset();
  if (!table.has("bending_friction_weft") && m.bending_friction_weft == 0)
    m.bending_friction_weft = m.bending_friction_warp;
  if (table.has("base")) return;
  if (!table.has("membrane_weft") && !table.has("weft_curve")) {
    m.membrane_weft = m.membrane_warp;
    schema::copy_variation(m.variations, "membrane_warp", "membrane_weft");
    m.weft_curve = m.warp_curve;
  }
  if (!table.has("poisson")) m.poisson = 0.25;
  if (!table.has("bending_weft") && !table.has("bending_weft_curve")) {
    m.bending_weft = m.bending_warp;
    schema::copy_variation(m.variations, "bending_warp", "bending_weft");
    m.bending_weft_curve = m.bending_warp_curve;
  }
  for (const DerivedNumber& number : derived_numbers)
    if (!table.has(number.key) && !table.has(number.curve)) m.*number.value = number.derive(m);
}

void check_bias(const ShellMaterial& m, const schema::Subject& subject) {
  const SheetMoments moments = moments_of(m);
  const double warp = moments.warp.slope(0), weft = moments.weft.slope(0);
  const double lowest = lowest_bias(warp, weft, m.poisson);
  if (m.bending_bias >= lowest * (1 - 1e-12)) return;
  const bool bias_is_given = subject.table() == nullptr || subject.table()->has("bending_bias");
  throw subject.error(
      bias_is_given ? "bending_bias" : "bending_warp",
      fmt::format(
          "with {:.4g} N·m at 45° between {:.4g} and {:.4g} N·m and a Poisson ratio of {:.4g} the sheet "
          "would twist by itself",
          m.bending_bias, warp, weft, m.poisson),
      "give `bending_bias` at least " + at_least(lowest));
}

void check_curves(const ShellMaterial& m, const schema::Subject& subject) {
  for (const auto& [key, curve] :
       {std::pair{"warp_curve", &m.warp_curve}, std::pair{"weft_curve", &m.weft_curve}}) {
    if (!curve->has_value()) continue;
    if (const auto problem = problem_of_strip(**curve))
      throw subject.error(key, fmt::format("`{}` is unstable: {}", key, *problem),
                          "leave out points where the cloth yields or tears");
  }
  if (!m.warp_curve && !m.weft_curve) return;
  const double highest = highest_poisson(stress_of(m));
  if (m.poisson >= 0 && m.poisson <= highest) return;
  throw subject.error("poisson",
                      fmt::format("curves with a Poisson ratio of {:.4g} make an unstable sheet", m.poisson),
                      "give `poisson` from 0 to " + at_most(std::min(0.99, highest)));
}

void check_yield(const ShellMaterial& m, const schema::Subject& subject) {
  if (!m.yield_curvature) {
    if (m.yield_hardening != 0 || m.yield_recovery)
      throw subject.error(m.yield_recovery ? "yield_recovery" : "yield_hardening",
                          "a sheet without `yield_curvature` does not crease",
                          "add the curvature from which on it creases");
    return;
  }
  if (has_bending_curves(m))
    throw subject.error("yield_curvature", "a sheet with a curve of bending cannot crease",
                        "give `bending_warp` and `bending_weft` in place of the curves");
  if (!(m.bending_warp > 0))
    throw subject.error("yield_curvature", "a sheet whose warp does not resist bending cannot crease",
                        "give `bending_warp` more than 0");
}

void check_strain_yield(const ShellMaterial& m, const schema::Subject& subject) {
  if (!m.yield_strain) {
    if (m.strain_hardening != 0)
      throw subject.error("strain_hardening", "a sheet without `yield_strain` does not yield in stretch",
                          "add the strain from which on it stays longer");
    return;
  }
  if (has_curves(m))
    throw subject.error("yield_strain", "a sheet with measured curves of stretch cannot yield",
                        "give moduli in place of the curves");
  if (!(m.membrane_warp > 0 && m.membrane_weft > 0))
    throw subject.error("yield_strain", "a sheet that yields in stretch needs threads that resist it",
                        "give `membrane_warp` and `membrane_weft` more than 0");
}

/// Lets the numbers change on a resume that decide neither masses nor the memory of internal friction and of
/// creases.
void let_sheet_change(schema::Table& table) {
  for (schema::Key& key : table.keys) {
    if (key.name == "areal_density" || key.name.starts_with("bending_friction") ||
        key.name.starts_with("yield") || key.name == "strain_hardening")
      continue;
    key.may_change_on_resume = true;
  }
}

/// A curve in place of a modulus.
schema::Declaration test_curve(const char* name, std::optional<MeasuredCurve> ShellMaterial::* member,
                               const char* modulus, double widest) {
  return schema::curve(name, member, StressCurve::most_points)
      .range({0, widest, false})
      .excludes(modulus, fmt::format("`{}` stands beside `{}`, in whose place it is", name, modulus));
}

schema::Table declared() {
  using schema::number;
  using Sheet = ShellMaterial;
  schema::Table table = schema::table_of<ShellMaterial>(
      "[shell]",
      {number("areal_density", &ShellMaterial::areal_density)
           .unit("kg/m²")
           .range({0, 1e6, true})
           .varies(&Sheet::variations, unchanging_shell_forms)
           .steady(steady_density)
           .required_without({"base"})
           .means("mass per area"),
       number("membrane_warp", &ShellMaterial::membrane_warp)
           .unit("N/m")
           .range(sheet_modulus)
           .varies(&Sheet::variations, shell_forms)
           .required_without({"base", "warp_curve"})
           .shown_if<Sheet>([](const Sheet& m) { return !m.warp_curve; })
           .means("force per width and strain along warp: Young's modulus × thickness"),
       number("membrane_weft", &ShellMaterial::membrane_weft)
           .unit("N/m")
           .range(sheet_modulus)
           .varies(&Sheet::variations, shell_forms)
           .otherwise("as warp")
           .shown_if<Sheet>([](const Sheet& m) { return !m.weft_curve; })
           .means("force per width and strain along weft"),
       number("membrane_shear", &ShellMaterial::membrane_shear)
           .unit("N/m")
           .range(sheet_modulus)
           .varies(&Sheet::variations, shell_forms)
           .otherwise("as in an isotropic sheet")
           .shown_if<Sheet>([](const Sheet& m) { return !m.shear_curve; })
           .means("force per width and radian"),
       test_curve("warp_curve", &Sheet::warp_curve, "membrane_warp", 10)
           .unit("1, N/m")
           .means(
               "measured, in place of `membrane_warp`: up to 10 points `[[strain, force per width], …]` of "
               "a strip pulled along warp"),
       test_curve("weft_curve", &Sheet::weft_curve, "membrane_weft", 10)
           .unit("1, N/m")
           .otherwise("as warp")
           .means("in place of `membrane_weft`: points of a strip pulled along weft"),
       test_curve("shear_curve", &Sheet::shear_curve, "membrane_shear", 80)
           .unit("°, N/m")
           .means("in place of `membrane_shear`: points `[[angle, force per length], …]` of a shear test"),
       number("poisson", &ShellMaterial::poisson)
           .range({-0.99, 0.99, false})
           .otherwise("0.25")
           .means("Poisson's ratio of stretch and bending: geometric mean of the two directions"),
       number("bending_warp", &ShellMaterial::bending_warp)
           .unit("N·m")
           .range(sheet_modulus)
           .varies(&Sheet::variations, shell_forms)
           .required_without({"base", "bending_warp_curve"})
           .shown_if<Sheet>([](const Sheet& m) { return !m.bending_warp_curve; })
           .means("moment per width and curvature when warp bends"),
       number("bending_weft", &ShellMaterial::bending_weft)
           .unit("N·m")
           .range(sheet_modulus)
           .varies(&Sheet::variations, shell_forms)
           .otherwise("as warp")
           .shown_if<Sheet>([](const Sheet& m) { return !m.bending_weft_curve; })
           .means("moment per width and curvature when weft bends"),
       number("bending_bias", &ShellMaterial::bending_bias)
           .unit("N·m")
           .range(sheet_modulus)
           .varies(&Sheet::variations, shell_forms)
           .otherwise("between the two")
           .means("moment per width and curvature for bending at 45°; at least (warp + weft + 2 ν √(warp "
                  "weft))/4, where the sheet no longer resists twisting"),
       test_curve("bending_warp_curve", &Sheet::bending_warp_curve, "bending_warp", 1e5)
           .unit("1/m, N")
           .means(
               "measured, in place of `bending_warp`: up to 10 points `[[curvature, moment per width], …]`"),
       test_curve("bending_weft_curve", &Sheet::bending_weft_curve, "bending_weft", 1e5)
           .unit("1/m, N")
           .otherwise("as warp")
           .means("in place of `bending_weft`: points `[[curvature, moment per width], …]` when weft bends"),
       number("bending_friction_warp", &ShellMaterial::bending_friction_warp)
           .unit("N")
           .range(sheet_modulus)
           .shown_if<Sheet>(has_bending_friction)
           .means("internal friction: greatest moment per width with which warp resists every change of "
                  "curvature, half of KES-FB2's 2HB; 0 is off"),
       number("bending_friction_weft", &ShellMaterial::bending_friction_weft)
           .unit("N")
           .range(sheet_modulus)
           .otherwise("as warp")
           .shown_if<Sheet>(has_bending_friction)
           .means("internal friction when weft bends"),
       number("bending_friction_curvature", &ShellMaterial::bending_friction_curvature)
           .unit("1/m")
           .range({1e-3, 1e6, false})
           .shown_if<Sheet>(has_bending_friction)
           .means("change of curvature over which internal friction builds up"),
       number("yield_curvature", &ShellMaterial::yield_curvature)
           .unit("1/m")
           .range({1e-3, 1e6, false})
           .otherwise("it never creases")
           .means("curvature of bent warp beyond which the sheet keeps a crease: released, it stays bent by "
                  "what is above it"),
       number("yield_hardening", &ShellMaterial::yield_hardening)
           .range({0, 1, false})
           .shown_if<Sheet>([](const Sheet& m) { return m.yield_curvature.has_value(); })
           .means("stiffness beyond yield over that below"),
       number("yield_recovery", &ShellMaterial::yield_recovery)
           .unit("s")
           .range({0, 1e9, true})
           .otherwise("creases stay")
           .means("time in which creases fade to 37 % of themselves, as under an iron"),
       number("yield_strain", &ShellMaterial::yield_strain)
           .range({1e-4, 10, false})
           .otherwise("it never yields")
           .means("strain of a strip pulled along a thread beyond which the thread stays longer, as a knee "
                  "bags: released, it keeps what is above it; needs `compression = \"elastic\"`"),
       number("strain_hardening", &ShellMaterial::strain_hardening)
           .range({0, 1, false})
           .shown_if<Sheet>([](const Sheet& m) { return m.yield_strain.has_value(); })
           .means("stiffness of stretch beyond yield over that below"),
       number("stretch_limit", &ShellMaterial::stretch_limit)
           .range({least_stretch_limit, 10, false})
           .varies(&Sheet::variations, unchanging_shell_forms)
           .steady("that of the body can")
           .means("largest stretch in any direction, as length over rest length, unless the body has a "
                  "`stretch_limit` of its own"),
       number("mass_damping", &ShellMaterial::mass_damping)
           .unit("1/s")
           .range(sheet_damping)
           .varies(&Sheet::variations, shell_forms)
           .means("Rayleigh's α: slows all motion"),
       number("stiffness_damping", &ShellMaterial::stiffness_damping)
           .unit("s")
           .range(sheet_damping)
           .varies(&Sheet::variations, shell_forms)
           .means("Rayleigh's β of stretch and shear"),
       number("bending_damping", &ShellMaterial::bending_damping)
           .unit("s")
           .range(sheet_damping)
           .varies(&Sheet::variations, shell_forms)
           .otherwise("`stiffness_damping`")
           .means("Rayleigh's β of bending")});
  table.complete = [](const TomlTable& given, void* settings) {
    complete(given, *static_cast<ShellMaterial*>(settings));
  };
  schema::add_rule<ShellMaterial>(table, check_curves);
  schema::add_rule<ShellMaterial>(table, check_bias);
  schema::add_rule<ShellMaterial>(table, check_yield);
  schema::add_rule<ShellMaterial>(table, check_strain_yield);
  schema::add_rule<ShellMaterial>(table, [](const ShellMaterial& m, const schema::Subject& subject) {
    for (const double time : times_to_check(m.variations)) check_bias(material_at(m, time), subject);
  });
  let_sheet_change(table);
  return table;
}

}  // namespace

void derive_anew(const TomlTable& given, const ShellMaterial& base, ShellMaterial& material) {
  derive_anew(base, material,
              [&](const DerivedNumber& number) { return given.has(number.key) || given.has(number.curve); });
}

ShellMaterial with_numbers(const ShellMaterial& material, std::span<const double> values) {
  ShellMaterial result = material;
  result.variations.clear();
  for (std::size_t i = 0; i < values.size(); ++i)
    shell_material_table().set_number(material.variations[i].key, values[i], result);
  derive_anew(material, result, [&](const DerivedNumber& number) {
    return schema::find_variation(material.variations, number.key) != nullptr;
  });
  return result;
}

const schema::Table& shell_material_table() {
  static const schema::Table table = declared();
  return table;
}

}  // namespace muslin
