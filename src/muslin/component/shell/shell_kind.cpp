#include "muslin/component/shell/shell_kind.hpp"

#include "muslin/component/body_material.hpp"
#include "muslin/component/component_keys.hpp"
#include "muslin/component/shell/shell_body.hpp"
#include "muslin/component/shell/shell_body_settings.hpp"
#include "muslin/geometry/inspect.hpp"
#include "muslin/material/derive_anew.hpp"
#include "muslin/schema/over_time.hpp"

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

/// The key checks and writes the fabrics; `finish` reads them.
schema::Declaration fabric_key() {
  schema::Key key = schema::custom<Own>(
      "fabric", {schema::Type::tables}, [](const schema::Key&, const TomlTable&, Own&) {},
      [](const schema::Key& k, const Own& own, TomlValue& out) {
        TomlValue fabrics = schema::list({});
        for (const ShellFabric& fabric : own.fabrics) fabrics.items.push_back(fabric_table().write(fabric));
        schema::append(out, k.name, std::move(fabrics));
      });
  key.table = fabric_table;
  key.check = [](const schema::Key&, const void* s, const schema::Subject&) {
    for (const ShellFabric& fabric : static_cast<const Own*>(s)->fabrics)
      fabric_table().check(
          fabric, schema::Subject(fmt::format("[[body.fabric]] of `{}`", fabric.faces), fabric.place));
  };
  return schema::Declaration(std::move(key))
      .template shown_if<Own>([](const Own& own) { return !own.fabrics.empty(); })
      .otherwise("one for all faces")
      .means("fabrics of some faces; the others have `material`");
}

schema::Table declare_shell() {
  schema::Table table = kind_table<Own>(
      "shell",
      {schema::number("thickness", &Own::thickness)
           .unit("m")
           .range({0, largest_coordinate, false})
           .steady(steady_thickness)
           .varies(&Own::variations, {.map = true})
           .otherwise("see below")
           .means("thickness in contact"),
       schema::path("rest_mesh", &Own::rest_mesh, &Own::rest_mesh_place)
           .otherwise("the mesh")
           .means("a mesh with the same polygons in the stress-free shape, cut along seams or not; `scale` "
                  "applies to it"),
       schema::word("rest", &Own::rest, {"mesh", "uv"})
           .shown_if<Own>([](const Own& own) { return own.rest == RestSource::uv; })
           .means("`\"mesh\"`: the stress-free shape is that of `rest_mesh`, or else of the mesh · `\"uv\"`: "
                  "the texture coordinates are the flat pattern"),
       schema::number("uv_scale", &Own::uv_scale)
           .unit("m")
           .range({1e-6, 1e6, false})
           .otherwise("mesh and pattern have equal areas")
           .means("length of one unit of the texture, only with `rest = \"uv\"`"),
       schema::number("rest_scale_warp", &Own::rest_scale_warp)
           .range({0.01, 100, false})
           .varies(&Own::variations, {.map = true})
           .means("stress-free length along warp over that of the mesh: below 1 the cloth shrinks"),
       schema::number("rest_scale_weft", &Own::rest_scale_weft)
           .range({0.01, 100, false})
           .varies(&Own::variations, {.map = true})
           .otherwise("as warp")
           .means("stress-free length along weft over that of the mesh"),
       schema::number("rest_scale_share", &Own::rest_scale_share)
           .range(Range::between(0, 1))
           .varies(&Own::variations, {.keyframes = true})
           .shown_if<Own>([](const Own& own) {
             return own.rest_scale_share != 1 ||
                    schema::find_variation(own.variations, "rest_scale_share") != nullptr;
           })
           .means(
               "share of the change to `rest_scale_warp` and `rest_scale_weft` that has come about: from 0 "
               "to 1 over time the cloth dries"),
       schema::direction("warp", &Own::warp, "[1, 0, 0]")
           .otherwise("see below")
           .means("direction of the warp threads in the mesh as modelled"),
       schema::word("compression", &Own::compression, {"buckling", "elastic"})
           .means(
               "how threads resist compression: `buckling`, up to the load at which cells of the mesh fold; "
               "`elastic`, as they resist tension"),
       schema::number("stretch_limit", &Own::stretch_limit)
           .range({least_stretch_limit, 10, false})
           .varies(&Own::variations, {.keyframes = true})
           .may_change_on_resume()
           .otherwise("that of the material, or none")
           .means("largest stretch of a triangle in any direction, as length over rest length; 1.05 allows "
                  "5 %"),
       fabric_key()},
      {material_key(material_use, &BodySettings::material)});
  schema::add_rule<BodySettings>(table, [](const BodySettings& body, const schema::Subject& subject) {
    const Own& own = body.own.as<Own>();
    if (own.rest == RestSource::mesh && own.uv_scale)
      throw subject.error("uv_scale", "`uv_scale` has no effect without `rest = \"uv\"`", "give both");
    if (own.rest == RestSource::uv && !own.rest_mesh.empty())
      throw subject.error("rest", "the stress-free shape is given twice, by `rest` and `rest_mesh`",
                          "keep one of them");
  });
  return table;
}

