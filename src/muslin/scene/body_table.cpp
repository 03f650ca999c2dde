#include "muslin/scene/body_table.hpp"

#include <algorithm>

#include "muslin/geometry/inspect.hpp"
#include "muslin/scene/body_material.hpp"
#include "muslin/scene/common_keys.hpp"
#include "muslin/scene/names.hpp"
#include "muslin/schema/declare.hpp"

namespace muslin {
namespace {

using schema::Key;
using schema::within;

/// The stiffness of a limit grows as 1/(limit − 1) (energy/stretch_limit.hpp) without bound: a limit a
/// rounding error above 1 asks for 1e16 times the weight of the cloth. At this one, a millimetre in a metre,
/// it is five times that of low_stretch_limit, and the range in which it rises is still far above rounding.
constexpr double least_stretch_limit = 1.001;
/// Below this, products with blocks use double at usual resolutions, which is many times slower.
constexpr double low_stretch_limit = 1.005;

const schema::Table& lattice_table() {
  static const schema::Table table = schema::table_of<BodySettings>(
      "lattice",
      {schema::number("thickness", &BodySettings::thickness)
           .unit("m")
           .range({0, largest_coordinate, true})
           .otherwise("one voxel width")
           .shown_as<BodySettings>([](const BodySettings& body) {
             return schema::real(body.thickness.value_or(body.lattice.width));
           })
           .means("of a lattice that is a sheet: an open mesh, or one that encloses nothing. An open mesh "
                  "with small "
                  "holes is filled as a solid unless `thickness` is given"),
       within(&BodySettings::lattice, schema::number("voxel_width", &LatticeSettings::width)
                                          .unit("m")
                                          .range({1e-6, 1e6, false})
                                          .required()
                                          .means("edge of a voxel: halving it doubles the detail and takes "
                                                 "at least eight times as long for "
                                                 "a solid, four times for a sheet")),
       within(&BodySettings::lattice, schema::word("voxels", &LatticeSettings::rule, voxel_rule_names())
                                          .means("`\"cover\"`: every voxel that meets the solid · "
                                                 "`\"threshold\"`: every voxel whose centre "
                                                 "is nearer than `threshold`")),
       within(&BodySettings::lattice,
              schema::number("threshold", &LatticeSettings::threshold)
                  .unit("voxel widths")
                  .range({-10, 10, false})
                  .shown_if<LatticeSettings>(
                      [](const LatticeSettings& lattice) { return lattice.rule == VoxelRule::threshold; })
                  .means("signed distance, negative inside; only with `voxels = \"threshold\"`")),
       schema::word("bracing", &BodySettings::bracing, bracing_names())
           .means("`\"kuhn\"`: springs along the edges of six tetrahedra a voxel · `\"full\"`: all "
                  "diagonals, the "
                  "same stiffness in mirrored directions"),
       schema::word("mass", &BodySettings::mass, mass_names())
           .means("`\"solid\"`: a voxel weighs, and is as stiff as, the share of it that the solid fills · "
                  "`\"cells\"`: every voxel counts full"),
       schema::word("boundary_springs", &BodySettings::boundary_springs, boundary_spring_names())
           .means(
               "`\"full\"`: springs on the surface are as stiff as inside · `\"shared\"`: by the share of "
               "voxels "
               "around them, as a solid cut out of a block. A sheet of one voxel is 1.75 times too stiff in "
               "stretch and 4.5 times in bending without"),
       lattice_material_key()});
  return table;
}

const schema::Table& shell_table() {
  static const schema::Table table = schema::table_of<BodySettings>(
      "shell",
      {schema::number("thickness", &BodySettings::shell_thickness)
           .unit("m")
           .range({0, largest_coordinate, false})
           .otherwise("see below")
           .means("thickness in contact"),
       schema::path("rest_mesh", &BodySettings::rest_mesh, &BodySettings::rest_mesh_place)
           .otherwise("the mesh")
           .means("a mesh with the same polygons in the stress-free shape; `scale` applies to it"),
       schema::direction("warp", &BodySettings::warp, "[1, 0, 0]")
           .otherwise("see below")
           .means("direction of the warp threads in the mesh as modelled"),
       schema::number("stretch_limit", &BodySettings::stretch_limit)
           .range({least_stretch_limit, 10, false})
           .may_change_on_resume()
           .means("largest stretch of a triangle in any direction, as length over rest length; 1.05 is 5 % "
                  "longer"),
       shell_material_key()});
  return table;
}

/// The keys of every body that follow those of its model.
std::vector<Key> placed_keys() {
  return {
      schema::vector("translate", &BodySettings::translate).unit("m").means("applied last"),
      schema::vector("rotate", &BodySettings::rotate)
          .unit("degrees")
          .means("about the x axis, then y, then z"),
      scale_key(&BodySettings::scale),
      schema::vector("velocity", &BodySettings::velocity).unit("m/s").means("at the start"),
      schema::truth("contact", &BodySettings::contact).means("`false` excludes the body from contact"),
      schema::truth("self_contact", &BodySettings::self_contact)
          .means("`false` excludes contact of the body with itself"),
      friction_key(&BodySettings::friction),
      schema::colour("colour", &BodySettings::colour)
          .may_change_on_resume()
          .otherwise("one of a palette")
          .means("colour of the body in pictures: red, green, blue"),
  };
}

schema::Table declared() {
  const std::vector<std::string> models(body_model_names().begin(), body_model_names().begin() + 2);
  schema::Table table = schema::table_of<BodySettings>(
      "[[body]]", {name_key<BodySettings>("the mesh's file name")
                       .means("used in file names, messages and by pins; different for each body"),
                   schema::path("mesh", &BodySettings::mesh, &BodySettings::mesh_place)
                       .required()
                       .means("`.obj`, `.ply`, `.stl`, `.gltf`, `.glb`, `.dae` or `.fbx`"),
                   schema::word("model", &BodySettings::model, models)
                       .means("`\"lattice\"`: voxels with springs, filled into the mesh · `\"shell\"`: the "
                              "mesh itself as [thin "
                              "cloth](shells.md)")});
  for (Key& key : placed_keys()) table.keys.push_back(std::move(key));
  schema::choose(table, "model", &BodySettings::model,
                 {{"lattice", "lattices", lattice_table}, {"shell", "shells", shell_table}});
  return table;
}

void warn(const TomlTable& table, const BodySettings& body, std::vector<std::string>& warnings) {
  const bool shell = body.model == BodyModel::shell;
  if (shell && body.stretch_limit && *body.stretch_limit < low_stretch_limit) {
    warnings.push_back(fmt::format(
        "{}: a `stretch_limit` of less than {} makes steps many times slower; cloth looks the same with {}",
        table.title(), low_stretch_limit, low_stretch_limit));
  }
  if (table.has("threshold") && body.lattice.rule != VoxelRule::threshold)
    warnings.push_back(table.title() + ": `threshold` has no effect without `voxels = \"threshold\"`");
  const Material& material = body.material;
  if (shell ? material.shell->membrane_shear == 0
            : material.law == LatticeLaw::springs && material.face_diagonal_modulus == 0 &&
                  material.body_diagonal_modulus == 0) {
    warnings.push_back(table.title() +
                       (shell ? ": a material without `membrane_shear` does not resist shear"
                              : ": a material without stiffness along diagonals does not resist shear"));
  }
}

}  // namespace

const schema::Table& body_table() {
  static const schema::Table table = declared();
  return table;
}

void finish_body(const TomlTable& table, BodySettings& body, Scene& scene) {
  complete_name(table, std::filesystem::path(body.mesh).stem().string(), body.name);
  read_body_material(table, scene.file.parent_path(), body);
  warn(table, body, scene.warnings);
  require_new_name(table, scene.bodies, "body", "body", body.name);
}

}  // namespace muslin
