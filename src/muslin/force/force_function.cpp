#include "muslin/force/force_function.hpp"

#include <utility>
#include <vector>

#include <fmt/format.h>

#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

constexpr std::size_t function_grain = 8192;

class FrozenForces : public Potential {
 public:
  explicit FrozenForces(std::vector<Vec3> forces) : forces_(std::move(forces)) {}

  double value(ConstVectors x) const override {
    return parallel_sum(x.size(), function_grain, 0.0, [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t v = begin; v < end; ++v) sum -= forces_[v].dot(x[v]);
      return sum;
    });
  }
  void add_gradient(ConstVectors, Vectors g) const override {
    parallel_for(g.size(), function_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) g[v] -= forces_[v];
    });
  }
  void add_hessian_product(ConstVectors, ConstVectors, Vectors) const override {}
  void add_diagonal_blocks(ConstVectors, std::span<Mat3>) const override {}
  void linearize(ConstVectors, HessianSink&, std::size_t) const override {}

 private:
  std::vector<Vec3> forces_;
};

}  // namespace

ForceFunction::ForceFunction(std::string name, Function function)
    : name_(std::move(name)), function_(std::move(function)) {}

std::unique_ptr<Potential> ForceFunction::potential(const StepContext& step) const {
  std::vector<Vec3> forces(step.positions.size(), Vec3::Zero());
  function_(step.time_begin, step.positions, step.velocities, forces);
  for (std::size_t v = 0; v < forces.size(); ++v) {
    if (forces[v].allFinite()) continue;
    throw Error(
        ErrorKind::usage,
        fmt::format("the force \"{}\" on vertex {} after {:.6g} s is no finite number: ({}, {}, {}) N", name_,
                    v, step.time_begin, forces[v].x(), forces[v].y(), forces[v].z()),
        "return finite forces");
  }
  return std::make_unique<FrozenForces>(std::move(forces));
}

}  // namespace muslin
