#include "muslin/component/lattice/lattice_kind.hpp"

#include <optional>
#include <utility>

#include "muslin/component/body_material.hpp"
#include "muslin/component/lattice/lattice_body.hpp"
#include "muslin/component/lattice/lattice_body_settings.hpp"
#include "muslin/geometry/inspect.hpp"
#include "muslin/lattice/lattice_moduli.hpp"
#include "muslin/material/material_table.hpp"

namespace muslin {
namespace {

using Own = LatticeBodySettings;

/// `material` as a table.
struct MaterialInput {
  std::string base;
  std::optional<double> shear_modulus;
  Material material;
};

const schema::Table& input_table() {
  static const schema::Table table = [] {
    schema::Table input = schema::table_of<MaterialInput>(
        "`material` of a lattice",
        {schema::text("base", &MaterialInput::base)
             .means("a material by name or path; the other keys change it"),
         schema::number("shear_modulus", &MaterialInput::shear_modulus)
             .unit("N/m²")
             .range(Range::non_negative())
             .otherwise("0.4 × `youngs_modulus`")
             .needs("youngs_modulus", "give both")
             .excludes("law", "a solid has no shear modulus of its own", "give `poisson`")
             .means("shear modulus of the springs, only with `youngs_modulus`")});
    schema::include<MaterialInput>(input, &MaterialInput::material, lattice_material_table());
    return input;
  }();
  return table;
}

/// Lets the three moduli vary as Young's modulus does, to which they are proportional.
void vary_moduli(const schema::Variation& youngs, Bracing bracing, Material& material) {
  const SpringModuli from = springs_for(youngs.from, std::nullopt, bracing);
  const SpringModuli to = springs_for(youngs.to, std::nullopt, bracing);
  const auto varied = [&](const char* key, double first, double last) {
    schema::Variation modulus = youngs;
    modulus.key = key;
    modulus.from = first;
    modulus.to = last;
    return modulus;
  };
  const schema::Variations moduli = {varied("edge_modulus", from.edge, to.edge),
                                     varied("face_diagonal_modulus", from.face_diagonal, to.face_diagonal),
                                     varied("body_diagonal_modulus", from.body_diagonal, to.body_diagonal)};
  schema::forget_variation(material.variations, "youngs_modulus");
  material.variations.insert(material.variations.end(), moduli.begin(), moduli.end());
}

/// Sets the three moduli by Young's modulus and an optional shear modulus.
void set_moduli(const TomlTable& table, std::optional<double> shear_modulus, Bracing bracing,
                Material& material) {
  const double youngs = *material.youngs_modulus;
  const double greatest = greatest_shear_ratio(bracing) * youngs;
  if (shear_modulus && *shear_modulus >= greatest) {
    throw table.error(
        "shear_modulus",
        fmt::format("springs reach a shear modulus of less than {:.4g} N/m² at this Young's modulus",
                    greatest),
        "lower `shear_modulus` or leave it out");
  }
  const SpringModuli moduli = springs_for(youngs, shear_modulus, bracing);
  material.edge_modulus = moduli.edge;
  material.face_diagonal_modulus = moduli.face_diagonal;
  material.body_diagonal_modulus = moduli.body_diagonal;
  material.youngs_modulus.reset();
  const schema::Variation* map = schema::find_variation(material.variations, "youngs_modulus");
  if (map == nullptr) return;
  if (shear_modulus)
    throw table.error("shear_modulus", "`shear_modulus` stands beside a `youngs_modulus` that varies",
                      "leave it out");
  vary_moduli(*map, bracing, material);
}

/// A solid takes the place of the springs of `base`.
void drop_springs(Material& material) {
  for (double* modulus : {&material.edge_modulus, &material.face_diagonal_modulus,
                          &material.body_diagonal_modulus, &material.volume_modulus})
    *modulus = 0;
}

Material read_table(const TomlTable& table, const BodySettings& body, const std::filesystem::path& folder);

const MaterialUse material_use = {
    .kind = "lattice",
    .plural = "lattices",
    .quantities = "density, edge_modulus",
    .remedy = "set them, or choose the shell",
    .keys = input_table,
    .has_numbers = [](const Material& material) { return material.has_lattice; },
    .read = read_table,
    .write = [](const Material& material) { return lattice_material_table().write(material); },
    .check = [](const Material& material,
                const schema::Subject& subject) { lattice_material_table().check(material, subject); }};

Material read_table(const TomlTable& table, const BodySettings& body, const std::filesystem::path& folder) {
  MaterialInput input;
  input.material.name = "inline";
  if (table.has("base")) input.material = base_material(material_use, table, folder);
  if (table.has("law")) drop_springs(input.material);
  input_table().read(table, input);
  if (input.material.youngs_modulus && input.material.has_springs())
    set_moduli(table, input.shear_modulus, body.own.as<Own>().bracing, input.material);
  return input.material;
}

const schema::Table& keys() {
  static const schema::Table table = kind_table<Own>(
      "lattice",
      {schema::word("inside", &Own::inside, {"auto", "filled", "sheet"})
           .means(
               "`\"auto\"`: a mesh that is closed, or has small holes only, is a solid, any other a sheet · "
               "`\"filled\"`: a solid, wherever the winding number of the mesh is above one half, however "
               "large its holes · `\"sheet\"`: a sheet, though the mesh is closed"),
       schema::number("thickness", &Own::thickness)
           .unit("m")
           .range({0, largest_coordinate, true})
           .otherwise("one voxel width")
           .shown_as<Own>(
               [](const Own& own) { return schema::real(own.thickness.value_or(own.lattice.width)); })
           .means(
               "thickness of a lattice that is a sheet: an open mesh, or one that encloses nothing. An open "
               "mesh with small holes is filled as a solid unless `thickness` is given"),
       schema::within<Own>(&Own::lattice,
                           schema::number("voxel_width", &LatticeSettings::width)
                               .unit("m")
                               .range({1e-6, 1e6, false})
                               .required()
                               .means("edge of a voxel: halving it doubles the detail and takes "
                                      "at least eight times as long for "
                                      "a solid, four times for a sheet")),
       schema::within<Own>(&Own::lattice, schema::word("voxels", &LatticeSettings::rule, voxel_rule_names())
                                              .means("`\"cover\"`: every voxel that meets the solid · "
                                                     "`\"threshold\"`: every voxel whose centre "
                                                     "has a signed distance below `threshold`")),
       schema::within<Own>(
           &Own::lattice, schema::number("threshold", &LatticeSettings::threshold)
                              .unit("voxel widths")
                              .range({-10, 10, false})
                              .shown_if<LatticeSettings>([](const LatticeSettings& lattice) {
                                return lattice.rule == VoxelRule::threshold;
                              })
                              .means("signed distance, negative inside; only with `voxels = \"threshold\"`")),
       schema::truth("separate_parts", &Own::separate_parts)
           .means(
               "`true`: solids of the mesh that are apart stay apart, even if they are nearer than a voxel. "
               "Parts that cross each other, or lie one inside the other, are one solid"),
       schema::word("bracing", &Own::bracing, bracing_names())
           .means("`\"kuhn\"`: springs along the edges of six tetrahedra per voxel · `\"full\"`: all "
                  "diagonals, equally stiff in mirrored directions"),
       schema::word("mass", &Own::mass, {"solid", "cells"})
           .means("`\"solid\"`: mass and stiffness of a voxel are scaled by the share that the solid fills · "
                  "`\"cells\"`: every voxel has full mass and stiffness"),
       schema::word("boundary_springs", &Own::boundary_springs, {"full", "shared"})
           .means("`\"full\"`: springs on the surface are as stiff as inside · `\"shared\"`: scaled by the "
                  "share of voxels around them, as in a solid cut out of a block. Without it a sheet of one "
                  "voxel is "
                  "1.75 times too stiff in stretch and 4.5 times in bending")},
      {material_key(material_use, &BodySettings::material)});
  return table;
}

void finish(const TomlTable& table, const std::filesystem::path& folder, BodySettings& body,
            std::vector<std::string>& warnings) {
  body.material = material_of(material_use, table, body, folder);
  if (table.has("threshold") && body.own.as<Own>().lattice.rule != VoxelRule::threshold)
    warnings.push_back(table.title() + ": `threshold` has no effect without `voxels = \"threshold\"`");
  const Material& material = body.material;
  if (material.has_springs() && material.face_diagonal_modulus == 0 && material.body_diagonal_modulus == 0) {
    warnings.push_back(table.title() +
                       ": a material without stiffness along diagonals does not resist shear");
  }
}

}  // namespace

const BodyKind lattice_kind = {.name = "lattice",
                               .plural = "lattices",
                               .meaning = "voxels with springs, filled into the mesh",
                               .keys = keys,
                               .finish = finish,
                               .build = build_lattice_body};

const std::vector<std::string>& voxel_rule_names() {
  static const std::vector<std::string> names = {"cover", "threshold"};
  return names;
}

const std::vector<std::string>& bracing_names() {
  static const std::vector<std::string> names = {"kuhn", "full"};
  return names;
}

}  // namespace muslin
