#include "muslin/material/material.hpp"

#include <algorithm>
#include <utility>

#include "muslin/core/nearest_name.hpp"
#include "muslin/core/toml_table.hpp"
#include "muslin/material/library.hpp"
#include "muslin/material/material_table.hpp"
#include "muslin/schema/declare.hpp"

namespace muslin {
namespace {

bool is_guess(const Material& material, const std::string& table, const std::string& key) {
  return std::find(material.guesses.begin(), material.guesses.end(), table + "." + key) !=
         material.guesses.end();
}

std::vector<MaterialNumber> numbers_in(const Material& material, const std::string& name,
                                       const schema::Table& table, const TomlValue& written) {
  std::vector<MaterialNumber> numbers;
  for (std::size_t i = 0; i < written.keys.size(); ++i) {
    const std::string& key = written.keys[i];
    if (written.items[i].type == TomlValue::Type::real)
      numbers.push_back({key, written.items[i].real, table.find(key)->unit, is_guess(material, name, key)});
  }
  return numbers;
}

/// Reads the names of numbers that are not measured.
void read_guesses(const schema::Key& key, const TomlTable& file, Material& material) {
  for (const TomlValue& item : *file.array(key.name, "keys such as [\"shell.poisson\"]")) {
    if (item.type != TomlValue::Type::string)
      throw file.error(key.name, "`guesses` has an item that is not a text",
                       "give keys such as \"shell.poisson\"");
    material.guesses.push_back(item.string);
  }
}

void read_lattice(const schema::Key& key, const TomlTable& file, Material& material) {
  const schema::Table& keys = lattice_material_table();
  const TomlTable table = keys.open(*file.find(key.name), fmt::format("`{}` of {}", key.name, file.title()));
  material.has_lattice = true;
  keys.read(table, material);
  if (material.youngs_modulus && material.has_springs())
    throw table.error("youngs_modulus", "a material file has springs by their three moduli",
                      "give these, or law = \"neo_hookean\"");
}

void read_reference(const schema::Key& key, const TomlTable& file, Material& material) {
  const TomlValue& reference = *file.find(key.name);
  if (reference.type != TomlValue::Type::table)
    throw file.error(key.name, "`reference` is not a table", "write [reference]");
  for (std::size_t i = 0; i < reference.items.size(); ++i) {
    const TomlValue& value = reference.items[i];
    if (value.type == TomlValue::Type::string) continue;  // a remark
    material.reference.emplace_back(reference.keys[i],
                                    to_number(value, "`" + reference.keys[i] + "` of [reference]", ""));
  }
}

/// Guesses name numbers of this material, given or derived.
void check_guesses(const TomlTable& file, const Material& material) {
  std::vector<std::string> known;
  for (const MaterialNumber& number : lattice_numbers(material)) known.push_back("lattice." + number.key);
  for (const MaterialNumber& number : shell_numbers(material)) known.push_back("shell." + number.key);
  for (const MaterialCurve& curve : shell_curves(material)) known.push_back("shell." + curve.key);
  for (const std::string& guess : material.guesses)
    if (std::find(known.begin(), known.end(), guess) == known.end())
      throw file.error("guesses", fmt::format("`{}` in `guesses` is not a number of this material", guess),
                       name_advice(guess, known));
}

/// A material file. The library writes none.
const schema::Table& file_table() {
  const auto unwritten = [](const schema::Key&, const Material&, TomlValue&) {};
  static const schema::Table table = schema::table_of<Material>(
      "material file",
      {schema::text("name", &Material::name).otherwise("the file's name").means("name in messages"),
       schema::text("description", &Material::description).means("what it is, in a sentence"),
       schema::text("source", &Material::source).means("where its numbers come from"),
       schema::custom<Material>("guesses", {schema::Type::text}, read_guesses, unwritten)
           .means("numbers that are not measured, such as `shell.bending_warp`"),
       schema::custom<Material>("lattice", {schema::Type::table}, read_lattice, unwritten)
           .means("its numbers as a lattice"),
       schema::nested("shell", &Material::shell, shell_material_table).means("its numbers as a shell"),
       schema::custom<Material>("reference", {schema::Type::table}, read_reference, unwritten)
           .means("measured numbers of the real material, for information")});
  return table;
}

}  // namespace

std::vector<std::string> material_names() {
  std::vector<std::string> names;
  for (const LibraryMaterial& material : material_library()) names.emplace_back(material.name);
  return names;
}

Material find_material(const std::string& name) {
  for (const LibraryMaterial& material : material_library()) {
    if (material.name == name) {
      return parse_material(material.text, "materials/" + name + ".toml");
    }
  }
  throw Error(ErrorKind::input, "there is no material `" + name + "`",
              name_advice(name, material_names()) + " (`muslin materials` lists them all)");
}

Material read_material(const std::filesystem::path& file) {
  return parse_material(read_text(file), file.string());
}

Material parse_material(std::string_view text, const std::string& file) {
  const TomlValue root = parse_toml(text, file);
  const TomlTable top = file_table().open(root, "the material file");
  Material material;
  material.name = std::filesystem::path(file).stem().string();
  material.has_lattice = false;
  file_table().read(top, material);
  if (!material.has_lattice && !material.shell) {
    throw Error(
        ErrorKind::input, Place{file, 0, 0}, "the material file has no table [lattice] or [shell]",
        "add [lattice] with density, edge_modulus, … or [shell] with areal_density, membrane_warp, …");
  }
  check_guesses(top, material);
  return material;
}

std::vector<MaterialNumber> lattice_numbers(const Material& material) {
  if (!material.has_lattice) return {};
  return numbers_in(material, "lattice", lattice_material_table(), lattice_material_table().write(material));
}

std::vector<MaterialNumber> shell_numbers(const Material& material) {
  if (!material.shell) return {};
  return numbers_in(material, "shell", shell_material_table(), shell_material_table().write(*material.shell));
}

std::vector<MaterialCurve> shell_curves(const Material& material) {
  std::vector<MaterialCurve> curves;
  if (!material.shell) return curves;
  const ShellMaterial& m = *material.shell;
  for (const auto& [key, curve] :
       {std::pair{"warp_curve", &m.warp_curve}, std::pair{"weft_curve", &m.weft_curve},
        std::pair{"shear_curve", &m.shear_curve}, std::pair{"bending_warp_curve", &m.bending_warp_curve},
        std::pair{"bending_weft_curve", &m.bending_weft_curve}})
    if (*curve)
      curves.push_back(
          {key, **curve, shell_material_table().find(key)->unit, is_guess(material, "shell", key)});
  return curves;
}

}  // namespace muslin
