// muslin materials [NAME]
#include <memory>

#include "command.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "muslin/hosts.hpp"

namespace muslin::app {
namespace {

std::string table() {
  std::string text = fmt::format("{:<14} {:>9} {:>11} {:>11} {:>11}  {}\n", "name", "density", "edge",
                                 "face diag.", "body diag.", "what it is");
  text += fmt::format("{:<14} {:>9} {:>11} {:>11} {:>11}\n", "", "kg/m3", "N/m2", "N/m2", "N/m2");
  for (const std::string& name : material_names()) {
    const Material m = find_material(name);
    text += fmt::format("{:<14} {:>9.4g} {:>11.4g} {:>11.4g} {:>11.4g}  {}\n", name, m.density,
                        m.edge_modulus, m.face_diagonal_modulus, m.body_diagonal_modulus, m.description);
  }
  return text;
}

std::string page(const Material& m) {
  std::string text = fmt::format("{}: {}\n\n", m.name, m.description);
  const auto row = [&](const char* what, double value, const char* unit) {
    text += fmt::format("  {:<24} {:>12.6g} {}\n", what, value, unit);
  };
  if (m.has_lattice) {
    text += "lattice:\n";
    row("density", m.density, "kg/m3");
    row("edge_modulus", m.edge_modulus, "N/m2");
    row("face_diagonal_modulus", m.face_diagonal_modulus, "N/m2");
    row("body_diagonal_modulus", m.body_diagonal_modulus, "N/m2");
    row("volume_modulus", m.volume_modulus, "N/m2");
    if (m.young_modulus > 0) {
      row("young_modulus", m.young_modulus, "Pa");
      row("poisson", m.poisson, "");
    }
    row("mass_damping", m.mass_damping, "1/s");
    row("stiffness_damping", m.stiffness_damping, "s");
  }
  if (m.shell) {
    text += "\nshell:\n";
    row("areal_density", m.shell->areal_density, "kg/m2");
    row("membrane_warp", m.shell->membrane_warp, "N/m");
    row("membrane_weft", m.shell->membrane_weft, "N/m");
    row("membrane_shear", m.shell->membrane_shear, "N/m");
    row("poisson", m.shell->poisson, "");
    row("bending_warp", m.shell->bending_warp, "N m");
    row("bending_weft", m.shell->bending_weft, "N m");
    row("bending_bias", m.shell->bending_bias, "N m");
    row("mass_damping", m.shell->mass_damping, "1/s");
    row("stiffness_damping", m.shell->stiffness_damping, "s");
    row("bending_damping", m.shell->bending_damping, "s");
  }
  if (!m.reference.empty()) text += "\nreference (SI):\n";
  for (const auto& [what, value] : m.reference) text += fmt::format("  {:<24} {:>12.6g}\n", what, value);
  return text + "\nsource: " + m.source + "\n";
}

using Json = nlohmann::ordered_json;

Json numbers(const Material& m) {
  Json json = {{"name", m.name}, {"description", m.description}, {"source", m.source}};
  if (m.has_lattice) {
    json["lattice"] = {{"density", m.density},
                       {"edge_modulus", m.edge_modulus},
                       {"face_diagonal_modulus", m.face_diagonal_modulus},
                       {"body_diagonal_modulus", m.body_diagonal_modulus},
                       {"volume_modulus", m.volume_modulus},
                       {"mass_damping", m.mass_damping},
                       {"stiffness_damping", m.stiffness_damping}};
    if (m.young_modulus > 0) {
      json["lattice"]["young_modulus"] = m.young_modulus;
      json["lattice"]["poisson"] = m.poisson;
    }
  }
  if (m.shell) {
    json["shell"] = {{"areal_density", m.shell->areal_density},
                     {"membrane_warp", m.shell->membrane_warp},
                     {"membrane_weft", m.shell->membrane_weft},
                     {"membrane_shear", m.shell->membrane_shear},
                     {"poisson", m.shell->poisson},
                     {"bending_warp", m.shell->bending_warp},
                     {"bending_weft", m.shell->bending_weft},
                     {"bending_bias", m.shell->bending_bias},
                     {"mass_damping", m.shell->mass_damping},
                     {"stiffness_damping", m.shell->stiffness_damping},
                     {"bending_damping", m.shell->bending_damping}};
  }
  json["reference"] = Json::object();
  for (const auto& [what, value] : m.reference) json["reference"][what] = value;
  return json;
}

std::string json_of(const std::string& name) {
  if (!name.empty()) return numbers(find_material(name)).dump(2) + "\n";
  Json all = Json::array();
  for (const std::string& each : material_names()) all.push_back(numbers(find_material(each)));
  return all.dump(2) + "\n";
}

}  // namespace

void add_materials(CLI::App& program) {
  auto* command = program.add_subcommand("materials", "list the materials, or show one with its sources");
  auto name = std::make_shared<std::string>();
  command->add_option("NAME", *name, "material");
  auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "for programs: a list of all, or the one");
  command->callback([name, json] {
    if (*json) {
      print(json_of(*name));
    } else {
      print(name->empty() ? table() : page(find_material(*name)));
    }
  });
}

}  // namespace muslin::app
