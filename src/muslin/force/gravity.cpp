#include "muslin/force/gravity.hpp"

#include <array>
#include <cassert>
#include <utility>

#include "muslin/core/parallel.hpp"

namespace muslin {

namespace {

constexpr std::size_t gravity_grain = 8192;

class UniformField : public Potential {
 public:
  UniformField(std::shared_ptr<const std::vector<double>> masses, const Vec3& acceleration)
      : masses_(std::move(masses)), acceleration_(acceleration) {}

  double value(ConstVectors x) const override {
    assert(x.size() == masses_->size());
    return pass(x, [](std::size_t) {});
  }
  double add_gradient_and_value(ConstVectors x, Vectors g) const override {
    return pass(x, [&](std::size_t v) { g[v] -= (*masses_)[v] * acceleration_; });
  }
  void add_gradient(ConstVectors x, Vectors g) const override {
    assert(x.size() == masses_->size());
    parallel_for(x.size(), gravity_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) g[v] -= (*masses_)[v] * acceleration_;
    });
  }
  void add_hessian_product(ConstVectors, ConstVectors, Vectors) const override {}
  void add_diagonal_blocks(ConstVectors, std::span<Mat3>) const override {}
  void linearize(ConstVectors, HessianSink&, std::size_t) const override {}

 private:
  /// Calls also(v) for all v; returns the energy.
  template <class Also>
  double pass(ConstVectors x, const Also& also) const {
    const Vec3 moment = parallel_sum(x.size(), gravity_grain, Vec3(Vec3::Zero()), [&](auto begin, auto end) {
      // Independent sums, for instruction-level parallelism.
      constexpr std::size_t sums = 4;
      std::array<Vec3, sums> sum;
      sum.fill(Vec3::Zero());
      std::size_t v = begin;
      for (; v + sums <= end; v += sums) {
        for (std::size_t i = 0; i < sums; ++i) {
          sum[i] += (*masses_)[v + i] * x[v + i];
          also(v + i);
        }
      }
      for (; v < end; ++v) {
        sum[0] += (*masses_)[v] * x[v];
        also(v);
      }
      return Vec3((sum[0] + sum[1]) + (sum[2] + sum[3]));
    });
    return -acceleration_.dot(moment);
  }

  std::shared_ptr<const std::vector<double>> masses_;
  Vec3 acceleration_;
};

}  // namespace

Gravity::Gravity(std::vector<double> masses, Keyed acceleration, Window window)
    : masses_(std::make_shared<const std::vector<double>>(std::move(masses))),
      acceleration_(std::move(acceleration)),
      window_(window) {}

std::unique_ptr<Potential> Gravity::potential(const StepContext& step) const {
  const double share = window_.share(step.time_begin, step.time_end);
  if (share == 0) return nullptr;
  return std::make_unique<UniformField>(masses_, share * acceleration_.at(window_.sample(step.time_end)));
}

}  // namespace muslin
