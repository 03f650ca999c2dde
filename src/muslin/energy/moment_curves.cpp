#include "muslin/energy/moment_curves.hpp"

#include <cmath>
#include <utility>

#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

constexpr std::size_t block = 1024;

}  // namespace

MomentCurves::MomentCurves(PlateCurvatures curvatures, std::vector<double> areas, const StressCurve& warp,
                           const StressCurve& weft)
    : curvatures_(std::move(curvatures)), areas_(std::move(areas)), warp_(warp), weft_(weft) {}

double MomentCurves::energy(std::span<const double> bent) const {
  return parallel_sum(areas_.size(), block, 0.0, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t t = begin; t < end; ++t) {
      const Vec2 bend = curvatures_.of(t, bent);
      sum += areas_[t] * (warp_.at(std::abs(bend[0])).energy + weft_.at(std::abs(bend[1])).energy);
    }
    return sum;
  });
}

double MomentCurves::add_moments(std::span<const double> bent, std::span<double> moments) const {
  std::vector<Vec2> of_triangle(areas_.size());
  const double energy = parallel_sum(areas_.size(), block, 0.0, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t t = begin; t < end; ++t) {
      const Vec2 bend = curvatures_.of(t, bent);
      const StressCurve::State u = warp_.at(std::abs(bend[0])), v = weft_.at(std::abs(bend[1]));
      sum += areas_[t] * (u.energy + v.energy);
      of_triangle[t] = areas_[t] * Vec2(std::copysign(u.stress, bend[0]), std::copysign(v.stress, bend[1]));
    }
    return sum;
  });
  curvatures_.add_transposed(of_triangle, moments);
  return energy;
}

void MomentCurves::add_changes(std::span<const double> bent, std::span<const double> change,
                               std::span<double> moments) const {
  std::vector<Vec2> of_triangle(areas_.size());
  parallel_for(areas_.size(), block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const Vec2 bend = curvatures_.of(t, bent), more = curvatures_.of(t, change);
      of_triangle[t] = areas_[t] * Vec2(warp_.at(std::abs(bend[0])).slope * more[0],
                                        weft_.at(std::abs(bend[1])).slope * more[1]);
    }
  });
  curvatures_.add_transposed(of_triangle, moments);
}

}  // namespace muslin
