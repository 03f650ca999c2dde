#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "muslin/cache/export_formats.hpp"
#include "muslin/io/vtk_file.hpp"

namespace muslin {
namespace {

/// Returns the largest principal stretch of a voxel: the largest singular value of the deformation gradient
/// at its centre, 1 at rest. Columns of the gradient are means over the voxel's four edges along an axis.
float principal_stretch(const std::array<int, 8>& corners, const std::vector<Vec3>& rest,
                        const std::vector<Vec3f>& points) {
  Mat3 deformed = Mat3::Zero();
  Vec3 lengths = Vec3::Zero();
  for (unsigned c = 0; c < 8; ++c) {
    for (int axis = 0; axis < 3; ++axis) {
      const double sign = (c >> axis & 1U) != 0 ? 0.25 : -0.25;
      const auto v = static_cast<std::size_t>(corners[c]);
      deformed.col(axis) += sign * points[v].cast<double>();
      lengths[axis] += sign * rest[v][axis];
    }
  }
  const Mat3 gradient = deformed * lengths.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Mat3> squares(gradient.transpose() * gradient, Eigen::EigenvaluesOnly);
  return static_cast<float>(std::sqrt(std::max(0.0, squares.eigenvalues()[2])));
}

/// Returns the largest principal stretch of a triangle against the first frame.
float principal_stretch(const Vec3i& triangle, const std::vector<Vec3f>& rest,
                        const std::vector<Vec3f>& points) {
  const auto edge = [&](const std::vector<Vec3f>& x, int c) -> Vec3 {
    return (x[static_cast<std::size_t>(triangle[c])] - x[static_cast<std::size_t>(triangle[0])])
        .cast<double>();
  };
  const Vec3 u = edge(rest, 1).normalized();
  const Vec3 v = (edge(rest, 2) - edge(rest, 2).dot(u) * u).normalized();
  Eigen::Matrix2d flat;
  flat << edge(rest, 1).dot(u), edge(rest, 2).dot(u), 0, edge(rest, 2).dot(v);
  Eigen::Matrix<double, 3, 2> edges;
  edges << edge(points, 1), edge(points, 2);
  const Eigen::Matrix<double, 3, 2> gradient = edges * flat.inverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> squares(gradient.transpose() * gradient,
                                                               Eigen::EigenvaluesOnly);
  return static_cast<float>(std::sqrt(std::max(0.0, squares.eigenvalues()[1])));
}

/// The cells of a body's grid: its voxels, or else the triangles of its skin.
struct Cells {
  VtkGrid grid;
  std::function<std::vector<Vec3f>(int)> points, velocities;  ///< at a frame
  std::function<float(std::size_t, const std::vector<Vec3f>&)> stretch;
  std::vector<Vec3> rest;
};

Cells cells_of(const RunReader& run, int body) {
  Cells cells;
  if (!run.has_cells(body)) {
    const auto triangles = std::make_shared<Triangulation>(triangulate(run.mesh(body, SurfaceKind::skin)));
    for (const Vec3i& t : triangles->triangles) {
      const std::array<std::int64_t, 3> corners = {t[0], t[1], t[2]};
      cells.grid.add_cell(VtkCell::triangle, corners.data(), 3);
    }
    cells.points = [&run, body](int frame) { return run.points(body, SurfaceKind::skin, frame); };
    cells.velocities = [&run, body](int frame) { return run.velocities(body, SurfaceKind::skin, frame); };
    const std::vector<Vec3f> rest = cells.points(0);
    for (const Vec3f& x : rest) cells.rest.push_back(x.cast<double>());
    cells.stretch = [triangles, rest](std::size_t cell, const std::vector<Vec3f>& points) {
      return principal_stretch(triangles->triangles[cell], rest, points);
    };
    return cells;
  }
  const RunReader::Cells& shape = run.cells(body);
  for (const auto& voxel : shape.voxels) cells.grid.add_voxel(voxel);
  cells.points = [&run, body](int frame) { return run.selectable_points(body, frame); };
  cells.velocities = [&run, body](int frame) { return run.selectable_velocities(body, frame); };
  cells.rest = shape.rest_positions;
  cells.stretch = [&shape](std::size_t cell, const std::vector<Vec3f>& points) {
    return principal_stretch(shape.voxels[cell], shape.rest_positions, points);
  };
  return cells;
}

}  // namespace

void export_vtu(const RunReader& run, const std::filesystem::path& file, int body, const Progress& progress) {
  Cells cells = cells_of(run, body);
  std::vector<std::pair<double, std::string>> steps;
  for (int frame = 0; frame < run.frame_count(); ++frame) {
    progress.at(static_cast<double>(frame) / run.frame_count(), "export");
    const std::vector<Vec3f> points = cells.points(frame);
    std::vector<Vec3f> displacement(points.size());
    for (std::size_t v = 0; v < points.size(); ++v)
      displacement[v] = (points[v].cast<double>() - cells.rest[v]).cast<float>();
    std::vector<float> stretch(cells.grid.types.size());
    for (std::size_t c = 0; c < stretch.size(); ++c) stretch[c] = cells.stretch(c, points);
    cells.grid.points = flat(points);
    cells.grid.point_data = {{"displacement", 3, flat(displacement)},
                             {"velocity", 3, flat(cells.velocities(frame))}};
    cells.grid.cell_data = {{"stretch", 1, std::move(stretch)}};
    const std::filesystem::path name = numbered(file, frame);
    write_vtu(name, cells.grid);
    steps.emplace_back(frame / run.frame_rate(), name.filename().string());
  }
  std::filesystem::path collection = file;
  collection.replace_extension(".pvd");
  write_pvd(collection, steps);
}

}  // namespace muslin
