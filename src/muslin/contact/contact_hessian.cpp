#include "muslin/contact/contact_hessian.hpp"

#include <algorithm>
#include <numeric>

#include "muslin/core/parallel.hpp"
#include "muslin/potential/hessian_sink.hpp"

namespace muslin {
namespace {

constexpr std::size_t hessian_grain = 1024;

}  // namespace

ContactHessian::ContactHessian(const SurfaceMap& map, const std::vector<ContactRow>& rows)
    : vertex_count_(map.vertex_count()), rows_(rows.size()), offsets_(rows.size() + 1, 0) {
  weights_ = parallel_collect<StepGuard::Weight>(
      rows.size(), hessian_grain,
      [&](std::size_t begin, std::size_t end, std::vector<StepGuard::Weight>& out) {
        for (std::size_t r = begin; r < end; ++r) {
          const ContactRow& row = rows[r];
          rows_[r] = {row.normal, row.normal_stiffness, row.tangential};
          // Points of one pair may share vertices.
          const auto first = static_cast<std::ptrdiff_t>(out.size());
          const auto add = [&](int vertex, double weight) {
            const auto same =
                std::find_if(out.begin() + first, out.end(),
                             [&](const StepGuard::Weight& known) { return known.vertex == vertex; });
            if (same != out.end()) {
              same->weight += weight;
            } else {
              out.push_back({vertex, weight});
            }
          };
          for (std::size_t i = 0; i < 4; ++i) {
            if (row.points[i] < 0 || row.weights[i] == 0) continue;
            for (const SurfaceMap::Entry& e : map.row(static_cast<std::size_t>(row.points[i])))
              add(e.vertex, row.weights[i] * e.weight);
          }
          for (const SurfaceMap::Entry& e : row.carried) add(e.vertex, e.weight);
          offsets_[r + 1] = static_cast<int>(static_cast<std::ptrdiff_t>(out.size()) - first);
        }
      });
  std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());
}

std::span<const StepGuard::Weight> ContactHessian::weights(std::size_t row) const {
  return std::span(weights_).subspan(static_cast<std::size_t>(offsets_[row]),
                                     static_cast<std::size_t>(offsets_[row + 1] - offsets_[row]));
}

Vec3 ContactHessian::relative(std::size_t row, ConstVectors p) const {
  Vec3 sum = Vec3::Zero();
  for (const StepGuard::Weight& w : weights(row)) sum += w.weight * p[static_cast<std::size_t>(w.vertex)];
  return sum;
}

void ContactHessian::for_each_row(const std::function<void(const StepGuard::Contact&)>& visit) const {
  for (std::size_t r = 0; r < rows_.size(); ++r) visit({rows_[r].normal, rows_[r].a, rows_[r].b, weights(r)});
}

double ContactHessian::value(ConstVectors q) const {
  return parallel_sum(rows_.size(), hessian_grain, 0.0, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t r = begin; r < end; ++r) {
      const Vec3 u = relative(r, q);
      sum += u.dot(rows_[r].times(u)) / 2;
    }
    return sum;
  });
}

void ContactHessian::add_hessian_product(ConstVectors /*q*/, ConstVectors p, Vectors y) const {
  std::vector<Vec3> forces(rows_.size());
  parallel_for(rows_.size(), hessian_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r) forces[r] = rows_[r].times(relative(r, p));
  });
  for (std::size_t r = 0; r < rows_.size(); ++r)
    for (const StepGuard::Weight& w : weights(r))
      y[static_cast<std::size_t>(w.vertex)] += w.weight * forces[r];
}

void ContactHessian::linearize(ConstVectors /*q*/, HessianSink& into, std::size_t first) const {
  const std::uint8_t* fixed = into.fixed().data() + first;
  std::vector<int> begins(rows_.size() + 1, 0);
  parallel_for(rows_.size(), hessian_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r)
      for (const StepGuard::Weight& w : weights(r)) begins[r + 1] += fixed[w.vertex] == 0 ? 1 : 0;
  });
  std::partial_sum(begins.begin(), begins.end(), begins.begin());
  const RelativeTerms terms =
      into.relative_terms(first, vertex_count_, rows_.size(), static_cast<std::size_t>(begins.back()));
  const double scale = into.scale();
  parallel_for(rows_.size(), hessian_grain, [&](std::size_t begin, std::size_t end) {
    std::vector<RelativeTerms::Weight> free;
    for (std::size_t r = begin; r < end; ++r) {
      free.clear();
      for (const StepGuard::Weight& w : weights(r))
        if (fixed[w.vertex] == 0) free.push_back({w.vertex, static_cast<float>(w.weight)});
      terms.set(r, static_cast<std::size_t>(begins[r]), rows_[r].normal, scale * rows_[r].a,
                scale * rows_[r].b, free);
    }
  });
}

void ContactHessian::add_diagonal_blocks(ConstVectors /*q*/, std::span<Mat3> blocks) const {
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const Stiffness& s = rows_[r];
    const Mat3 block = s.b * Mat3::Identity() + (s.a - s.b) * s.normal * s.normal.transpose();
    for (const StepGuard::Weight& w : weights(r))
      blocks[static_cast<std::size_t>(w.vertex)] += w.weight * w.weight * block;
  }
}

}  // namespace muslin
