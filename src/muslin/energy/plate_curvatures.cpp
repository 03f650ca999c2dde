#include "muslin/energy/plate_curvatures.hpp"

#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

constexpr std::size_t curvature_block = 1024;

/// c (Σ bₕ dₕ)² ≤ c Σ |b_f| Σ |bₕ| dₕ² in every triangle. `weight(t, k)` is b of entry k of triangle t,
/// `factor(t)` is c.
template <class Curvature, class Weight, class Factor>
std::vector<double> lumped_of(const CurvatureRows<Curvature>& rows, const Weight& weight,
                              const Factor& factor) {
  std::vector<Curvature> sums(rows.first.size() - 1);
  parallel_for(sums.size(), curvature_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      Curvature sum = Curvature::Zero();
      for (int k = rows.first[t]; k < rows.first[t + 1]; ++k) sum += weight(t, at(k)).cwiseAbs();
      sums[t] = factor(t).cwiseProduct(sum);
    }
  });
  std::vector<double> diagonal(rows.hinge_count);
  parallel_for(rows.hinge_count, curvature_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t h = begin; h < end; ++h) {
      double sum = 0;
      for (int k = rows.first_use[h]; k < rows.first_use[h + 1]; ++k) {
        const auto& use = rows.uses[at(k)];
        sum += weight(at(use.triangle), at(use.entry)).cwiseAbs().dot(sums[at(use.triangle)]);
      }
      diagonal[h] = 0.5 * sum;
    }
  });
  return diagonal;
}

}  // namespace

template <class Curvature>
void CurvatureRows<Curvature>::find_uses() {
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

template <class Curvature>
std::vector<Curvature> CurvatureRows<Curvature>::of_all(std::span<const double> deviations) const {
  std::vector<Curvature> result(first.size() - 1);
  parallel_for(result.size(), curvature_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) result[t] = of(t, deviations);
  });
  return result;
}

template <class Curvature>
void CurvatureRows<Curvature>::add_transposed(std::span<const Curvature> of_triangle,
                                              std::span<double> moments) const {
  parallel_for(moments.size(), curvature_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t h = begin; h < end; ++h)
      for (int k = first_use[h]; k < first_use[h + 1]; ++k) {
        const Use& use = uses[at(k)];
        moments[h] += weights[at(use.entry)].dot(of_triangle[at(use.triangle)]);
      }
  });
}

template <class Curvature>
std::vector<double> CurvatureRows<Curvature>::lumped(std::span<const Curvature> of_triangle) const {
  return lumped_of(
      *this, [&](std::size_t, std::size_t k) -> const Curvature& { return weights[k]; },
      [&](std::size_t t) -> const Curvature& { return of_triangle[t]; });
}

template <class Curvature>
std::vector<double> CurvatureRows<Curvature>::lumped_by(std::span<const Square> roots) const {
  return lumped_of(
      *this, [&](std::size_t t, std::size_t k) { return Curvature(roots[t] * weights[k]); },
      [](std::size_t) -> Curvature { return Curvature::Ones(); });
}

template struct CurvatureRows<Vec2>;
template struct CurvatureRows<Vec3>;

}  // namespace muslin
