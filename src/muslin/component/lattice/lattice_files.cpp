// The files and descriptions of a lattice body.
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "muslin/component/description.hpp"
#include "muslin/component/lattice/lattice_body.hpp"
#include "muslin/component/lattice/lattice_kind.hpp"
#include "muslin/core/counted.hpp"
#include "muslin/field/signed_distance.hpp"
#include "muslin/io/mesh_file.hpp"
#include "muslin/io/vtk_file.hpp"

namespace muslin {
namespace {

/// Beyond this many samples only a band around the surface is computed exactly.
constexpr std::size_t full_field_samples = 1'000'000;

VtkImage field_around(const Lattice& lattice, const Mesh& solid, const Progress& progress) {
  Grid grid;
  grid.width = lattice.width;
  grid.origin = lattice.origin - Vec3::Constant(grid.width);
  grid.samples = lattice.extent + Vec3i::Constant(3);
  if (!lattice.slabs.empty()) {
    const Box bounds = solid.bounds();
    grid.origin = bounds.min() - Vec3::Constant(grid.width);
    grid.samples = (bounds.sizes() / grid.width).array().ceil().cast<int>() + 3;
  }
  const double band =
      grid.size() > full_field_samples ? 4 * grid.width : std::numeric_limits<double>::infinity();
  DistanceField field = sample_field(SignedDistance(solid), grid, band, progress);
  return {grid.origin, grid.width, grid.samples, "distance", std::move(field.values)};
}

VtkGrid grid_of(const Lattice& lattice) {
  std::vector<Vec3> rest(lattice.vertex_count());
  for (std::size_t v = 0; v < rest.size(); ++v) rest[v] = lattice.rest_position(v);
  VtkGrid grid;
  grid.points = flat(ConstVectors(rest));
  return grid;
}

VtkGrid voxels(const Lattice& lattice) {
  VtkGrid grid = grid_of(lattice);
  for (const auto& voxel : lattice.voxel_vertices) grid.add_voxel(voxel);
  return grid;
}

VtkGrid tetrahedra(const Lattice& lattice) {
  VtkGrid grid = grid_of(lattice);
  for (const auto& tetrahedron : build_tetrahedra(lattice)) {
    const std::array<std::int64_t, 4> corners = {tetrahedron[0], tetrahedron[1], tetrahedron[2],
                                                 tetrahedron[3]};
    grid.add_cell(VtkCell::tetrahedron, corners.data(), 4);
  }
  return grid;
}

VtkGrid spring_lines(const Springs& springs, const Lattice& lattice) {
  VtkGrid grid = grid_of(lattice);
  std::vector<std::uint8_t> kinds;
  for (const SpringRun& run : springs.runs) {
    for (int i = 0; i < run.length; ++i) {
      const std::array<std::int64_t, 2> ends = {run.a + i, run.b + i};
      grid.add_cell(VtkCell::line, ends.data(), 2);
      kinds.push_back(
          static_cast<std::uint8_t>(springs.directions[static_cast<std::size_t>(run.direction)].kind));
    }
  }
  grid.cell_data.push_back({"kind", 1, std::move(kinds)});
  return grid;
}

const char* name_of(ContourMethod method) { return method == ContourMethod::squares ? "squares" : "cubes"; }

}  // namespace

std::vector<CachedPoints> LatticeBody::cached_points() const {
  return {{"contour", "obj", [this](const std::filesystem::path& file) { write_mesh(file, contour.mesh); },
           &contour.embedding},
          {"lattice", "vtu", [this](const std::filesystem::path& file) { write_vtu(file, voxels(lattice)); },
           nullptr}};
}

void LatticeBody::write_stages(const std::filesystem::path& folder, const Progress& progress) const {
  const auto at = [&](const char* stage) { return folder / fmt::format("{}.{}", name, stage); };
  write_vti(at("field.vti"), field_around(lattice, solid, progress));
  VtkGrid filled = voxels(lattice);
  filled.cell_data.push_back({"fill", 1, lattice.fill});
  write_vtu(at("voxels.vtu"), filled);
  write_vtu(at("tets.vtu"), tetrahedra(lattice));
  write_vtu(at("springs.vtu"), spring_lines(springs, lattice));
  write_mesh(at("skin.obj"), skin_mesh());
  write_mesh(at("solid.obj"), solid);
  write_mesh(at("contour.obj"), contour.mesh);
}

std::string LatticeBody::description_json() const {
  const BodyStatistics& s = statistics;
  nlohmann::ordered_json json;
  json["name"] = name;
  json["mesh"] = settings.mesh;
  json["model"] = kind();
  json["kind"] = sheet ? "sheet" : "solid";
  if (sheet) json["thickness"] = thickness;
  json["voxel_width"] = lattice.width;
  json["extent"] = {lattice.extent.x(), lattice.extent.y(), lattice.extent.z()};
  if (!separate.empty()) json["separate_parts"] = separate.count();
  json["material"] = settings.material.name;
  append_counts(json, s);
  json["contour"] = name_of(contour.method);
  json["contour_distance"] = s.contour_distance;
  append_stable_step(json, s);
  return to_line(json);
}

std::string LatticeBody::description() const {
  const BodyStatistics& s = statistics;
  const Vec3i& n = lattice.extent;
  const std::string nature = sheet ? fmt::format("sheet, {:.4g} m thick", thickness) : "solid";
  std::string text = fmt::format("body {}: {} ({}, {})\n", name, settings.mesh,
                                 counted(mesh.face_count(), "polygon"), nature);
  text += fmt::format("  voxels      {} of {:.6g} m in {} x {} x {}, {:.4g} % of the surface covered\n",
                      s.voxels, lattice.width, n.x(), n.y(), n.z(), 100 * s.coverage);
  if (!separate.empty()) text += fmt::format("  parts       {}, kept apart\n", separate.count());
  text += fmt::format("  lattice     {} vertices, {} tetrahedra\n", s.vertices, s.tetrahedra);
  text += fmt::format("  springs     {} edge, {} face diagonal, {} body diagonal ({})\n", s.springs[0],
                      s.springs[1], s.springs[2], bracing_names()[static_cast<std::size_t>(own().bracing)]);
  text += fmt::format("  mass        {:.6g} kg of {}\n", s.mass, settings.material.name);
  text += fmt::format("  contour     marching {}, at most {:.3g} m from the mesh\n", name_of(contour.method),
                      s.contour_distance);
  return text;
}

}  // namespace muslin
