#include "muslin/force/drag_field.hpp"

#include <utility>

#include "muslin/core/parallel.hpp"
#include "muslin/potential/anchor_springs.hpp"

namespace muslin {
namespace {

constexpr std::size_t drag_field_grain = 1024;

}  // namespace

DragField::DragField(std::vector<double> masses, FieldExtent extent, Coefficients coefficients)
    : masses_(std::move(masses)), extent_(std::move(extent)), coefficients_(coefficients) {}

std::unique_ptr<Potential> DragField::potential(const StepContext& step) const {
  const double strength = extent_.strength_in(step.time_begin, step.time_end);
  if (strength == 0) return nullptr;
  const double time = extent_.sampled(step.time_end);
  std::vector<double> coefficients(step.positions.size(), 0.0);
  parallel_for(coefficients.size(), drag_field_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      if (masses_[v] == 0) continue;
      const Vec3& x = step.positions[v];
      const double rate = coefficients_.linear + coefficients_.quadratic * step.velocities[v].norm();
      const double weight = extent_.weight(x, extent_.place_of(x, time).norm());
      coefficients[v] = masses_[v] * strength * weight * rate / step.dt;
    }
  });
  return std::make_unique<AnchorSprings>(std::move(coefficients), step.anchor);
}

}  // namespace muslin
