#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "muslin/cache/export_formats.hpp"
#include "muslin/cache/vtk_file.hpp"

namespace muslin {
namespace {

/// Largest principal stretch of a voxel: the largest singular value of the deformation gradient at its
/// centre, 1 at rest. Columns of the gradient are means over the voxel's four edges along an axis.
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

}  // namespace

void export_vtu(const RunReader& run, const std::filesystem::path& file, int body, const Progress& progress) {
  const RunReader::LatticeShape& shape = run.lattice(body);
  std::vector<std::pair<double, std::string>> steps;
  VtkGrid grid;
  for (const auto& voxel : shape.voxels) grid.add_voxel(voxel);
  for (int frame = 0; frame < run.frame_count(); ++frame) {
    progress.at(static_cast<double>(frame) / run.frame_count(), "export");
    const std::vector<Vec3f> points = run.lattice_points(body, frame);
    std::vector<Vec3f> displacement(points.size());
    for (std::size_t v = 0; v < points.size(); ++v)
      displacement[v] = (points[v].cast<double>() - shape.rest_positions[v]).cast<float>();
    std::vector<float> stretch;
    for (const auto& voxel : shape.voxels)
      stretch.push_back(principal_stretch(voxel, shape.rest_positions, points));
    grid.points = flat(points);
    grid.point_data = {{"displacement", 3, flat(displacement)},
                       {"velocity", 3, flat(run.lattice_velocities(body, frame))}};
    grid.cell_data = {{"stretch", 1, std::move(stretch)}};
    const std::filesystem::path name = numbered(file, frame);
    write_vtu(name, grid);
    steps.emplace_back(frame / run.frame_rate(), name.filename().string());
  }
  std::filesystem::path collection = file;
  collection.replace_extension(".pvd");
  write_pvd(collection, steps);
}

}  // namespace muslin
