#include "muslin/scene/read_body.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "muslin/core/toml_table.hpp"
#include "muslin/material/lattice_moduli.hpp"
#include "muslin/material/material_table.hpp"
#include "muslin/scene/names.hpp"
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

/// The three moduli from Young's modulus, and perhaps a shear modulus.
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

Material inline_material(const TomlTable& table, Bracing bracing, const std::filesystem::path& folder) {
  Material material;
  if (table.has("base")) {
    material = named_material(table.string("base"), table.place("base"), folder);
  } else {
    table.number("density", "kg/m³", Range::positive());
    if (!table.has("youngs_modulus")) table.number("edge_modulus", "N/m²", Range::non_negative());
    material.name = "inline";
  }
  read_material_keys(table, material);
  if (table.has("youngs_modulus")) {
    read_elastic_moduli(table, bracing, material);
  } else if (table.has("shear_modulus")) {
    throw table.error("shear_modulus", "`shear_modulus` stands without `youngs_modulus`", "give both");
  }
  return material;
}

Material read_body_material(const TomlTable& body, Bracing bracing, const std::filesystem::path& folder) {
  const TomlValue* value = body.find("material");
  if (value == nullptr) {
    throw Error(ErrorKind::input, body.place(), body.title() + " has no `material`",
                "name one (`muslin materials` lists them) or give a table with density, edge_modulus, …");
  }
  if (value->type == TomlValue::Type::string) return named_material(value->string, value->place, folder);
  if (value->type != TomlValue::Type::table) {
    throw body.error("material", "`material` of " + body.title() + " is neither a name nor a table",
                     "write material = \"cotton\" or material = { density = …, edge_modulus = … }");
  }
  refuse_reserved_keys(*value);
  return inline_material(TomlTable(*value, "`material` of " + body.title(), known_keys("body.material")),
                         bracing, folder);
}

Vec3 read_scale(const TomlTable& body) {
  const TomlValue* value = body.find("scale");
  if (value == nullptr) return Vec3::Ones();
  const std::string name = "`scale` of " + body.title();
  if (value->type == TomlValue::Type::array) return to_vector(*value, name, "", Range::positive());
  return Vec3::Constant(to_number(*value, name, "", Range::positive()));
}

void refuse_shell(const TomlTable& body) {
  if (body.has("model") && body.string("model") == "shell") {
    throw body.error("model", "`model = \"shell\"` is not available yet in this version",
                     "use `model = \"lattice\"`");
  }
  body.choice("model", {"lattice"}, 0);
}

}  // namespace

void require_name(const std::string& name, const Place& place) {
  const bool bad = name.empty() || name.size() > 100 || name.front() == '.' ||
                   name.find_first_of("/\\:*?\"<>|,") != std::string::npos ||
                   std::any_of(name.begin(), name.end(),
                               [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; });
  if (bad) {
    throw Error(ErrorKind::input, place, "`" + name.substr(0, 40) + "` cannot be a name",
                "use 1 to 100 letters, digits, `_`, `-`, `.` or spaces, not starting with a dot");
  }
}

BodySettings read_body(const TomlValue& value, std::size_t index, const std::filesystem::path& folder,
                       std::vector<std::string>& warnings) {
  refuse_reserved_keys(value);
  const TomlValue* given = value.find("name");
  const bool has_name = given != nullptr && given->type == TomlValue::Type::string;
  const TomlTable table(value, "[[body]] " + (has_name ? given->string : std::to_string(index)),
                        known_keys("body"));
  refuse_shell(table);
  BodySettings body;
  body.place = table.place();
  body.mesh = table.string("mesh");
  body.mesh_place = table.place("mesh");
  if (body.mesh.empty() || body.mesh.find('\0') != std::string::npos) {
    throw table.error("mesh", "`mesh` is no path", "name a mesh file");
  }
  body.name = table.string("name", std::filesystem::path(body.mesh).stem().string());
  require_name(body.name, table.place("name"));
  if (table.has("thickness")) body.thickness = table.number("thickness", "m", Range::positive());
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
  body.material = read_body_material(table, body.bracing, folder);
  if (body.material.face_diagonal_modulus == 0 && body.material.body_diagonal_modulus == 0) {
    warnings.push_back(table.title() +
                       ": a material without stiffness along diagonals does not resist shear");
  }
  body.translate = table.vector("translate", "m", Vec3::Zero());
  body.rotate = table.vector("rotate", "degrees", Vec3::Zero());
  body.scale = read_scale(table);
  body.velocity = table.vector("velocity", "m/s", Vec3::Zero());
  if (table.has("colour")) {
    body.colour = table.vector("colour", "sRGB 0 to 1");
    if (body.colour->minCoeff() < 0 || body.colour->maxCoeff() > 1)
      throw table.error("colour", "a colour is red, green and blue from 0 to 1",
                        "write for example [0.2, 0.5, 0.2]");
  }
  return body;
}

}  // namespace muslin
