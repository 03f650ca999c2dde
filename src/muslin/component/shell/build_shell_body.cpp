#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "muslin/component/body_maps.hpp"
#include "muslin/component/body_mesh.hpp"
#include "muslin/component/body_table.hpp"
#include "muslin/component/placement.hpp"
#include "muslin/component/shell/shell_body.hpp"
#include "muslin/component/shell/shell_kind.hpp"
#include "muslin/core/counted.hpp"
#include "muslin/core/index.hpp"
#include "muslin/material/keyed_material.hpp"
#include "muslin/material/measured_sheet.hpp"
#include "muslin/shell/inverted_triangles.hpp"
#include "muslin/shell/rest_scale.hpp"
#include "muslin/shell/rest_shape.hpp"
#include "muslin/shell/triangle_corners.hpp"

namespace muslin {
namespace {

constexpr double largest_cloth = 20;  // [m]
constexpr double folding_size = 8;    // cloth of fewer edges has no folds
constexpr double largest_ratio = 5;   // of lengths of rest shape and mesh that are in the same units

class ShellBuilder {
 public:
  ShellBuilder(const BodySettings& settings, const ComponentInputs& inputs)
      : settings_(settings),
        own_(settings.own.as<ShellBodySettings>()),
        inputs_(inputs),
        file_(inputs.files.resolve(settings.mesh).string()) {
    body_.settings = settings;
  }

  std::shared_ptr<Component> build() {
    read_body_mesh(settings_, inputs_, MeshUse::cloth, body_);
    const std::vector<int> fabric_of_face = lay_fabrics();
    add_maps(own_.variations, shell_kind.keys());
    add_maps(settings_.variations, body_table());
    for (const FabricInUse& fabric : body_.fabrics)
      add_maps(fabric.variations, fabric_table(), fabric.name + ".");
    const RestShape rest = rest_shape();
    at_place(settings_.mesh_place, file_, [&] { make_shell(rest); });
    for (const int face : body_.shell.faces) body_.triangle_fabrics.push_back(fabric_of_face[at(face)]);
    vary_material();
    weigh(body_);
    return built_;
  }

 private:
  void say(const std::string& sentence) { warn_of_body(inputs_, settings_.name, sentence); }

  /// Returns the fabric of each face. The material of the first fabric in use becomes that of the body.
  std::vector<int> lay_fabrics() {
    FabricsOfFaces found = fabrics_of_faces(settings_.material, settings_.place, own_.fabrics, body_.mesh);
    body_.fabrics = std::move(found.fabrics);
    body_.settings.material = body_.fabrics.front().material;
    auto& own = body_.settings.own.as<ShellBodySettings>();
    if (body_.has_several_fabrics()) {
      for (const FabricInUse& fabric : body_.fabrics) require_moduli(fabric);
    } else if (!own.stretch_limit) {
      own.stretch_limit = largest_stretch_limit(body_.material());
    }
    if (body_.material().yield_strain && own.compression == Compression::buckling)
      throw Error(ErrorKind::input, settings_.place,
                  fmt::format("body {}: threads that buckle under compression cannot yield", settings_.name),
                  "set `compression` to \"elastic\", or leave out `yield_strain`");
    return std::move(found.of_face);
  }

  /// Only moduli can change from triangle to triangle.
  static void require_moduli(const FabricInUse& fabric) {
    const ShellMaterial& m = fabric.numbers();
    const char* problem = nullptr;
    if (has_curves(m) || has_bending_curves(m)) problem = "measured curves";
    if (has_bending_friction(m)) problem = "internal friction of bending";
    if (m.yield_curvature) problem = "a `yield_curvature`";
    if (m.yield_strain) problem = "a `yield_strain`";
    if (problem == nullptr) return;
    throw Error(ErrorKind::input, fabric.place,
                fmt::format("the fabric `{}` has {}, which a body of several fabrics cannot have",
                            fabric.name, problem),
                "give it moduli, or make its faces a body of their own, joined by an [[attachment]]");
  }

  /// The stress-free shape: the mesh as it was modelled (scaled, not turned), another of the same polygons,
  /// or the texture.
  RestShape rest_shape() {
    if (own_.rest == RestSource::uv)
      return at_place(settings_.mesh_place, file_,
                      [&] { return rest_of_texture(body_.mesh, own_.uv_scale); });
    if (own_.rest_mesh.empty()) return rest_of_vertices(body_.mesh, body_.mesh.positions);
    const std::string rest_file = inputs_.files.resolve(own_.rest_mesh).string();
    return at_place(own_.rest_mesh_place, rest_file, [&] {
      Mesh rest = inputs_.files.mesh(own_.rest_mesh).mesh;
      require_usable(rest, rest_file);
      require_same_polygons(rest);
      for (Vec3& x : rest.positions) x = settings_.scale.cwiseProduct(x);
      return RestShape{std::move(rest.positions), std::move(rest.face_vertices)};
    });
  }

