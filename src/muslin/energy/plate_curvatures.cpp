#include "muslin/energy/plate_curvatures.hpp"

#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

constexpr std::size_t curvature_block = 1024;

}  // namespace

void PlateCurvatures::find_uses() {
  std::vector<std::vector<Use>> by_hinge(hinge_count);
  for (std::size_t t = 0; t + 1 < first.size(); ++t)
    for (int k = first[t]; k < first[t + 1]; ++k)
      by_hinge[at(hinges[at(k)])].push_back({static_cast<int>(t), k});
  first_use.assign(1, 0);
  uses.clear();
  for (const std::vector<Use>& of_hinge : by_hinge) {
    uses.insert(uses.end(), of_hinge.begin(), of_hinge.end());
    first_use.push_back(static_cast<int>(uses.size()));
  }
}

void PlateCurvatures::add_transposed(std::span<const Vec2> of_triangle, std::span<double> moments) const {
  parallel_for(moments.size(), curvature_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t h = begin; h < end; ++h)
      for (int k = first_use[h]; k < first_use[h + 1]; ++k) {
        const Use& use = uses[at(k)];
        moments[h] += weights[at(use.entry)].dot(of_triangle[at(use.triangle)]);
      }
  });
}

std::vector<double> PlateCurvatures::lumped(std::span<const Vec2> of_triangle) const {
  // c (Σ bₕ dₕ)² ≤ c Σ |b_f| Σ |bₕ| dₕ² in every triangle.
  std::vector<Vec2> sums(of_triangle.size());
  parallel_for(sums.size(), curvature_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      Vec2 sum = Vec2::Zero();
      for (int k = first[t]; k < first[t + 1]; ++k) sum += weights[at(k)].cwiseAbs();
      sums[t] = of_triangle[t].cwiseProduct(sum);
    }
  });
  std::vector<double> diagonal(hinge_count);
  parallel_for(hinge_count, curvature_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t h = begin; h < end; ++h) {
      double sum = 0;
      for (int k = first_use[h]; k < first_use[h + 1]; ++k)
        sum += weights[at(uses[at(k)].entry)].cwiseAbs().dot(sums[at(uses[at(k)].triangle)]);
      diagonal[h] = 0.5 * sum;
    }
  });
  return diagonal;
}

}  // namespace muslin
