#include "muslin/force/uneven_pressure.hpp"

#include <cstddef>
#include <utility>

#include "muslin/core/error.hpp"
#include "muslin/core/index.hpp"
#include "muslin/force/frozen_forces.hpp"

namespace muslin {

UnevenPressure::UnevenPressure(std::shared_ptr<const EnclosedVolume> surface, std::vector<double> shares,
                               PressureOfStep pressure)
    : surface_(std::move(surface)), shares_(std::move(shares)), pressure_(std::move(pressure)) {
  require(shares_.size() == surface_->vertex_count(), "a pressure has another count of shares than vertices",
          "give one for each vertex");
  for (const std::vector<int>& hole : surface_->holes()) {
    double sum = 0;
    for (const int v : hole) sum += shares_[at(v)];
    shares_.push_back(sum / static_cast<double>(hole.size()));
  }
}

std::vector<Vec3> UnevenPressure::forces(ConstVectors x, double pressure) const {
  const std::vector<Vec3> all = surface_->with_centres(x);
  std::vector<Vec3> forces(all.size(), Vec3::Zero());
  for (const Vec3i& t : surface_->triangles()) {
    const Vec3 &a = all[at(t[0])], &b = all[at(t[1])], &c = all[at(t[2])];
    const Vec3 area = 0.5 * (b - a).cross(c - a);
    const double sum = shares_[at(t[0])] + shares_[at(t[1])] + shares_[at(t[2])];
    for (const int v : t) forces[at(v)] += pressure / 12 * (sum + shares_[at(v)]) * area;
  }
  for (std::size_t h = 0; h < surface_->holes().size(); ++h) {
    const std::vector<int>& hole = surface_->holes()[h];
    const Vec3 of_each = forces[x.size() + h] / static_cast<double>(hole.size());
    for (const int v : hole) forces[at(v)] += of_each;
  }
  forces.resize(x.size());
  return forces;
}

std::unique_ptr<Potential> UnevenPressure::potential(const StepContext& step) const {
  const double pressure = pressure_(step.time_begin, step.time_end);
  if (pressure == 0) return nullptr;
  return std::make_unique<FrozenForces>(forces(step.positions, pressure));
}

}  // namespace muslin
