#include "muslin/force/frozen_forces.hpp"

#include <utility>

#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

constexpr std::size_t frozen_grain = 8192;

}  // namespace

FrozenForces::FrozenForces(std::vector<Vec3> forces) : forces_(std::move(forces)) {}

double FrozenForces::value(ConstVectors x) const {
  return parallel_sum(x.size(), frozen_grain, 0.0, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t v = begin; v < end; ++v) sum -= forces_[v].dot(x[v]);
    return sum;
  });
}

void FrozenForces::add_gradient(ConstVectors, Vectors g) const {
  parallel_for(g.size(), frozen_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) g[v] -= forces_[v];
  });
}

}  // namespace muslin
