#include "muslin/energy/element_energy.hpp"

#include <utility>
#include <vector>

namespace muslin {
namespace {

/// W = ½ c (x − anchor)ᵀ K (x − anchor), K the material stiffness at `predicted`.
class Dashpots : public Potential {
 public:
  Dashpots(std::shared_ptr<const ElementEnergy> energy, double factor, std::vector<Vec3> anchor,
           std::vector<Vec3> predicted)
      : energy_(std::move(energy)),
        factor_(factor),
        anchor_(std::move(anchor)),
        predicted_(std::move(predicted)) {}

  double value(ConstVectors x) const override {
    const std::vector<Vec3> d = moved(x);
    return energy(d, product(d));
  }
  double add_gradient_and_value(ConstVectors x, Vectors g) const override {
    const std::vector<Vec3> d = moved(x), force = product(d);
    for (std::size_t v = 0; v < g.size(); ++v) g[v] += factor_ * force[v];
    return energy(d, force);
  }
  void add_gradient(ConstVectors x, Vectors g) const override { add_gradient_and_value(x, g); }
  void add_hessian_product(ConstVectors, ConstVectors p, Vectors y) const override {
    const std::vector<Vec3> force = product(p);
    for (std::size_t v = 0; v < y.size(); ++v) y[v] += factor_ * force[v];
  }
  void add_diagonal_blocks(ConstVectors, std::span<Mat3> blocks) const override {
    std::vector<Mat3> own(blocks.size(), Mat3::Zero());
    energy_->add_stiffness_blocks(Stiffness::material, predicted_, own);
    for (std::size_t v = 0; v < blocks.size(); ++v) blocks[v] += factor_ * own[v];
  }

  void linearize(ConstVectors x, HessianSink& into, std::size_t first) const override {
    if (energy_->pattern()) {
      energy_->linearize_stiffness(Stiffness::material, predicted_, factor_, into, first);
    } else {
      into.add_general(*this, first, x);
    }
  }

 private:
  std::vector<Vec3> moved(ConstVectors x) const {
    std::vector<Vec3> d(x.size());
    for (std::size_t v = 0; v < d.size(); ++v) d[v] = x[v] - anchor_[v];
    return d;
  }
  double energy(ConstVectors d, ConstVectors force) const {
    double sum = 0;
    for (std::size_t v = 0; v < d.size(); ++v) sum += d[v].dot(force[v]);
    return 0.5 * factor_ * sum;
  }
  std::vector<Vec3> product(ConstVectors p) const {
    std::vector<Vec3> y(p.size(), Vec3::Zero());
    energy_->add_stiffness_product(Stiffness::material, predicted_, p, y);
    return y;
  }

  std::shared_ptr<const ElementEnergy> energy_;
  double factor_;
  std::vector<Vec3> anchor_;
  std::vector<Vec3> predicted_;
};

}  // namespace

void ElementEnergy::linearize_stiffness(Stiffness kind, ConstVectors x, double factor, HessianSink& into,
                                        std::size_t first) const {
  add_stiffness_matrix(kind, x, into.scale() * factor, into.masses().subspan(first, x.size()),
                       into.pair_blocks(pattern_, first));
}

void ElementEnergy::linearize(ConstVectors x, HessianSink& into, std::size_t first) const {
  if (pattern_) {
    linearize_stiffness(Stiffness::bounded, x, 1, into, first);
  } else {
    into.add_general(projected_, first, x);
  }
}

ElementDamping::ElementDamping(std::shared_ptr<const ElementEnergy> energy, double beta)
    : energy_(std::move(energy)), beta_(beta) {}

std::unique_ptr<Potential> ElementDamping::potential(const StepContext& step) const {
  if (beta_ == 0) return nullptr;
  std::vector<Vec3> predicted(step.positions.begin(), step.positions.end());
  for (std::size_t v = 0; v < predicted.size(); ++v)
    predicted[v] += (step.velocity_time - step.time_begin) * step.velocities[v];
  return std::make_unique<Dashpots>(energy_, beta_ / step.dt, step.anchor, std::move(predicted));
}

}  // namespace muslin
