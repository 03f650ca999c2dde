// The field is sampled in cubes of a few samples a side, each visited along a path from neighbour to
// neighbour: the last triangle found is the hint for the next, and the sign is propagated where possible.
#include <algorithm>
#include <cmath>
#include <limits>

#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/field/signed_distance.hpp"

namespace muslin {
namespace {

constexpr int cube_side = 8;
constexpr std::size_t cubes_between_reports = 512;

// Rounding in distances and positions must not propagate a sign across the surface.
constexpr double safety = 1 + 1e-6;

class Sampler {
 public:
  Sampler(const SignedDistance& distance, DistanceField& field)
      : distance_(distance), field_(field), grid_(field.grid), reach_(std::max(field.band, grid_.width)) {}

  void sample_cube(const Vec3i& low, const Vec3i& high) const {
    const Vec3 first = grid_.position(low.x(), low.y(), low.z());
    const Vec3 last = grid_.position(high.x() - 1, high.y() - 1, high.z() - 1);
    const Vec3 centre = 0.5 * (first + last);
    const double radius = 0.5 * (last - first).norm() * safety;
    const SurfacePoint middle = distance_.nearest(centre, radius + reach_);
    const bool uniform = distance_.watertight() && !(middle.distance <= radius);  // no surface within
    if (uniform && middle.triangle < 0) {
      fill(low, high, signed_by(distance_.inside(centre), field_.band));
      return;
    }
    bool inside = distance_.inside(centre);
    // There is no surface within `clear` of the last sample; negative if unknown.
    double clear =
        uniform ? std::numeric_limits<double>::infinity() : -std::numeric_limits<double>::infinity();
    SurfacePoint last_found = middle;
    double step = radius;
    bool x_forward = true, y_forward = true;
    for (int k = low.z(); k < high.z(); ++k) {
      for (int row = 0; row < high.y() - low.y(); ++row) {
        const int j = y_forward ? low.y() + row : high.y() - 1 - row;
        for (int column = 0; column < high.x() - low.x(); ++column) {
          const int i = x_forward ? low.x() + column : high.x() - 1 - column;
          const Vec3 point = grid_.position(i, j, k);
          const double limit = std::min(reach_, (last_found.distance + step) * safety);
          const SurfacePoint found = distance_.nearest(point, limit, last_found.triangle);
          const double free = found.triangle < 0 ? reach_ : found.distance;
          if (!distance_.watertight() || !(clear + free > grid_.width * safety))
            inside = distance_.inside(point);
          if (!uniform) clear = free;
          const double magnitude = std::min(free, field_.band);
          field_.values[grid_.index(i, j, k)] = signed_by(inside && magnitude > 0, magnitude);
          last_found = found;
          step = grid_.width;
        }
        x_forward = !x_forward;
      }
      y_forward = !y_forward;
    }
  }

 private:
  static float signed_by(bool inside, double magnitude) {
    return static_cast<float>(inside ? -magnitude : magnitude);
  }

  void fill(const Vec3i& low, const Vec3i& high, float value) const {
    for (int k = low.z(); k < high.z(); ++k)
      for (int j = low.y(); j < high.y(); ++j)
        std::fill_n(field_.values.begin() + static_cast<std::ptrdiff_t>(grid_.index(low.x(), j, k)),
                    high.x() - low.x(), value);
  }

  const SignedDistance& distance_;
  DistanceField& field_;
  const Grid& grid_;
  double reach_;  // search distance for triangles: at least a step, so that signs propagate
};

}  // namespace

DistanceField sample_field(const SignedDistance& distance, const Grid& grid, double band,
                           const Progress& progress) {
  if (!(grid.width > 0) || !std::isfinite(grid.width) || !grid.origin.allFinite() ||
      grid.samples.minCoeff() < 0)
    throw Error(ErrorKind::usage, "the grid of a distance field is invalid",
                "give it a finite origin, a positive width and sample counts that are not negative");
  if (!(band >= 0))
    throw Error(ErrorKind::usage, "the band of a distance field is negative", "give 0 or more");
  DistanceField field{grid, band, std::vector<float>(grid.size())};
  const Vec3i cubes = (grid.samples.array() + (cube_side - 1)) / cube_side;
  const std::size_t count = Grid{grid.origin, grid.width, cubes}.size();
  const Sampler sampler(distance, field);
  for (std::size_t done = 0; done < count; done += cubes_between_reports) {
    progress.at(static_cast<double>(done) / static_cast<double>(count), "distance field");
    parallel_for(std::min(cubes_between_reports, count - done), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t cube = done + begin; cube < done + end; ++cube) {
        const auto nx = static_cast<std::size_t>(cubes.x()), ny = static_cast<std::size_t>(cubes.y());
        const Vec3i at(static_cast<int>(cube % nx), static_cast<int>(cube / nx % ny),
                       static_cast<int>(cube / nx / ny));
        const Vec3i low = cube_side * at;
        const Vec3i high = (low.array() + cube_side).min(grid.samples.array());
        sampler.sample_cube(low, high);
      }
    });
  }
  progress.at(1, "distance field");
  return field;
}

}  // namespace muslin
