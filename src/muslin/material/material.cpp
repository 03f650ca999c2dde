#include "muslin/material/material.hpp"

#include "muslin/core/nearest_name.hpp"
#include "muslin/core/toml_table.hpp"
#include "muslin/material/library.hpp"
#include "muslin/material/material_table.hpp"

namespace muslin {

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
  const auto lattice = top.table("lattice", material_keys());
  if (const auto shell = top.table("shell", shell_material_keys()))
    material.shell = read_shell_material(*shell);
  material.has_lattice = lattice.has_value();
  if (!lattice && !material.shell) {
    throw Error(
        ErrorKind::input, Place{file, 0, 0}, "the material file has no table [lattice] or [shell]",
        "add [lattice] with density, edge_modulus, … or [shell] with areal_density, membrane_warp, …");
  }
  if (lattice) {
    lattice->number("density", "kg/m³", Range::positive());
    if (!lattice->has("young_modulus")) lattice->number("edge_modulus", "N/m²", Range::non_negative());
    read_material_keys(*lattice, material);
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

}  // namespace muslin