  /// A rest mesh may be cut where the mesh is sewn, but joins no vertices that lie apart in the mesh.
  void require_same_polygons(const Mesh& rest) const {
    const auto fail = [&](const std::string& difference) {
      throw Error(
          ErrorKind::input, fmt::format("its polygons are not those of {}: {}", file_, difference),
          "make the rest mesh of a copy: move its vertices and cut it along seams, but keep its polygons "
          "and their order");
    };
    const Mesh& mesh = body_.mesh;
    if (rest.face_offsets != mesh.face_offsets)
      fail(fmt::format("{} against {}, or other numbers of corners", rest.face_count(), mesh.face_count()));
    std::vector<int> vertex_of(rest.vertex_count(), -1);
    for (std::size_t c = 0; c < rest.face_vertices.size(); ++c) {
      const int v = mesh.face_vertices[c];
      int& known = vertex_of[static_cast<std::size_t>(rest.face_vertices[c])];
      if (known < 0) known = v;
      if (mesh.positions[static_cast<std::size_t>(known)] != mesh.positions[static_cast<std::size_t>(v)])
        fail(fmt::format("its vertex {} has corners of vertices {} and {}", rest.face_vertices[c] + 1,
                         known + 1, v + 1));
    }
  }

  Weave weave(const RestShape& rest) {
    Weave weave{own_.warp};
    if (weave.warp && own_.rest == RestSource::mesh && own_.rest_mesh.empty()) {
      // The direction refers to the mesh as modelled.
      weave.warp = placement(Vec3::Zero(), settings_.rotate, Vec3::Ones()) * *weave.warp;
    }
    const std::vector<int>& uvs = body_.mesh.corner_uvs;
    const bool textured = std::any_of(uvs.begin(), uvs.end(), [](int uv) { return uv >= 0; });
    if (textured) warn_of_bare_faces();
    if (!weave.warp && !textured) {
      weave.warp = rest.longest_side();
      const ShellMaterial& m = body_.material();
      if (m.membrane_warp != m.membrane_weft || m.warp_curve != m.weft_curve ||
          m.bending_warp != m.bending_weft || m.bending_warp_curve != m.bending_weft_curve) {
        say(fmt::format(
            "the mesh has no texture coordinates; its warp is taken along {}, its longest side; set "
            "`warp` to choose it",
            weave.warp->x() > 0   ? 'x'
            : weave.warp->y() > 0 ? 'y'
                                  : 'z'));
      }
    }
    return weave;
  }

  void make_shell(const RestShape& rest) {
    inputs_.progress.at(0.5, "shell");
    body_.sheet = true;
    body_.shell = build_shell(body_.mesh, rest, weave(rest));
    body_.uv_scale = rest.uv_scale;
    warn_of_other_scale();
    body_.woven_areas = body_.shell.areas;
    body_.woven_vertex_areas = body_.shell.vertex_areas;
    scale_rest(body_.shell, [this](std::span<const int> vertices) { return body_.rest_scale(vertices, 0); });
    if (body_.shell.odd_faces > 0) {
      say(fmt::format(
          "{} triangles stand across the warp, which has no direction there; unwrap the mesh or choose "
          "another `warp`",
          body_.shell.odd_faces));
    }
    warn_of_inverted_triangles(rest);
    warn_of_long_edges();
    warn_of_units();
    body_.skin = body_.source ? embed_source(*body_.source) : identity_embedding(body_.mesh.vertex_count());
    body_.vertex_count = static_cast<int>(body_.mesh.vertex_count());
    BodyStatistics& s = body_.statistics;
    s.vertices = body_.vertex_count;
    s.triangles = static_cast<std::int64_t>(body_.shell.triangles.size());
    s.hinges = static_cast<std::int64_t>(body_.shell.hinges.size());
  }

  /// `prefix` comes before the names of the numbers.
  void add_maps(const schema::Variations& variations, const schema::Table& keys,
                const std::string& prefix = "") {
    for (MappedNumber& map : read_maps(variations, keys, inputs_.files, body_)) {
      map.variation.key = prefix + map.variation.key;
      body_.maps.push_back(std::move(map));
    }
  }

  void vary_material() {
    for (FabricInUse& fabric : body_.fabrics) {
      fabric.maps = read_maps(fabric.numbers().variations, shell_material_table(), inputs_.files, body_);
      for (MappedNumber map : fabric.maps) {
        if (body_.has_several_fabrics()) map.variation.key = fabric.name + "." + map.variation.key;
        body_.maps.push_back(std::move(map));
      }
      check_maps(fabric);
    }
    if (body_.fabrics.front().maps.empty() && !body_.has_several_fabrics()) return;
    body_.triangle_materials = body_.materials_of_triangles(0);
    check_triangles(body_.triangle_materials, "");
    for (const FabricInUse& fabric : body_.fabrics)
      for (const double time : times_to_check(fabric.numbers().variations))
        check_triangles(body_.materials_of_triangles(time), fmt::format(" and {:.4g} s", time));
  }

