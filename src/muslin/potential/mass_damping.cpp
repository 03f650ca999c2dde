#include "muslin/potential/mass_damping.hpp"

#include <utility>

#include "muslin/core/parallel.hpp"
#include "muslin/potential/hessian_sink.hpp"

namespace muslin {
namespace {

constexpr std::size_t grain = 8192;

/// W = Σ cᵢ |xᵢ − anchorᵢ|² / 2 with cᵢ = α mᵢ / dt.
class Drag : public Potential {
 public:
  Drag(double factor, std::shared_ptr<const std::vector<double>> masses, std::vector<Vec3> anchor)
      : factor_(factor), masses_(std::move(masses)), anchor_(std::move(anchor)) {}

  double value(ConstVectors x) const override {
    return parallel_sum(x.size(), grain, 0.0, [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t v = begin; v < end; ++v)
        sum += 0.5 * coefficient(v) * (x[v] - anchor_[v]).squaredNorm();
      return sum;
    });
  }
  void add_gradient(ConstVectors x, Vectors g) const override {
    parallel_for(x.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) g[v] += coefficient(v) * (x[v] - anchor_[v]);
    });
  }
  void add_hessian_product(ConstVectors x, ConstVectors p, Vectors y) const override {
    parallel_for(x.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) y[v] += coefficient(v) * p[v];
    });
  }
  void add_diagonal_blocks(ConstVectors x, std::span<Mat3> blocks) const override {
    parallel_for(x.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) blocks[v].diagonal().array() += coefficient(v);
    });
  }
  void linearize(ConstVectors x, HessianSink& into, std::size_t first) const override {
    const std::span<float> identity = into.identity(first, x.size());
    const double scale = into.scale();
    for (std::size_t v = 0; v < x.size(); ++v) identity[v] += static_cast<float>(scale * coefficient(v));
  }

 private:
  double coefficient(std::size_t v) const { return factor_ * (*masses_)[v]; }

  double factor_;  // α / dt
  std::shared_ptr<const std::vector<double>> masses_;
  std::vector<Vec3> anchor_;
};

}  // namespace

MassDamping::MassDamping(double alpha, std::vector<double> masses)
    : alpha_(alpha), masses_(std::make_shared<const std::vector<double>>(std::move(masses))) {}

std::unique_ptr<Potential> MassDamping::potential(const StepContext& step) const {
  if (alpha_ == 0) return nullptr;
  return std::make_unique<Drag>(alpha_ / step.dt, masses_, step.anchor);
}

}  // namespace muslin
