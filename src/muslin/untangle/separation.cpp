#include "muslin/untangle/separation.hpp"

#include <algorithm>
#include <utility>

#include "muslin/core/index.hpp"

namespace muslin {

SeparationPotential::SeparationPotential(std::shared_ptr<const SurfaceMap> map,
                                         std::vector<Separation> separations)
    : map_(std::move(map)), separations_(std::move(separations)) {}

double SeparationPotential::missing(const Separation& s, ConstVectors x) {
  Vec3 apart = Vec3::Zero();
  for (std::size_t i = 0; i < 4; ++i)
    if (s.points[i] >= 0) apart += s.weights[i] * x[at(s.points[i])];
  return std::max(0.0, s.gap - s.normal.dot(apart));
}

double SeparationPotential::value(ConstVectors q) const {
  std::vector<Vec3> x(map_->point_count());
  map_->apply(q, x);
  double sum = 0;
  for (const Separation& s : separations_) {
    const double m = missing(s, x);
    sum += 0.5 * s.stiffness * m * m;
  }
  return sum;
}

double SeparationPotential::mean_missing(ConstVectors q) const {
  std::vector<Vec3> x(map_->point_count());
  map_->apply(q, x);
  double sum = 0, count = 0;
  for (const Separation& s : separations_) {
    const double m = missing(s, x);
    sum += m;
    count += m > 0 ? 1 : 0;
  }
  return count > 0 ? sum / count : 0;
}

void SeparationPotential::add_gradient(ConstVectors q, Vectors g) const {
  std::vector<Vec3> x(map_->point_count()), force(map_->point_count(), Vec3::Zero());
  map_->apply(q, x);
  for (const Separation& s : separations_) {
    const double m = missing(s, x);
    for (std::size_t i = 0; i < 4; ++i)
      if (s.points[i] >= 0) force[at(s.points[i])] -= s.stiffness * m * s.weights[i] * s.normal;
  }
  map_->add_transpose(force, g);
}

ContactHessian SeparationPotential::hessian(ConstVectors q) const {
  std::vector<Vec3> x(map_->point_count());
  map_->apply(q, x);
  std::vector<ContactRow> rows;
  rows.reserve(separations_.size());
  for (const Separation& s : separations_) {
    if (!(missing(s, x) > 0)) continue;
    ContactRow& row = rows.emplace_back();
    row.points = s.points;
    row.weights = s.weights;
    row.normal = s.normal;
    row.normal_stiffness = s.stiffness;
  }
  return {*map_, rows};
}

void SeparationPotential::add_hessian_product(ConstVectors q, ConstVectors p, Vectors y) const {
  hessian(q).add_hessian_product(q, p, y);
}

void SeparationPotential::add_diagonal_blocks(ConstVectors q, std::span<Mat3> blocks) const {
  hessian(q).add_diagonal_blocks(q, blocks);
}

void SeparationPotential::linearize(ConstVectors q, HessianSink& into, std::size_t first) const {
  hessian(q).linearize(q, into, first);
}

}  // namespace muslin
