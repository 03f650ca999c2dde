#include "muslin/scene/build_body.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "muslin/field/signed_distance.hpp"
#include "muslin/geometry/thicken.hpp"
#include "muslin/scene/placement.hpp"
#include "muslin/scene/solid.hpp"

namespace muslin {
namespace {

// Above this the run is long and takes several GiB; the user is warned.
constexpr std::size_t many_voxels = 2'000'000;

/// Calls build(); its errors get the place in the scene and the mesh file.
template <class Build>
auto at_place(const Place& place, const std::string& file, const Build& build) -> decltype(build()) {
  try {
    return build();
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::interrupted) throw;
    std::string where = file;
    if (error.place().line > 0) where += fmt::format(":{}", error.place().line);
    if (error.place().line > 0 && error.place().column > 0) where += fmt::format(":{}", error.place().column);
    throw Error(error.kind(), place, where + ": " + error.problem(), error.remedy());
  }
}

class BodyBuilder {
 public:
  BodyBuilder(const Scene& scene, const BodySettings& settings, std::vector<std::string>& warnings)
      : scene_(scene),
        settings_(settings),
        file_(resolve_path(scene, settings.mesh)),
        rest_file_(resolve_path(scene, settings.rest_mesh)),
        warnings_(warnings) {}

  Body build(const Progress& progress) {
    body_.name = settings_.name;
    body_.model = settings_.model;
    progress.at(0.0, "mesh");
    at_place(settings_.mesh_place, file_.string(), [&] { read(); });
    if (settings_.model == BodyModel::shell) {
      const Mesh rest = rest_mesh();
      at_place(settings_.mesh_place, file_.string(), [&] { make_shell(rest, progress); });
    } else {
      make_solid();
      at_place(settings_.place, file_.string(), [&] { fill(progress); });
    }
    return std::move(body_);
  }

 private:
  void say(const std::string& sentence) {
    warnings_.push_back(fmt::format("body {}: {}", settings_.name, sentence));
  }

  void read() {
    MeshFile mesh_file = scene_mesh(scene_, settings_.mesh);
    if (!mesh_file.note.empty()) say(mesh_file.note);
    body_.mesh = std::move(mesh_file.mesh);
    const auto place = placement(settings_.translate, settings_.rotate, settings_.scale);
    for (Vec3& x : body_.mesh.positions) x = place * x;
    require_usable(body_.mesh, file_.string());
    body_.report = inspect(body_.mesh);
    for (const std::string& warning : body_.report.warnings) say(warning);
  }

  /// The stress-free shape: the mesh as it was modelled (scaled, not turned), or another of the same
  /// polygons.
  Mesh rest_mesh() {
    if (settings_.rest_mesh.empty()) return body_.mesh;
    return at_place(settings_.rest_mesh_place, rest_file_.string(), [&] {
      Mesh rest = scene_mesh(scene_, settings_.rest_mesh).mesh;
      require_usable(rest, rest_file_.string());
      if (rest.vertex_count() != body_.mesh.vertex_count() || rest.face_offsets != body_.mesh.face_offsets ||
          rest.face_vertices != body_.mesh.face_vertices) {
        throw Error(
            ErrorKind::input,
            fmt::format("its polygons are not those of {} ({} vertices and {} polygons against {} and {})",
                        file_.string(), rest.vertex_count(), rest.face_count(), body_.mesh.vertex_count(),
                        body_.mesh.face_count()),
            "make the rest mesh by moving the vertices of a copy");
      }
      for (Vec3& x : rest.positions) x = settings_.scale.cwiseProduct(x);
      return rest;
    });
  }

  void make_shell(const Mesh& rest, const Progress& progress) {
    progress.at(0.5, "shell");
    Weave weave{settings_.warp};
    if (weave.warp && settings_.rest_mesh.empty()) {
      // The direction refers to the mesh as modelled.
      weave.warp = placement(Vec3::Zero(), settings_.rotate, Vec3::Ones()) * *weave.warp;
    }
    const bool textured = !body_.mesh.corner_uvs.empty() &&
                          *std::min_element(body_.mesh.corner_uvs.begin(), body_.mesh.corner_uvs.end()) >= 0;
    if (!weave.warp && !textured) {
      int axis;
      rest.bounds().sizes().maxCoeff(&axis);
      weave.warp = Vec3::Unit(axis);
      const ShellMaterial& m = *settings_.material.shell;
      if (m.membrane_warp != m.membrane_weft || m.bending_warp != m.bending_weft) {
        say(fmt::format(
            "the mesh has no texture coordinates; its warp is taken along {}, its longest side; set "
            "`warp` to choose it",
            "xyz"[axis]));
      }
    }
    body_.sheet = true;
    body_.shell = build_shell(body_.mesh, rest.positions, weave);
    if (body_.shell.odd_faces > 0) {
      say(fmt::format(
          "{} triangles stand across the warp, which has no direction there; unwrap the mesh or choose "
          "another `warp`",
          body_.shell.odd_faces));
    }
    body_.skin = identity_embedding(body_.mesh.vertex_count());
    body_.vertex_count = static_cast<int>(body_.mesh.vertex_count());
    BodyStatistics& s = body_.statistics;
    s.vertices = body_.vertex_count;
    s.triangles = static_cast<std::int64_t>(body_.shell.triangles.size());
    s.hinges = static_cast<std::int64_t>(body_.shell.hinges.size());
  }

