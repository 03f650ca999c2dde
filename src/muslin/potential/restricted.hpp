// Restricts a potential or load to the vertices of one body within those of all bodies.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>

#include "muslin/potential/potential.hpp"

namespace muslin {

/// A potential of vertices first … first + count − 1, as a potential of all vertices.
class RestrictedPotential : public Potential {
 public:
  RestrictedPotential(std::shared_ptr<const Potential> local, std::size_t first, std::size_t count)
      : local_(std::move(local)), first_(first), count_(count) {}

  double value(ConstVectors x) const override { return local_->value(part(x)); }
  void add_gradient(ConstVectors x, Vectors g) const override { local_->add_gradient(part(x), part(g)); }
  double add_gradient_and_value(ConstVectors x, Vectors g) const override {
    return local_->add_gradient_and_value(part(x), part(g));
  }
  void add_hessian_product(ConstVectors x, ConstVectors p, Vectors y) const override {
    local_->add_hessian_product(part(x), part(p), part(y));
  }
  void add_diagonal_blocks(ConstVectors x, std::span<Mat3> blocks) const override {
    local_->add_diagonal_blocks(part(x), part(blocks));
  }
  void linearize(ConstVectors x, HessianSink& into, std::size_t first) const override {
    local_->linearize(part(x), into, first + first_);
  }
  double dissipated(ConstVectors x) const override { return local_->dissipated(part(x)); }
  double max_step(ConstVectors x, ConstVectors d) const override {
    return local_->max_step(part(x), part(d));
  }

  const Potential& local() const { return *local_; }

 private:
  template <class Span>
  Span part(Span all) const {
    return all.subspan(first_, count_);
  }

  std::shared_ptr<const Potential> local_;
  std::size_t first_;
  std::size_t count_;
};

/// A load of one body as a load of all vertices.
class RestrictedLoad : public Load {
 public:
  RestrictedLoad(std::shared_ptr<const Load> local, std::size_t first, std::size_t count)
      : local_(std::move(local)), first_(first), count_(count) {}

  std::unique_ptr<Potential> potential(const StepContext& step) const override {
    StepContext body = step;
    const auto begin = step.anchor.begin() + static_cast<std::ptrdiff_t>(first_);
    body.anchor.assign(begin, begin + static_cast<std::ptrdiff_t>(count_));
    body.inertial_prediction.clear();  // the solver's, not the loads'
    body.positions = step.positions.subspan(first_, count_);
    body.velocities = step.velocities.subspan(first_, count_);
    std::unique_ptr<Potential> local = local_->potential(body);
    if (!local) return nullptr;
    return std::make_unique<RestrictedPotential>(std::move(local), first_, count_);
  }
  void end_step(const Potential& potential, ConstVectors x, History& history) const override {
    local_->end_step(static_cast<const RestrictedPotential&>(potential).local(), x.subspan(first_, count_),
                     history);
  }

 private:
  std::shared_ptr<const Load> local_;
  std::size_t first_;
  std::size_t count_;
};

}  // namespace muslin
