// muslin materials [NAME]
#include <algorithm>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "command.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "muslin/hosts.hpp"
#include "muslin/material/measured_sheet.hpp"

namespace muslin::app {
namespace {

/// How many numbers of a material are guesses.
std::string guesses(const std::vector<MaterialNumber>& numbers, const std::vector<MaterialCurve>& curves) {
  const auto is_guess = [](const auto& number) { return number.guess; };
  return fmt::format("{} of {}",
                     std::count_if(numbers.begin(), numbers.end(), is_guess) +
                         std::count_if(curves.begin(), curves.end(), is_guess),
                     numbers.size() + curves.size());
}

std::string lattice_table() {
  std::string text = fmt::format("{:<18} {:>9} {:>11} {:>11} {:>11} {:>9}  {}\n", "lattices", "density",
                                 "edge", "face diag.", "body diag.", "guesses", "description");
  text += fmt::format("{:<18} {:>9} {:>11} {:>11} {:>11}\n", "", "kg/m3", "N/m2", "N/m2", "N/m2");
  for (const std::string& name : material_names()) {
    const Material m = find_material(name);
    if (!m.has_lattice) continue;
    text += fmt::format("{:<18} {:>9.4g} {:>11.4g} {:>11.4g} {:>11.4g} {:>9}  {}\n", name, m.density,
                        m.edge_modulus, m.face_diagonal_modulus, m.body_diagonal_modulus,
                        guesses(lattice_numbers(m), {}), m.description);
  }
  return text;
}

/// For curves it shows the stiffness at rest.
std::string shell_table() {
  std::string text =
      fmt::format("{:<18} {:>9} {:>8} {:>8} {:>8} {:>9} {:>9} {:>9}  {}\n", "shells", "density", "warp",
                  "weft", "shear", "bend warp", "bend weft", "guesses", "description");
  text += fmt::format("{:<18} {:>9} {:>8} {:>8} {:>8} {:>9} {:>9}\n", "", "kg/m2", "N/m", "N/m", "N/m", "N m",
                      "N m");
  for (const std::string& name : material_names()) {
    const Material m = find_material(name);
    if (!m.shell) continue;
    const SheetStress stress = stress_of(*m.shell);
    const SheetMoments moments = moments_of(*m.shell);
    text += fmt::format("{:<18} {:>9.4g} {:>8.4g} {:>8.4g} {:>8.4g} {:>9.2g} {:>9.2g} {:>9}  {}\n", name,
                        m.shell->areal_density, stress.warp.slope(0), stress.weft.slope(0),
                        stress.shear.slope(0), moments.warp.slope(0), moments.weft.slope(0),
                        guesses(shell_numbers(m), shell_curves(m)), m.description);
  }
  return text;
}

/// Superscripts and dots as terminals without Unicode show them.
std::string plain(std::string unit) {
  for (const auto& [from, to] : {std::pair{"²", "2"}, {"³", "3"}, {"·", " "}, {"°", "degrees"}})
    for (std::size_t at = unit.find(from); at != std::string::npos; at = unit.find(from))
      unit.replace(at, std::string_view(from).size(), to);
  return unit;
}

std::string page(const Material& m) {
  std::string text = fmt::format("{}: {}\n\n", m.name, m.description);
  const auto rows = [&](const char* title, const std::vector<MaterialNumber>& numbers) {
    if (!numbers.empty()) text += title;
    for (const MaterialNumber& number : numbers)
      text += fmt::format("  {:<24} {:>12.6g} {}{}\n", number.key, number.value, plain(number.unit),
                          number.guess ? " (guess)" : "");
  };
  rows("lattice:\n", lattice_numbers(m));
  rows("\nshell:\n", shell_numbers(m));
  for (const MaterialCurve& curve : shell_curves(m)) {
    text += fmt::format("  {:<24}", curve.key);
    for (const Vec2& point : curve.points) text += fmt::format(" ({:.6g}, {:.6g})", point[0], point[1]);
    text += fmt::format(" {}{}\n", plain(curve.unit), curve.guess ? " (guess)" : "");
  }
  if (!m.reference.empty()) text += "\nreference (SI):\n";
  for (const auto& [what, value] : m.reference) text += fmt::format("  {:<24} {:>12.6g}\n", what, value);
  return text + "\nsource: " + m.source + "\n";
}

using Json = nlohmann::ordered_json;

Json numbers(const Material& m) {
  Json json = {
      {"name", m.name}, {"description", m.description}, {"source", m.source}, {"guesses", m.guesses}};
  for (const MaterialNumber& number : lattice_numbers(m)) json["lattice"][number.key] = number.value;
  for (const MaterialNumber& number : shell_numbers(m)) json["shell"][number.key] = number.value;
  for (const MaterialCurve& curve : shell_curves(m))
    for (const Vec2& point : curve.points) json["shell"][curve.key].push_back({point[0], point[1]});
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
  command->add_flag("--json", *json, "print JSON: a list of all, or the one named");
  command->callback([name, json] {
    if (*json) {
      print(json_of(*name));
    } else {
      print(name->empty() ? lattice_table() + "\n" + shell_table() : page(find_material(*name)));
    }
  });
}

}  // namespace muslin::app