  void make_solid() {
    MeshKind kind = kind_of(body_.mesh, body_.report);
    if (kind == MeshKind::holed_solid && settings_.thickness) kind = MeshKind::sheet;
    body_.sheet = kind == MeshKind::sheet;
    if (body_.sheet) {
      body_.thickness = settings_.thickness.value_or(settings_.lattice.width);
      body_.solid = thicken(body_.mesh, body_.thickness);
      if (!settings_.thickness) {
        say(
            fmt::format("the mesh is a sheet; its thickness is taken as one voxel width, {} m; set "
                        "`thickness` to choose it",
                        body_.thickness));
      }
      return;
    }
    if (settings_.thickness) say("the mesh is closed, so `thickness` has no effect");
    if (kind == MeshKind::holed_solid) {
      say(fmt::format(
          "the mesh has {} open edges around small holes and is filled as a solid; set `thickness` "
          "if it is meant as a shell",
          body_.report.open_edges));
    }
    body_.solid = body_.report.volume < 0 ? flipped(body_.mesh) : body_.mesh;
  }

  void fill(const Progress& progress) {
    progress.at(0.1, "distance field");
    const SignedDistance distance(body_.solid);
    progress.at(0.2, "voxels");
    body_.lattice = build_lattice(body_.solid, distance, settings_.lattice, part_of(progress, 0.2, 0.7));
    progress.at(0.7, "springs");
    const std::vector<double> fill = body_.lattice.fill;
    body_.lattice.fill = voxel_shares(body_, settings_);
    body_.springs = build_springs(body_.lattice, settings_.bracing);
    body_.lattice.fill = fill;
    progress.at(0.8, "skin");
    body_.skin = embed(body_.lattice, body_.mesh.positions);
    progress.at(0.9, "contour");
    const bool one_layer = body_.lattice.extent.minCoeff() == 1;
    body_.contour = build_contour(body_.lattice, body_.solid, distance,
                                  one_layer ? ContourMethod::squares : ContourMethod::cubes);
    body_.vertex_count = static_cast<int>(body_.lattice.vertex_count());
    count();
    advise();
  }

  void count() {
    BodyStatistics& s = body_.statistics;
    s.vertices = static_cast<std::int64_t>(body_.lattice.vertex_count());
    s.voxels = static_cast<std::int64_t>(body_.lattice.voxel_count());
    s.tetrahedra = 6 * s.voxels;
    s.springs = body_.springs.count_by_kind;
    s.coverage = body_.lattice.coverage;
    s.contour_distance = body_.contour.distance;
  }

  void advise() {
    const double width = settings_.lattice.width;
    if (body_.lattice.coverage < 1 - 1e-6) {
      say(
          fmt::format("{:.3g} % of its surface lies outside the voxels; use `voxels = \"cover\"` or a higher "
                      "`threshold`",
                      100 * (1 - body_.lattice.coverage)));
    }
    if (body_.contour.mesh.face_count() == 0)
      say("it is too small for its voxels to have a contour; use a smaller `voxel_width`");
    if (body_.sheet && body_.thickness > 4 * width) {
      say(
          fmt::format("the sheet is {:.3g} voxels thick; a larger `voxel_width` or a smaller `thickness` is "
                      "cheaper",
                      body_.thickness / width));
    }
    if (body_.lattice.voxel_count() > many_voxels) {
      say(fmt::format("{} voxels take long and several GiB of memory; a larger `voxel_width` takes less",
                      body_.lattice.voxel_count()));
    }
  }

  static Progress part_of(const Progress& whole, double begin, double end) {
    Progress part;
    part.cancelled = whole.cancelled;
    if (whole.report) {
      part.report = [&whole, begin, end](double fraction, std::string_view stage) {
        whole.report(begin + fraction * (end - begin), stage);
      };
    }
    return part;
  }

  const Scene& scene_;
  const BodySettings& settings_;
  std::filesystem::path file_, rest_file_;
  std::vector<std::string>& warnings_;
  Body body_;
};

}  // namespace

Body build_body(const Scene& scene, const BodySettings& settings, std::vector<std::string>& warnings,
                const Progress& progress) {
  return BodyBuilder(scene, settings, warnings).build(progress);
}

Embedding identity_embedding(std::size_t count) {
  Embedding embedding;
  for (std::size_t v = 0; v < count; ++v) {
    embedding.vertices.emplace_back().fill(static_cast<int>(v));
    embedding.weights.push_back({1});
  }
  embedding.prepare_transpose(count);
  return embedding;
}

std::vector<double> voxel_shares(const Body& body, const BodySettings& settings) {
  if (settings.mass == BodySettings::Mass::solid) return body.lattice.fill;
  return std::vector<double>(body.lattice.voxel_count(), 1.0);
}

std::vector<double> vertex_masses(const Body& body, const BodySettings& settings) {
  if (body.is_shell()) {
    std::vector<double> masses = body.shell.vertex_areas;
    for (double& m : masses) m *= settings.material.shell->areal_density;
    return masses;
  }
  const Lattice& lattice = body.lattice;
  const std::vector<double> shares = voxel_shares(body, settings);
  const double corner = settings.material.density * lattice.width * lattice.width * lattice.width / 8;
  std::vector<double> masses(lattice.vertex_count(), 0.0);
  for (std::size_t c = 0; c < lattice.voxel_count(); ++c) {
    for (const int v : lattice.voxel_vertices[c]) masses[static_cast<std::size_t>(v)] += corner * shares[c];
  }
  return masses;
}

std::vector<float> spring_weights(const Body& body, const BodySettings& settings) {
  if (settings.boundary_springs == BodySettings::BoundarySprings::shared) return body.springs.share;
  if (settings.mass == BodySettings::Mass::solid) return body.springs.mean_fill;
  return {};
}

}  // namespace muslin
