#include "muslin/scene/read_body.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "muslin/core/nearest_name.hpp"
#include "muslin/core/toml_table.hpp"
#include "muslin/geometry/inspect.hpp"
#include "muslin/material/lattice_moduli.hpp"
#include "muslin/material/material_table.hpp"
#include "muslin/scene/names.hpp"
#include "muslin/scene/read_parts.hpp"
#include "muslin/scene/vocabulary.hpp"

namespace muslin {
namespace {

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

/// Reads the three moduli from Young's modulus and an optional shear modulus.
void read_elastic_moduli(const TomlTable& table, Bracing bracing, Material& material) {
  for (const char* key : {"edge_modulus", "face_diagonal_modulus", "body_diagonal_modulus"}) {
    if (!table.has(key)) continue;
    throw table.error(key, fmt::format("`{}` stands beside `youngs_modulus`, which decides it", key),
                      "keep one of them");
  }
  const double youngs = table.number("youngs_modulus", "N/m²", {0, 1e15, true});
  std::optional<double> shear;
  if (table.has("shear_modulus")) {
    const double greatest = greatest_shear_ratio(bracing) * youngs;
    shear = table.number("shear_modulus", "N/m²", Range::non_negative());
    if (*shear >= greatest) {
      throw table.error("shear_modulus",
                        fmt::format("springs reach a shear modulus of less than {:.4g} N/m² at this Young's "
                                    "modulus",
                                    greatest),
                        "lower `shear_modulus` or leave it out");
    }
  }
  const SpringModuli moduli = springs_for(youngs, shear, bracing);
  material.edge_modulus = moduli.edge;
  material.face_diagonal_modulus = moduli.face_diagonal;
  material.body_diagonal_modulus = moduli.body_diagonal;
}

/// Returns the library's materials that have numbers for the model.
std::vector<std::string> materials_for(BodyModel model) {
  std::vector<std::string> names;
  for (const std::string& name : material_names()) {
    const Material material = find_material(name);
    if (model == BodyModel::shell ? material.shell.has_value() : material.has_lattice) names.push_back(name);
  }
  return names;
}

void require_numbers(const Material& material, BodyModel model, const Place& place) {
  if (model == BodyModel::shell ? material.shell.has_value() : material.has_lattice) return;
  const std::string& word = name_of(body_model_names(), model);
  throw Error(ErrorKind::input, place,
              fmt::format("the material `{}` has no numbers for a {}", material.name, word),
              "take one of " + name_list(materials_for(model)) + ", or an inline table");
}

Material shell_material(const TomlTable& table, const std::filesystem::path& folder) {
  Material material;
  material.name = "inline";
  material.has_lattice = false;
  if (table.has("base")) {
    material = named_material(table.string("base"), table.place("base"), folder);
    require_numbers(material, BodyModel::shell, table.place("base"));
  }
  material.shell = read_shell_material(table, material.shell ? &*material.shell : nullptr);
  return material;
}

Material lattice_material(const TomlTable& table, Bracing bracing, const std::filesystem::path& folder) {
  Material material;
  if (table.has("base")) {
    material = named_material(table.string("base"), table.place("base"), folder);
    require_numbers(material, BodyModel::lattice, table.place("base"));
  } else {
    table.number("density", "kg/m³", Range::positive());
    if (!table.has("youngs_modulus") && !table.has("young_modulus"))
      table.number("edge_modulus", "N/m²", Range::non_negative());
    material.name = "inline";
  }
  // A solid takes the place of the springs of `base`.
  if (table.has("young_modulus"))
    for (double* modulus : {&material.edge_modulus, &material.face_diagonal_modulus,
                            &material.body_diagonal_modulus, &material.volume_modulus})
      *modulus = 0;
  read_material_keys(table, material);
  if (table.has("youngs_modulus")) {
    read_elastic_moduli(table, bracing, material);
  } else if (table.has("shear_modulus")) {
    throw table.error("shear_modulus", "`shear_modulus` stands without `youngs_modulus`", "give both");
  }
  return material;
}

Material read_body_material(const TomlTable& body, BodyModel model, Bracing bracing,
                            const std::filesystem::path& folder) {
  const bool shell = model == BodyModel::shell;
  const char* quantities = shell ? "areal_density, membrane_warp, bending_warp" : "density, edge_modulus";
  const TomlValue* value = body.find("material");
  if (value == nullptr) {
    throw Error(
        ErrorKind::input, body.place(), body.title() + " has no `material`",
        fmt::format("name one (`muslin materials` lists them) or give a table with {}, …", quantities));
  }
  if (value->type == TomlValue::Type::string) {
    Material material = named_material(value->string, value->place, folder);
    require_numbers(material, model, value->place);
    return material;
  }
  if (value->type != TomlValue::Type::table) {
    throw body.error("material", "`material` of " + body.title() + " is neither a name nor a table",
                     fmt::format("write material = \"cotton\" or a table {{ … }} with {}", quantities));
  }
  const std::string title = "`material` of " + body.title();
  if (shell) return shell_material(TomlTable(*value, title, known_keys("body.material of a shell")), folder);
  return lattice_material(TomlTable(*value, title, known_keys("body.material")), bracing, folder);
}

BodyModel read_model(const TomlTable& body) {
  const auto& names = body_model_names();
  const auto model = static_cast<BodyModel>(body.choice("model", {names[0], names[1]}, 0));
  static const std::vector<std::string> of_lattices = {"voxel_width", "voxels", "threshold",
                                                       "bracing",     "mass",   "boundary_springs"};
  static const std::vector<std::string> of_shells = {"rest_mesh", "warp", "stretch_limit"};
  const bool shell = model == BodyModel::shell;
  for (const std::string& key : shell ? of_lattices : of_shells) {
    if (!body.has(key)) continue;
    throw body.error(key, fmt::format("`{}` is a setting of {}", key, shell ? "lattices" : "shells"),
                     fmt::format("take it out, or set `model = \"{}\"`", shell ? "lattice" : "shell"));
  }
  return model;
}

/// Below this, products with blocks use double at usual resolutions, which is many times slower.
constexpr double low_stretch_limit = 1.005;

void read_shell_settings(const TomlTable& table, BodySettings& body, std::vector<std::string>& warnings) {
  if (table.has("thickness"))
    body.shell_thickness = table.number("thickness", "m", {0, largest_coordinate, false});
  if (table.has("rest_mesh")) {
    body.rest_mesh = read_path(table, "rest_mesh");
    body.rest_mesh_place = table.place("rest_mesh");
  }
  if (table.has("warp")) body.warp = read_direction(table, "warp", "[1, 0, 0]");
  if (table.has("stretch_limit")) {
    body.stretch_limit = table.number("stretch_limit", "", {least_stretch_limit, 10, false});
    if (*body.stretch_limit < low_stretch_limit) {
      warnings.push_back(fmt::format(
          "{}: a `stretch_limit` of less than {} makes steps many times slower; cloth looks the same with {}",
          table.title(), low_stretch_limit, low_stretch_limit));
    }
  }
}

void read_lattice_settings(const TomlTable& table, BodySettings& body, std::vector<std::string>& warnings) {
  if (table.has("thickness")) body.thickness = table.number("thickness", "m", {0, largest_coordinate, true});
  body.lattice.width = table.number("voxel_width", "m", {1e-6, 1e6, false});
  body.lattice.rule = static_cast<VoxelRule>(table.choice("voxels", voxel_rule_names(), 0));
  body.lattice.threshold = table.number("threshold", "voxel widths", {-10, 10, false}, 0.5);
  if (table.has("threshold") && body.lattice.rule != VoxelRule::threshold) {
    warnings.push_back(table.title() + ": `threshold` has no effect without `voxels = \"threshold\"`");
  }
  body.bracing = static_cast<Bracing>(table.choice("bracing", bracing_names(), 0));
  body.mass = static_cast<BodySettings::Mass>(table.choice("mass", mass_names(), 0));
  body.boundary_springs = static_cast<BodySettings::BoundarySprings>(
      table.choice("boundary_springs", boundary_spring_names(), 0));
}

}  // namespace

BodySettings read_body(const TomlValue& value, std::size_t index, const std::filesystem::path& folder,
                       std::vector<std::string>& warnings) {
  const TomlTable table(value, title_of("body", value, index), known_keys("body"));
  BodySettings body;
  body.place = table.place();
  body.mesh = read_path(table, "mesh");
  body.mesh_place = table.place("mesh");
  body.name = read_name(table, std::filesystem::path(body.mesh).stem().string());
  body.model = read_model(table);
  if (body.model == BodyModel::shell) {
    read_shell_settings(table, body, warnings);
  } else {
    read_lattice_settings(table, body, warnings);
  }
  body.material = read_body_material(table, body.model, body.bracing, folder);
  if (body.model == BodyModel::shell
          ? body.material.shell->membrane_shear == 0
          : body.material.face_diagonal_modulus == 0 && body.material.body_diagonal_modulus == 0) {
    warnings.push_back(table.title() +
                       (body.model == BodyModel::shell
                            ? ": a material without `membrane_shear` does not resist shear"
                            : ": a material without stiffness along diagonals does not resist shear"));
  }
  body.translate = table.vector("translate", "m", Vec3::Zero());
  body.rotate = table.vector("rotate", "degrees", Vec3::Zero());
  body.scale = read_scale(table);
  body.velocity = table.vector("velocity", "m/s", Vec3::Zero());
  body.contact = table.boolean("contact", true);
  body.self_contact = table.boolean("self_contact", true);
  body.friction = read_friction(table);
  body.colour = read_colour(table);
  return body;
}

}  // namespace muslin
