#include "muslin/component/shell/shell_kind.hpp"

#include "muslin/component/body_material.hpp"
#include "muslin/component/shell/shell_body.hpp"
#include "muslin/component/shell/shell_body_settings.hpp"
#include "muslin/geometry/inspect.hpp"
#include "muslin/material/derive_anew.hpp"

namespace muslin {
namespace {

using Own = ShellBodySettings;

/// Below this, products with blocks use double at usual resolutions, which is many times slower.
constexpr double low_stretch_limit = 1.005;

/// `material` as a table.
struct MaterialInput {
  std::string base;
  ShellMaterial base_shell, shell;  ///< of the base, and with the changes
};

const schema::Table& input_table() {
  static const schema::Table table = [] {
    schema::Table input = schema::table_of<MaterialInput>(
        "`material` of a shell",
        {schema::text("base", &MaterialInput::base)
             .means("a material by name or path that has `[shell]` numbers; the other keys "
                    "change it")});
    schema::include<MaterialInput>(input, &MaterialInput::shell, shell_material_table());
    input.complete = [own = input.complete](const TomlTable& given, void* settings) {
      own(given, settings);
      auto& read = *static_cast<MaterialInput*>(settings);
      if (given.has("base")) derive_anew(given, read.base_shell, read.shell);
    };
    return input;
  }();
  return table;
}

Material read_table(const TomlTable& table, const BodySettings& body, const std::filesystem::path& folder);

const MaterialUse material_use = {
    .kind = "shell",
    .plural = "shells",
    .quantities = "areal_density, membrane_warp, bending_warp",
    .remedy = "set `material.shell`, or choose the lattice",
    .keys = input_table,
    .has_numbers = [](const Material& material) { return material.shell.has_value(); },
    .read = read_table,
    .write = [](const Material& material) { return shell_material_table().write(*material.shell); },
    .check = [](const Material& material,
                const schema::Subject& subject) { shell_material_table().check(*material.shell, subject); }};

Material read_table(const TomlTable& table, const BodySettings& /*body*/,
                    const std::filesystem::path& folder) {
  Material material;
  material.name = "inline";
  material.has_lattice = false;
  MaterialInput input;
  if (table.has("base")) {
    material = base_material(material_use, table, folder);
    if (material.shell) input.base_shell = input.shell = *material.shell;
  }
  input_table().read(table, input);
  material.shell = input.shell;
  return material;
}

const schema::Table& keys() {
  static const schema::Table table = kind_table<Own>(
      "shell",
      {schema::number("thickness", &Own::thickness)
           .unit("m")
           .range({0, largest_coordinate, false})
           .otherwise("see below")
           .means("thickness in contact"),
       schema::path("rest_mesh", &Own::rest_mesh, &Own::rest_mesh_place)
           .otherwise("the mesh")
           .means("a mesh with the same polygons in the stress-free shape; `scale` applies to it"),
       schema::number("rest_scale_warp", &Own::rest_scale_warp)
           .range({0.01, 100, false})
           .means("stress-free length along warp over that of the mesh: below 1 the cloth shrinks"),
       schema::number("rest_scale_weft", &Own::rest_scale_weft)
           .range({0.01, 100, false})
           .otherwise("as warp")
           .means("stress-free length along weft over that of the mesh"),
       schema::direction("warp", &Own::warp, "[1, 0, 0]")
           .otherwise("see below")
           .means("direction of the warp threads in the mesh as modelled"),
       schema::word("compression", &Own::compression, {"buckling", "elastic"})
           .means(
               "how threads resist compression: `buckling`, up to the load at which cells of the mesh fold; "
               "`elastic`, as they resist tension"),
       schema::number("stretch_limit", &Own::stretch_limit)
           .range({least_stretch_limit, 10, false})
           .may_change_on_resume()
           .otherwise("that of the material, or none")
           .means("largest stretch of a triangle in any direction, as length over rest length; 1.05 allows "
                  "5 %")},
      {material_key(material_use)});
  return table;
}

/// The largest of a limit that varies.
std::optional<double> largest_limit(const ShellMaterial& material) {
  const schema::Variation* variation = schema::find_variation(material.variations, "stretch_limit");
  if (variation == nullptr || !variation->is_map()) return material.stretch_limit;
  return variation->greatest();
}

void finish(const TomlTable& table, const std::filesystem::path& folder, BodySettings& body,
            std::vector<std::string>& warnings) {
  read_body_material(material_use, table, folder, body);
  std::optional<double>& limit = body.own.as<Own>().stretch_limit;
  if (limit && body.material.shell)
    schema::forget_variation(body.material.shell->variations, "stretch_limit");
  const ShellMaterial numbers = body.material.shell.value_or(ShellMaterial());
  if (!limit) limit = largest_limit(numbers);
  if (limit && *limit < low_stretch_limit) {
    warnings.push_back(fmt::format(
        "{}: a `stretch_limit` of less than {} makes steps many times slower; cloth looks the same with {}",
        table.title(), low_stretch_limit, low_stretch_limit));
  }
  if (numbers.membrane_shear == 0 && !numbers.shear_curve)
    warnings.push_back(table.title() + ": a material without `membrane_shear` does not resist shear");
}

std::vector<std::string*> cut_meshes(BodySettings& body) {
  auto& own = body.own.as<Own>();
  if (own.rest_mesh.empty()) return {&body.mesh};
  return {&own.rest_mesh, &body.mesh};
}

}  // namespace

const BodyKind shell_kind = {.name = "shell",
                             .plural = "shells",
                             .meaning = "the mesh itself as [thin cloth](shells.md)",
                             .keys = keys,
                             .finish = finish,
                             .build = build_shell_body,
                             .cut_meshes = cut_meshes};

}  // namespace muslin
