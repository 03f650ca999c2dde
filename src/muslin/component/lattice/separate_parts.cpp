#include "muslin/component/lattice/separate_parts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "muslin/component/lattice/solids.hpp"
#include "muslin/core/index.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

constexpr std::size_t point_grain = 256;
/// Voxels between two slabs at least, besides those that a threshold adds around a solid.
constexpr double least_gap = 3;

}  // namespace

SeparateParts::SeparateParts(const Mesh& solid, const LatticeSettings& settings) {
  const std::vector<int> solids = solids_of(solid);
  std::map<int, Box> boxes;
  for (const int v : solid.face_vertices) boxes[solids[at(v)]].extend(solid.positions[at(v)]);
  if (boxes.size() < 2) return;
  solid.bounds().sizes().maxCoeff(&axis_);
  const double width = settings.width;
  const double widened = settings.rule == VoxelRule::threshold ? std::max(0.0, settings.threshold) : 0;
  const double gap = (least_gap + 2 * std::ceil(widened)) * width;
  double end = -std::numeric_limits<double>::infinity();
  std::map<int, int> places;
  for (const auto& [first, box] : boxes) {
    Vec3 offset = Vec3::Zero();
    if (!offsets_.empty()) offset[axis_] = width * std::ceil((end + gap - box.min()[axis_]) / width);
    places[first] = static_cast<int>(offsets_.size());
    offsets_.push_back(offset);
    begins_.push_back(box.min()[axis_] + offset[axis_] - gap / 2);
    end = box.max()[axis_] + offset[axis_];
  }
  of_vertex_.assign(solid.vertex_count(), 0);
  for (const int v : solid.face_vertices) of_vertex_[at(v)] = places.at(solids[at(v)]);
  const std::vector<Vec3i> triangles = triangulate(solid).triangles;
  of_triangle_.reserve(triangles.size());
  for (const Vec3i& t : triangles) of_triangle_.push_back(of_vertex_[at(t[0])]);
  surface_.emplace(solid.positions, triangles);
}

Mesh SeparateParts::in_grid(Mesh solid) const {
  if (empty()) return solid;
  for (std::size_t v = 0; v < solid.vertex_count(); ++v) solid.positions[v] += offsets_[at(of_vertex_[v])];
  return solid;
}

std::vector<Vec3> SeparateParts::in_grid(ConstVectors points) const {
  std::vector<Vec3> moved(points.begin(), points.end());
  if (empty()) return moved;
  parallel_for(moved.size(), point_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      moved[p] += offsets_[at(of_triangle_[at((*surface_)(points[p]).triangle)])];
  });
  return moved;
}

std::vector<LatticeSlab> SeparateParts::slabs(const Lattice& lattice) const {
  std::vector<LatticeSlab> slabs;
  slabs.reserve(offsets_.size());
  for (std::size_t s = 0; s < offsets_.size(); ++s)
    slabs.push_back({axis_, static_cast<int>(std::ceil((begins_[s] - lattice.origin[axis_]) / lattice.width)),
                     offsets_[s]});
  return slabs;
}

}  // namespace muslin