const schema::Table& keys() {
  static const schema::Table table = declare_shell();
  return table;
}

void read_fabrics(const TomlTable& table, const std::filesystem::path& folder, BodySettings& body) {
  if (!table.has("fabric")) return;
  for (const TomlValue& value : schema::section_values("fabric", table)) {
    const TomlTable own = fabric_table().open(value, fmt::format("a fabric of {}", table.title()));
    ShellFabric fabric;
    fabric_table().read(own, fabric);
    fabric.material = material_of(material_use, own, body, folder);
    body.own.as<Own>().fabrics.push_back(std::move(fabric));
  }
}

/// Warns of numbers that are legal but probably unintended.
void look_at(const ShellMaterial& numbers, std::optional<double> limit, const std::string& title,
             std::vector<std::string>& warnings) {
  if (limit && *limit < low_stretch_limit) {
    warnings.push_back(fmt::format(
        "{}: a `stretch_limit` of less than {} makes steps many times slower; cloth looks the same with {}",
        title, low_stretch_limit, low_stretch_limit));
  }
  if (numbers.membrane_shear == 0 && !numbers.shear_curve)
    warnings.push_back(title + ": a material without `membrane_shear` does not resist shear");
}

void finish(const TomlTable& table, const std::filesystem::path& folder, BodySettings& body,
            std::vector<std::string>& warnings) {
  body.material = material_of(material_use, table, body, folder);
  read_fabrics(table, folder, body);
  auto& own = body.own.as<Own>();
  if (!own.rest_scale_weft && schema::find_variation(own.variations, "rest_scale_warp") != nullptr) {
    own.rest_scale_weft = own.rest_scale_warp;
    schema::copy_variation(own.variations, "rest_scale_warp", "rest_scale_weft");
  }
  const bool given = own.stretch_limit.has_value(), several = !own.fabrics.empty();
  std::optional<double> least_limit;
  if (const auto limit = schema::over_time(own.variations, "stretch_limit", own.stretch_limit))
    least_limit = limit->least();
  const auto complete = [&](Material& material, const std::string& title) {
    if (!material.shell) return;
    ShellMaterial& numbers = *material.shell;
    if (given) schema::forget_variation(numbers.variations, "stretch_limit");
    if (given && several) numbers.stretch_limit = own.stretch_limit;
    look_at(numbers, given ? least_limit : largest_stretch_limit(numbers), title, warnings);
  };
  complete(body.material, table.title());
  for (ShellFabric& fabric : own.fabrics)
    complete(fabric.material, fmt::format("`{}` of {}", fabric.faces, table.title()));
  if (!given && !several && body.material.shell)
    own.stretch_limit = largest_stretch_limit(*body.material.shell);
}

/// The rest mesh belongs to the polygons, which a cut keeps.
std::vector<std::string*> cut_meshes(BodySettings& body) { return {&body.mesh}; }

}  // namespace

const schema::Table& fabric_table() {
  static const schema::Table table = schema::table_of<ShellFabric>(
      "[[body.fabric]]",
      {schema::text("faces", &ShellFabric::faces)
           .required()
           .means("a face group of the mesh (OBJ `g`), or a material of its file (`usemtl` "
                  "of OBJ, materials of glTF)"),
       material_key(material_use, &ShellFabric::material),
       friction_key(&ShellFabric::friction)
           .varies(&ShellFabric::variations, {.map = true, .keyframes = true})
           .otherwise("that of the body")
           .means("Coulomb's coefficient of its faces; vertices of several fabrics have that of the last one "
                  "with its own")});
  return table;
}

const BodyKind shell_kind = {.name = "shell",
                             .plural = "shells",
                             .meaning = "the mesh itself as [thin cloth](shells.md)",
                             .keys = keys,
                             .finish = finish,
                             .build = build_shell_body,
                             .cut_meshes = cut_meshes};

}  // namespace muslin
