#include "muslin/force/gravity.hpp"

#include <cassert>
#include <utility>

#include "muslin/core/parallel.hpp"

namespace muslin {

namespace {

constexpr std::size_t kGrain = 8192;

class UniformField : public Potential {
 public:
  UniformField(std::shared_ptr<const std::vector<double>> masses, const Vec3& acceleration)
      : masses_(std::move(masses)), acceleration_(acceleration) {}

  double value(ConstVectors x) const override {
    assert(x.size() == masses_->size());
    const Vec3 moment = parallel_sum(x.size(), kGrain, Vec3(Vec3::Zero()), [&](auto begin, auto end) {
      Vec3 sum = Vec3::Zero();
      for (std::size_t v = begin; v < end; ++v) sum += (*masses_)[v] * x[v];
      return sum;
    });
    return -acceleration_.dot(moment);
  }
  void add_gradient(ConstVectors x, Vectors g) const override {
    assert(x.size() == masses_->size());
    parallel_for(x.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) g[v] -= (*masses_)[v] * acceleration_;
    });
  }
  void add_hessian_product(ConstVectors, ConstVectors, Vectors) const override {}
  void add_diagonal_blocks(ConstVectors, std::span<Mat3>) const override {}
  void linearize(ConstVectors, Linearization&, std::size_t) const override {}

 private:
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
