#include "muslin/material/material.hpp"

#include "muslin/core/nearest_name.hpp"
#include "muslin/core/toml_table.hpp"
#include "muslin/material/library.hpp"
#include "muslin/material/material_table.hpp"

namespace muslin {
namespace {

std::vector<MaterialNumber> numbers_in(const schema::Table& table, const TomlValue& written) {
  std::vector<MaterialNumber> numbers;
  for (std::size_t i = 0; i < written.keys.size(); ++i)
    if (written.items[i].type != TomlValue::Type::string)
      numbers.push_back({written.keys[i], written.items[i].real, table.find(written.keys[i])->unit});
  return numbers;
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
  const TomlTable top(root, "the material file",
                      {"name", "description", "source", "lattice", "shell", "reference"});
  Material material;
  material.name = top.string("name", std::filesystem::path(file).stem().string());
  material.description = top.string("description", "");
  material.source = top.string("source", "");
  const TomlValue* shell = top.find("shell");
  const TomlValue* lattice = top.find("lattice");
  if (shell != nullptr) {
    const schema::Table& keys = shell_material_table();
    keys.read(keys.open(*shell, "`shell` of the material file"), material.shell.emplace());
  }
  material.has_lattice = lattice != nullptr;
  if (!material.has_lattice && !material.shell) {
    throw Error(
        ErrorKind::input, Place{file, 0, 0}, "the material file has no table [lattice] or [shell]",
        "add [lattice] with density, edge_modulus, … or [shell] with areal_density, membrane_warp, …");
  }
  if (lattice != nullptr) {
    const schema::Table& keys = lattice_material_table();
    const TomlTable table = keys.open(*lattice, "`lattice` of the material file");
    keys.read(table, material);
    if (material.youngs_modulus && material.law == LatticeLaw::springs)
      throw table.error("youngs_modulus", "a material file defines springs by their three moduli",
                        "give these, or law = \"neo_hookean\"");
  }
  if (const TomlValue* reference = top.find("reference")) {
    if (reference->type != TomlValue::Type::table) {
      throw top.error("reference", "`reference` is not a table", "write [reference]");
    }
    for (std::size_t i = 0; i < reference->items.size(); ++i) {
      const TomlValue& value = reference->items[i];
      if (value.type == TomlValue::Type::string) continue;  // a remark
      material.reference.emplace_back(reference->keys[i],
                                      to_number(value, "`" + reference->keys[i] + "` of [reference]", ""));
    }
  }
  return material;
}

std::vector<MaterialNumber> lattice_numbers(const Material& material) {
  if (!material.has_lattice) return {};
  return numbers_in(lattice_material_table(), lattice_material_table().write(material));
}

std::vector<MaterialNumber> shell_numbers(const Material& material) {
  if (!material.shell) return {};
  return numbers_in(shell_material_table(), shell_material_table().write(*material.shell));
}

}  // namespace muslin
