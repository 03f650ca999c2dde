// Potentials simple enough to know the motion in closed form.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "muslin/potential/potential.hpp"

namespace muslin::test {

/// W = −Σ mᵢ a·xᵢ: a constant acceleration of every vertex.
class UniformGravity : public Potential {
 public:
  UniformGravity(std::vector<double> masses, Vec3 acceleration)
      : masses_(std::move(masses)), acceleration_(std::move(acceleration)) {}

  double value(ConstVectors x) const override {
    double w = 0;
    for (std::size_t v = 0; v < x.size(); ++v) w -= masses_[v] * acceleration_.dot(x[v]);
    return w;
  }
  void add_gradient(ConstVectors x, Vectors g) const override {
    for (std::size_t v = 0; v < x.size(); ++v) g[v] -= masses_[v] * acceleration_;
  }
  void add_hessian_product(ConstVectors, ConstVectors, Vectors) const override {}
  void add_diagonal_blocks(ConstVectors, std::span<Mat3>) const override {}
  void linearize(ConstVectors, HessianSink&, std::size_t) const override {}

 private:
  std::vector<double> masses_;
  Vec3 acceleration_;
};

/// W = Σ ½ k |xᵢ|²: every vertex on its own spring to the origin.
class Wells : public Potential {
 public:
  explicit Wells(double k) : k_(k) {}

  double value(ConstVectors x) const override {
    double w = 0;
    for (const Vec3& p : x) w += 0.5 * k_ * p.squaredNorm();
    return w;
  }
  void add_gradient(ConstVectors x, Vectors g) const override {
    for (std::size_t v = 0; v < x.size(); ++v) g[v] += k_ * x[v];
  }
  void add_hessian_product(ConstVectors x, ConstVectors p, Vectors y) const override {
    for (std::size_t v = 0; v < x.size(); ++v) y[v] += k_ * p[v];
  }
  void add_diagonal_blocks(ConstVectors x, std::span<Mat3> blocks) const override {
    for (std::size_t v = 0; v < x.size(); ++v) blocks[v].diagonal().array() += k_;
  }

 private:
  double k_;
};

}  // namespace muslin::test
