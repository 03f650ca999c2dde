#include "muslin/potential/anchor_springs.hpp"

#include <utility>

#include "muslin/core/parallel.hpp"
#include "muslin/potential/hessian_sink.hpp"

namespace muslin {
namespace {

constexpr std::size_t spring_grain = 8192;

}  // namespace

AnchorSprings::AnchorSprings(std::vector<double> coefficients, std::vector<Vec3> anchor)
    : coefficients_(std::move(coefficients)), anchor_(std::move(anchor)) {}

double AnchorSprings::value(ConstVectors x) const {
  return parallel_sum(x.size(), spring_grain, 0.0, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t v = begin; v < end; ++v)
      sum += 0.5 * coefficients_[v] * (x[v] - anchor_[v]).squaredNorm();
    return sum;
  });
}

void AnchorSprings::add_gradient(ConstVectors x, Vectors g) const {
  parallel_for(x.size(), spring_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) g[v] += coefficients_[v] * (x[v] - anchor_[v]);
  });
}

void AnchorSprings::add_hessian_product(ConstVectors x, ConstVectors p, Vectors y) const {
  parallel_for(x.size(), spring_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) y[v] += coefficients_[v] * p[v];
  });
}

void AnchorSprings::add_diagonal_blocks(ConstVectors x, std::span<Mat3> blocks) const {
  parallel_for(x.size(), spring_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) blocks[v].diagonal().array() += coefficients_[v];
  });
}

void AnchorSprings::linearize(ConstVectors x, HessianSink& into, std::size_t first) const {
  const std::span<float> identity = into.identity(first, x.size());
  const double scale = into.scale();
  for (std::size_t v = 0; v < x.size(); ++v) identity[v] += static_cast<float>(scale * coefficients_[v]);
}

}  // namespace muslin
