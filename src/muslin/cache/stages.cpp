#include "muslin/cache/stages.hpp"

#include <array>
#include <limits>

#include "muslin/cache/run_files.hpp"
#include "muslin/cache/vtk_file.hpp"
#include "muslin/core/output_file.hpp"
#include "muslin/field/signed_distance.hpp"
#include "muslin/io/mesh_file.hpp"
#include "muslin/scene/describe.hpp"

namespace muslin {
namespace {

/// Beyond this many samples only a band around the surface is computed exactly.
constexpr std::size_t full_field_samples = 1'000'000;

DistanceField field_around(const Body& body, const Progress& progress) {
  Grid grid;
  grid.width = body.lattice.width;
  grid.origin = body.lattice.origin - Vec3::Constant(grid.width);
  grid.samples = body.lattice.extent + Vec3i::Constant(3);
  const double band =
      grid.size() > full_field_samples ? 4 * grid.width : std::numeric_limits<double>::infinity();
  return sample_field(SignedDistance(body.solid), grid, band, progress);
}

VtkGrid voxels(const Lattice& lattice, std::vector<double> points) {
  VtkGrid grid;
  grid.points = std::move(points);
  for (const auto& voxel : lattice.voxel_vertices) grid.add_voxel(voxel);
  grid.cell_data.push_back({"fill", 1, lattice.fill});
  return grid;
}

VtkGrid tetrahedra(const Lattice& lattice, std::vector<double> points) {
  VtkGrid grid;
  grid.points = std::move(points);
  for (const auto& tetrahedron : build_tetrahedra(lattice)) {
    const std::array<std::int64_t, 4> corners = {tetrahedron[0], tetrahedron[1], tetrahedron[2],
                                                 tetrahedron[3]};
    grid.add_cell(VtkCell::tetrahedron, corners.data(), 4);
  }
  return grid;
}

VtkGrid spring_lines(const Springs& springs, std::vector<double> points) {
  VtkGrid grid;
  grid.points = std::move(points);
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

/// Writes the triangles with the direction of their warp.
VtkGrid triangles(const Body& body, std::vector<double> points) {
  VtkGrid grid;
  grid.points = std::move(points);
  std::vector<double> warps;
  for (std::size_t t = 0; t < body.shell.triangles.size(); ++t) {
    const Vec3i& v = body.shell.triangles[t];
    const std::array<std::int64_t, 3> corners = {v[0], v[1], v[2]};
    grid.add_cell(VtkCell::triangle, corners.data(), 3);
    const auto x = [&](int c) { return body.mesh.positions[static_cast<std::size_t>(v[c])]; };
    const Mat2& inverse = body.shell.inverses[t];
    const Vec3 warp = (x(1) - x(0)) * inverse(0, 0) + (x(2) - x(0)) * inverse(1, 0);
    warps.insert(warps.end(), warp.data(), warp.data() + 3);
  }
  grid.cell_data.push_back({"warp", 3, std::move(warps)});
  grid.cell_data.push_back({"rest_area", 1, body.shell.areas});
  return grid;
}

}  // namespace

void write_stages(const std::filesystem::path& directory, const Model& model, const Progress& progress) {
  make_directory(directory);
  for (const Body& body : model.bodies) {
    body_files(body.name);  // rejects invalid file names
    const auto at = [&](const char* stage) { return directory / (body.name + "." + stage); };
    const std::vector<double> rest = flat(model.of(body, model.rest_positions));
    if (body.is_shell()) write_vtu(at("shell.vtu"), triangles(body, rest));
    if (!body.has_lattice()) {
      write_mesh(at("skin.obj"), body.mesh);
      continue;
    }
    write_vti(at("field.vti"), field_around(body, progress));
    write_vtu(at("voxels.vtu"), voxels(body.lattice, rest));
    write_vtu(at("tets.vtu"), tetrahedra(body.lattice, rest));
    write_vtu(at("springs.vtu"), spring_lines(body.springs, rest));
    write_mesh(at("skin.obj"), body.mesh);
    write_mesh(at("solid.obj"), body.solid);
    write_mesh(at("contour.obj"), body.contour.mesh);
  }
  write_atomically(directory / "stats.json", statistics_json(model));
}

}  // namespace muslin
