#include "muslin/material/material_table.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>

#include "muslin/energy/solid_laws.hpp"
#include "muslin/material/varied_material.hpp"
#include "muslin/schema/declare.hpp"

namespace muslin {
namespace {

using schema::Declaration;

// Upper bounds far above any material: they keep products of the quantities finite.
constexpr Range modulus{0, 1e15, false};
constexpr Range damping{0, 1e6, false};
constexpr schema::VaryingForms lattice_forms{.map = true, .keyframes = true};
constexpr schema::VaryingForms unchanging_forms{.map = true, .keyframes = false};

/// A modulus of springs, in whose place a scene may give Young's modulus.
Declaration spring_modulus(const char* name, double Material::* member, const char* meaning) {
  return schema::number(name, member)
      .unit("N/m²")
      .range(modulus)
      .varies(&Material::variations, lattice_forms)
      .means(meaning)
      .excludes("youngs_modulus", fmt::format("`{}` stands beside `youngs_modulus`, which decides it", name));
}

bool is_solid(const Material& material) { return !material.has_springs(); }

/// The key `law`: springs, or one of the solids.
Declaration law_key() {
  std::vector<std::string> words = {"springs"};
  std::string meaning;
  for (const SolidLaw& law : solid_laws()) {
    words.emplace_back(law.name);
    meaning += fmt::format("{}`{}`: {}", meaning.empty() ? "" : " · ", law.name, law.meaning);
  }
  return schema::word("law", &Material::law, words)
      .needs("youngs_modulus", "give the modulus of the solid")
      .shown_if<Material>(is_solid)
      .means(meaning);
}

void check_spring_yield(const Material& m, const schema::Subject& subject) {
  if (!m.yield_strain && m.strain_hardening != 0)
    throw subject.error("strain_hardening", "springs without `yield_strain` do not yield",
                        "add the strain from which on they keep another length");
  if (m.yield_strain && !m.has_springs())
    throw subject.error("yield_strain", "a solid does not yield", "take law = \"springs\"");
}

/// Lets the numbers change on a resume that decide neither masses nor the memory of dents.
schema::Table let_change(schema::Table table) {
  for (schema::Key& key : table.keys) {
    if (key.name == "density" || key.name == "law" || key.name == "yield_strain" ||
        key.name == "strain_hardening")
      continue;
    key.may_change_on_resume = true;
  }
  return table;
}

schema::Table with_rules(schema::Table table) {
  schema::add_rule<Material>(table, check_spring_yield);
  return table;
}

}  // namespace

const schema::Table& lattice_material_table() {
  static const schema::Table table = let_change(with_rules(schema::table_of<Material>(
      "[lattice]",
      {schema::number("density", &Material::density)
           .unit("kg/m³")
           .range({0, 1e6, true})
           .varies(&Material::variations, unchanging_forms)
           .steady(steady_density)
           .required_without({"base"})
           .means("mass per volume"),
       spring_modulus("edge_modulus", &Material::edge_modulus,
                      "modulus of springs along voxel edges; a spring's constant is modulus × voxel width")
           .required_without({"base", "youngs_modulus", "law"}),
       spring_modulus("face_diagonal_modulus", &Material::face_diagonal_modulus,
                      "modulus of springs along face diagonals"),
       spring_modulus("body_diagonal_modulus", &Material::body_diagonal_modulus,
                      "modulus of springs along body diagonals"),
       schema::number("volume_modulus", &Material::volume_modulus)
           .unit("N/m²")
           .range(modulus)
           .varies(&Material::variations, lattice_forms)
           .means("resistance of each voxel to a change of volume; 0 is off"),
       schema::number("yield_strain", &Material::yield_strain)
           .range({1e-4, 10, false})
           .otherwise("it never dents")
           .means(
               "of springs: strain, in stretch or compression, beyond which a spring keeps another length: "
               "released, it keeps what is above it"),
       schema::number("strain_hardening", &Material::strain_hardening)
           .range({0, 1, false})
           .shown_if<Material>([](const Material& m) { return m.yield_strain.has_value(); })
           .means("stiffness beyond yield over that below"),
       schema::number("mass_damping", &Material::mass_damping)
           .unit("1/s")
           .range(damping)
           .varies(&Material::variations, lattice_forms)
           .means("Rayleigh's α: slows all motion, like a viscous fluid"),
       schema::number("stiffness_damping", &Material::stiffness_damping)
           .unit("s")
           .range(damping)
           .varies(&Material::variations, lattice_forms)
           .means("Rayleigh's β: damps stretching only"),
       law_key(),
       schema::number("youngs_modulus", &Material::youngs_modulus)
           .unit("N/m²")
           .range({0, 1e15, true})
           .varies(&Material::variations, unchanging_forms)
           .shown_if<Material>(is_solid)
           .means(
               "Young's modulus of the solid; with springs, of a large block along its axes, in place of the "
               "three moduli"),
       schema::number("poisson", &Material::poisson)
           .range({-0.99, 0.499, false})
           .needs("law", "springs have a Poisson's ratio of their own; add law = \"neo_hookean\"")
           .shown_if<Material>(is_solid)
           .means("Poisson's ratio of the solid")})));
  return table;
}

Material with_numbers(const Material& material, std::span<const double> values) {
  Material result = material;
  result.variations.clear();
  for (std::size_t i = 0; i < values.size(); ++i)
    lattice_material_table().set_number(material.variations[i].key, values[i], result);
  return result;
}

}  // namespace muslin
