#include "muslin/energy/moment_curves.hpp"

#include <cmath>
#include <utility>

#include "muslin/core/index.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

constexpr std::size_t block = 1024;

}  // namespace

MomentCurves::MomentCurves(PlateCurvatures curvatures, std::vector<double> areas, const StressCurve& warp,
                           const StressCurve& weft)
    : curvatures_(std::move(curvatures)), areas_(std::move(areas)), warp_(warp), weft_(weft) {
  std::vector<std::vector<Use>> by_hinge(curvatures_.hinge_count);
  for (std::size_t t = 0; t < areas_.size(); ++t)
    for (int k = curvatures_.first[t]; k < curvatures_.first[t + 1]; ++k)
      by_hinge[at(curvatures_.hinges[at(k)])].push_back({static_cast<int>(t), k});
  first_use_.push_back(0);
  for (const std::vector<Use>& uses : by_hinge) {
    uses_.insert(uses_.end(), uses.begin(), uses.end());
    first_use_.push_back(static_cast<int>(uses_.size()));
  }
}

Vec2 MomentCurves::curvature(std::size_t triangle, std::span<const double> bent) const {
  Vec2 sum = Vec2::Zero();
  for (int k = curvatures_.first[triangle]; k < curvatures_.first[triangle + 1]; ++k)
    sum += bent[at(curvatures_.hinges[at(k)])] * curvatures_.weights[at(k)];
  return sum;
}

double MomentCurves::energy(std::span<const double> bent) const {
  return parallel_sum(areas_.size(), block, 0.0, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t t = begin; t < end; ++t) {
      const Vec2 bend = curvature(t, bent);
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
      const Vec2 bend = curvature(t, bent);
      const StressCurve::State u = warp_.at(std::abs(bend[0])), v = weft_.at(std::abs(bend[1]));
      sum += areas_[t] * (u.energy + v.energy);
      of_triangle[t] = areas_[t] * Vec2(std::copysign(u.stress, bend[0]), std::copysign(v.stress, bend[1]));
    }
    return sum;
  });
  add_transposed(of_triangle, moments);
  return energy;
}

void MomentCurves::add_changes(std::span<const double> bent, std::span<const double> change,
                               std::span<double> moments) const {
  std::vector<Vec2> of_triangle(areas_.size());
  parallel_for(areas_.size(), block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const Vec2 bend = curvature(t, bent), more = curvature(t, change);
      of_triangle[t] = areas_[t] * Vec2(warp_.at(std::abs(bend[0])).slope * more[0],
                                        weft_.at(std::abs(bend[1])).slope * more[1]);
    }
  });
  add_transposed(of_triangle, moments);
}

void MomentCurves::add_transposed(std::span<const Vec2> of_triangle, std::span<double> moments) const {
  parallel_for(moments.size(), block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t h = begin; h < end; ++h)
      for (int k = first_use_[h]; k < first_use_[h + 1]; ++k) {
        const Use& use = uses_[at(k)];
        moments[h] += curvatures_.weights[at(use.entry)].dot(of_triangle[at(use.triangle)]);
      }
  });
}

}  // namespace muslin
