#include "muslin/scene/body_material.hpp"

#include <optional>

#include "muslin/core/nearest_name.hpp"
#include "muslin/material/lattice_moduli.hpp"
#include "muslin/material/material_table.hpp"
#include "muslin/scene/names.hpp"

namespace muslin {
namespace {

using schema::Key;
using schema::Type;

/// `material` of a lattice as a table.
struct LatticeInput {
  std::string base;
  std::optional<double> shear_modulus;
  Material material;
};

/// `material` of a shell as a table.
struct ShellInput {
  std::string base;
  ShellMaterial shell;
};

const schema::Table& lattice_input_table() {
  static const schema::Table table = [] {
    schema::Table input = schema::table_of<LatticeInput>(
        "`material` of a lattice",
        {schema::text("base", &LatticeInput::base)
             .means("a material by name or path; the other keys change it"),
         schema::number("shear_modulus", &LatticeInput::shear_modulus)
             .unit("N/m²")
             .range(Range::non_negative())
             .otherwise("0.4 × `youngs_modulus`")
             .needs("youngs_modulus", "give both")
             .excludes("law", "a solid has no shear modulus of its own", "give `poisson`")
             .means("of springs, only with `youngs_modulus`")});
    schema::include(input, &LatticeInput::material, lattice_material_table());
    return input;
  }();
  return table;
}

const schema::Table& shell_input_table() {
  static const schema::Table table = [] {
    schema::Table input = schema::table_of<ShellInput>(
        "`material` of a shell",
        {schema::text("base", &ShellInput::base)
             .means("a material by name or path that has `[shell]` numbers; the other keys "
                    "change it")});
    schema::include(input, &ShellInput::shell, shell_material_table());
    return input;
  }();
  return table;
}

/// A name of the library or the path of a material file.
Material named_material(const std::string& name, const Place& place, const std::filesystem::path& folder) {
  try {
    return name.ends_with(".toml") ? read_material(folder / name) : find_material(name);
  } catch (const Error& error) {
    if (!error.place().file.empty() && error.kind() == ErrorKind::input) throw;  // inside the material file
    const std::string file = error.place().file.empty() ? "" : error.place().file + ": ";
    throw Error(error.kind(), place, file + error.problem(), error.remedy());
  }
}

bool has_numbers(const Material& material, BodyModel model) {
  return model == BodyModel::shell ? material.shell.has_value() : material.has_lattice;
}

Material named_material_for(BodyModel model, const std::string& name, const Place& place,
                            const std::filesystem::path& folder) {
  Material material = named_material(name, place, folder);
  if (has_numbers(material, model)) return material;
  std::vector<std::string> fit;
  for (const std::string& other : material_names())
    if (has_numbers(find_material(other), model)) fit.push_back(other);
  throw Error(ErrorKind::input, place,
              fmt::format("the material `{}` has no numbers for a {}", material.name,
                          name_of(body_model_names(), model)),
              "take one of " + name_list(fit) + ", or an inline table");
}

/// Sets the three moduli by Young's modulus and an optional shear modulus.
void set_moduli(const TomlTable& table, const LatticeInput& input, Bracing bracing, Material& material) {
  const double youngs = *material.youngs_modulus;
  const double greatest = greatest_shear_ratio(bracing) * youngs;
  if (input.shear_modulus && *input.shear_modulus >= greatest) {
    throw table.error(
        "shear_modulus",
        fmt::format("springs reach a shear modulus of less than {:.4g} N/m² at this Young's modulus",
                    greatest),
        "lower `shear_modulus` or leave it out");
  }
  const SpringModuli moduli = springs_for(youngs, input.shear_modulus, bracing);
  material.edge_modulus = moduli.edge;
  material.face_diagonal_modulus = moduli.face_diagonal;
  material.body_diagonal_modulus = moduli.body_diagonal;
  material.youngs_modulus.reset();
}

/// A solid takes the place of the springs of `base`.
void drop_springs(Material& material) {
  for (double* modulus : {&material.edge_modulus, &material.face_diagonal_modulus,
                          &material.body_diagonal_modulus, &material.volume_modulus})
    *modulus = 0;
}

// A table is read over the numbers of its base, if it has one.

Material read_lattice(const TomlValue& value, const std::string& title, const std::filesystem::path& folder,
                      Bracing bracing) {
  const TomlTable table = lattice_input_table().open(value, title);
  LatticeInput input;
  input.material.name = "inline";
  if (table.has("base")) {
    input.material =
        named_material_for(BodyModel::lattice, table.string("base"), table.place("base"), folder);
  }
  if (table.has("law")) drop_springs(input.material);
  lattice_input_table().read(table, input);
  if (input.material.youngs_modulus && input.material.law == LatticeLaw::springs)
    set_moduli(table, input, bracing, input.material);
  return input.material;
}

Material read_shell(const TomlValue& value, const std::string& title, const std::filesystem::path& folder) {
  const TomlTable table = shell_input_table().open(value, title);
  Material material;
  material.name = "inline";
  material.has_lattice = false;
  ShellInput input;
  if (table.has("base")) {
    material = named_material_for(BodyModel::shell, table.string("base"), table.place("base"), folder);
    input.shell = *material.shell;
  }
  shell_input_table().read(table, input);
  material.shell = input.shell;
  return material;
}

/// The resolved scene has the name of the material first.
TomlValue with_name(const std::string& name, TomlValue numbers) {
  TomlValue result;
  schema::append(result, "name", schema::words(name));
  for (std::size_t i = 0; i < numbers.keys.size(); ++i)
    schema::append(result, numbers.keys[i], std::move(numbers.items[i]));
  return result;
}

const char* quantities(BodyModel model) {
  return model == BodyModel::shell ? "areal_density, membrane_warp, bending_warp" : "density, edge_modulus";
}

template <class Write, class Check>
schema::Declaration material_key(BodyModel model, const schema::Table& (*keys)(), Write write, Check check) {
  Key key = schema::custom<BodySettings>(
      "material", {Type::text, Type::table}, [](const Key&, const TomlTable&, BodySettings&) {}, write);
  key.table = keys;
  key.check = [check](const Key& k, const void* s, const schema::Subject& subject) {
    check(k, *static_cast<const BodySettings*>(s), subject);
  };
  return schema::Declaration(std::move(key))
      .required(fmt::format("name one (`muslin materials` lists them) or give a table with {}, …",
                            quantities(model)))
      .means("a name (`muslin materials` lists them), the path of a material file (`.toml`), or a table");
}

}  // namespace

schema::Declaration lattice_material_key() {
  return material_key(
      BodyModel::lattice, lattice_input_table,
      [](const Key& key, const BodySettings& body, TomlValue& out) {
        const Material& material = body.material;
        schema::append(out, key.name, with_name(material.name, lattice_material_table().write(material)));
      },
      [](const Key& key, const BodySettings& body, const schema::Subject& subject) {
        if (!body.material.has_lattice)
          throw subject.error(key.name, "its material has no numbers for lattices",
                              "set them, or choose the shell");
        lattice_material_table().check(body.material, subject);
      });
}

schema::Declaration shell_material_key() {
  return material_key(
      BodyModel::shell, shell_input_table,
      [](const Key& key, const BodySettings& body, TomlValue& out) {
        const Material& material = body.material;
        if (material.shell)
          schema::append(out, key.name,
                         with_name(material.name, shell_material_table().write(*material.shell)));
      },
      [](const Key& key, const BodySettings& body, const schema::Subject& subject) {
        if (!body.material.shell)
          throw subject.error(key.name, "its material has no numbers for shells",
                              "set `material.shell`, or choose the lattice");
        shell_material_table().check(*body.material.shell, subject);
      });
}

void read_body_material(const TomlTable& table, const std::filesystem::path& folder, BodySettings& body) {
  const TomlValue& value = *table.find("material");
  if (value.type == TomlValue::Type::string) {
    body.material = named_material_for(body.model, value.string, value.place, folder);
    return;
  }
  if (value.type != TomlValue::Type::table) {
    throw table.error(
        "material", fmt::format("`material` of {} is neither a name nor a table", table.title()),
        fmt::format("write material = \"cotton\" or a table {{ … }} with {}", quantities(body.model)));
  }
  const std::string title = fmt::format("`material` of {}", table.title());
  body.material = body.model == BodyModel::shell ? read_shell(value, title, folder)
                                                 : read_lattice(value, title, folder, body.bracing);
}

}  // namespace muslin
