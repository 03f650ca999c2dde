#include "muslin/energy/spring_damping.hpp"

#include <utility>

#include "muslin/core/buffer.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/potential/hessian_sink.hpp"

namespace muslin {
namespace {

/// W = Σ ½ c (nᵀ(z − z_anchor))², n of the predicted positions; c = β k / dt.
class SpringDashpots : public Potential {
  SpringType type(const SpringPiece& piece) const {
    return springs_->type(piece.direction, piece.slot, factor_);
  }
  /// Columns of the prediction and of x − anchor.
  auto load_change(ConstVectors x) const {
    return [this, x](std::size_t v, int n, const std::array<Columns, 2>& to) {
      load_columns(predicted_[v].data(), n, to[0]);
      load_differences(x[v].data(), anchor_[v].data(), n, to[1]);
    };
  }
  template <class Load>
  double sweep(const Load& load, Vectors y) const {
    return springs_->slabs().sweep<2>(y, load, [&](const SpringPiece& piece, const SpringColumns<2>& c) {
      add_dashpot_forces(type(piece), piece.length, c.a[0], c.b[0], c.a[1], c.b[1], c.to, c.w);
    });
  }

 public:
  SpringDashpots(std::shared_ptr<const SpringEnergy> springs, double factor, const StepContext& step)
      : springs_(std::move(springs)), factor_(factor) {
    const std::size_t count = step.positions.size();
    constexpr std::size_t grain = 8192;
    anchor_memory_.resize(count);
    predicted_memory_.resize(count);
    const double ahead = step.velocity_time - step.time_begin;
    parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        anchor_memory_.data()[v] = step.anchor[v];
        predicted_memory_.data()[v] = step.positions[v] + ahead * step.velocities[v];
      }
    });
    anchor_ = {anchor_memory_.data(), count};
    predicted_ = {predicted_memory_.data(), count};
  }

  double value(ConstVectors x) const override {
    return springs_->slabs().sweep<2>(
        {}, load_change(x), [&](const SpringPiece& piece, const SpringColumns<2>& c) {
          add_dashpot_energies(type(piece), piece.length, c.a[0], c.b[0], c.a[1], c.b[1], c.w);
        });
  }
  void add_gradient(ConstVectors x, Vectors g) const override { add_gradient_and_value(x, g); }
  double add_gradient_and_value(ConstVectors x, Vectors g) const override { return sweep(load_change(x), g); }
  void add_hessian_product(ConstVectors, ConstVectors p, Vectors y) const override {
    sweep(
        [this, p](std::size_t v, int n, const std::array<Columns, 2>& to) {
          load_columns(predicted_[v].data(), n, to[0]);
          load_columns(p[v].data(), n, to[1]);
        },
        y);
  }
  void add_diagonal_blocks(ConstVectors, std::span<Mat3> blocks) const override {
    springs_->slabs().add_blocks(blocks, [&](const SpringPiece& piece, int i) -> Mat3 {
      const SpringType of = type(piece);
      const Vec3 z = difference(predicted_, piece, i);
      const double length = z.norm();
      if (!(length > shortest_spring * of.rest)) return Mat3::Zero();
      const Vec3 n = z / length;
      return ((of.weight != nullptr ? of.k * static_cast<double>(of.weight[i]) : of.k) * n) * n.transpose();
    });
  }
  /// The springs' couplings grow along their own direction. It differs from that of the prediction by as
  /// much as they turn within the step; Newton's method and iterative refinement compensate for it.
  void linearize(ConstVectors, HessianSink& into, std::size_t first) const override {
    into.add_dashpots(springs_->network(), springs_->kinds(into.scale() * factor_), predicted_, first);
  }

 private:
  std::shared_ptr<const SpringEnergy> springs_;
  double factor_;
  Buffer<Vec3> anchor_memory_, predicted_memory_;  // made anew every step: few large pages are
  ConstVectors anchor_, predicted_;                // faster to get than many small ones
};

}  // namespace

SpringDamping::SpringDamping(std::shared_ptr<const SpringEnergy> springs, double beta)
    : springs_(std::move(springs)), beta_(beta) {}

std::unique_ptr<Potential> SpringDamping::potential(const StepContext& step) const {
  if (beta_ == 0) return nullptr;
  return std::make_unique<SpringDashpots>(springs_, beta_ / step.dt, step);
}

}  // namespace muslin
