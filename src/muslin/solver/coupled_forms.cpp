#include "muslin/solver/coupled_forms.hpp"

#include <utility>

#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

constexpr std::size_t form_grain = 4096;

}  // namespace

Float4* CoupledForms::reset(std::shared_ptr<const FormCoupling> coupling, std::size_t first, double factor) {
  coupling_ = std::move(coupling);
  first_ = first;
  factor_ = static_cast<float>(factor);
  const std::size_t forms = coupling_->vertices.size();
  if (along_.size() != forms) {
    gradients_.resize(4 * forms);
    along_.resize(forms);
    moments_.resize(forms);
  }
  return gradients_.data();
}

double CoupledForms::add_product(const Float4* p, Float4* y) {
  const FormCoupling& c = *coupling_;
  const std::size_t forms = c.vertices.size();
  const Float4* const g = gradients_.data();
  float *const along = along_.data(), *const moments = moments_.data();
  parallel_for(forms, form_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      const std::array<int, 4>& v = c.vertices[e];
      const Float4* const of = g + 4 * e;
      const Float4 sum = of[0] * p[v[0]] + of[1] * p[v[1]] + (of[2] * p[v[2]] + of[3] * p[v[3]]);
      along[e] = sum[0] + sum[1] + sum[2];
    }
  });
  const double curvature = parallel_sum(forms, form_grain, 0.0, [&](std::size_t begin, std::size_t end) {
    double total = 0;
    for (std::size_t e = begin; e < end; ++e) {
      float sum = 0;
      for (int k = c.first[e]; k < c.first[e + 1]; ++k)
        sum += c.values[static_cast<std::size_t>(k)] * along[c.columns[static_cast<std::size_t>(k)]];
      moments[e] = factor_ * sum;
      total += static_cast<double>(moments[e]) * along[e];
    }
    return total;
  });
  parallel_for(c.first_share.size() - 1, form_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      Float4 sum = {0, 0, 0, 0};
      for (int k = c.first_share[v]; k < c.first_share[v + 1]; ++k) {
        const int share = c.shares[static_cast<std::size_t>(k)];
        sum += moments[share / 4] * g[share];
      }
      y[v] += sum;
    }
  });
  return curvature;
}

}  // namespace muslin