  static void check_maps(const FabricInUse& fabric) {
    const ShellMaterial& material = fabric.numbers();
    if (!fabric.maps.empty() && (has_curves(material) || has_bending_curves(material)))
      throw Error(ErrorKind::input, fabric.maps.front().variation.place,
                  "maps and measured curves are in one material", "give moduli in place of the curves");
    for (const MappedNumber& map : fabric.maps) {
      const std::string& key = map.variation.key;
      const bool bends = key == "bending_warp" || key == "bending_weft" || key == "bending_bias";
      if ((material.yield_curvature && bends) || (material.yield_strain && key.starts_with("membrane_")))
        throw Error(ErrorKind::input, map.variation.place,
                    fmt::format("`{}` varies by a map in a material with `{}`", key,
                                bends ? "yield_curvature" : "yield_strain"),
                    "give a sheet that yields one number for it");
    }
  }

  /// `when` is for messages.
  void check_triangles(const std::vector<ShellMaterial>& materials, const std::string& when) const {
    for (std::size_t t = 0; t < materials.size(); ++t) {
      const FabricInUse& fabric = body_.fabrics[at(body_.triangle_fabrics[t])];
      const Place& place = fabric.maps.empty() ? fabric.place : fabric.maps.front().variation.place;
      shell_material_table().check(
          materials[t], schema::Subject(fmt::format("the material of body `{}` at polygon {}{}",
                                                    settings_.name, body_.shell.faces[t] + 1, when),
                                        place));
    }
  }

  /// Warns of polygons without texture, of which threads or the flat pattern are taken.
  void warn_of_bare_faces() {
    const std::size_t bare = faces_without_texture(body_.mesh).size();
    const bool flat = own_.rest == RestSource::uv;
    if (bare == 0 || (own_.warp && !flat)) return;
    std::string effect = flat ? "their stress-free shape is that of the mesh" : "";
    if (!own_.warp)
      effect += fmt::format("{}their threads continue those of their neighbours", flat ? ", and " : "");
    say(fmt::format("{} of {} polygons have no place in the texture; {}; unwrap them{}", bare,
                    body_.mesh.face_count(), effect, flat ? "" : ", or give `warp` a direction"));
  }

  /// Warns of patterns in other units than the mesh.
  void warn_of_other_scale() {
    const double ratio = std::sqrt(body_.shell.area / body_.report.area);
    if (ratio < largest_ratio && ratio > 1 / largest_ratio) return;
    say(fmt::format("its stress-free shape is {:.3g} times as long as the mesh; {}", ratio,
                    own_.rest == RestSource::uv ? "correct or leave out `uv_scale`"
                                                : "bring `rest_mesh` to the scale of the mesh"));
  }

  void warn_of_inverted_triangles(const RestShape& rest) {
    const std::vector<Vec3i> triangles =
        rest.triangles(triangle_corners(body_.mesh, triangulate(body_.mesh)));
    const std::vector<int> inverted = inverted_triangles(triangles, rest.positions);
    if (inverted.empty()) return;
    say(fmt::format(
        "{} turned over in the stress-free shape, the first in polygon {}; move {} back in the modeller",
        counted(inverted.size(), "triangle is", "triangles are"),
        body_.shell.faces[static_cast<std::size_t>(inverted.front())] + 1,
        inverted.size() == 1 ? "its vertex" : "their vertices"));
  }

  /// Warns where the membrane is what limits the length of edges: all coarse meshes miss folds, but then they
  /// hang too softly, as users expect.
  void warn_of_long_edges() {
    const TrustedEdge trusted = body_.shortest_trusted_edge();
    const double edge = body_.shell.mean_edge, size = body_.mesh.bounds().sizes().maxCoeff();
    if (trusted.unlocked >= trusted.resolved || edge <= trusted.unlocked || size < folding_size * edge)
      return;
    say(fmt::format(
        "its edges are {:.2g} m long on average; with elastic compression {} drapes too stiffly with "
        "more than {:.2g} m, because folds across edges strain the membrane; leave out `compression`, "
        "or refine the mesh",
        edge, body_.settings.material.name, trusted.unlocked));
  }

  /// Sizes beyond `largest_mesh` are mentioned with the mesh.
  void warn_of_units() {
    const double size = body_.mesh.bounds().sizes().maxCoeff();
    if (size > largest_cloth && size <= largest_mesh)
      say(fmt::format("it is {:.3g} m across; if its mesh is in centimetres, set `scale = 0.01`", size));
  }

  const BodySettings& settings_;
  const ShellBodySettings& own_;
  const ComponentInputs& inputs_;
  std::string file_;
  std::shared_ptr<ShellBody> built_ = std::make_shared<ShellBody>();
  ShellBody& body_ = *built_;
};

}  // namespace

std::shared_ptr<Component> build_shell_body(const BodySettings& settings, const ComponentInputs& inputs) {
  return ShellBuilder(settings, inputs).build();
}

}  // namespace muslin
