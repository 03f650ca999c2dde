#include "muslin/solver/eisenstat_pcg.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "muslin/core/index.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

using sweep_kernels::lanes;
using sweep_kernels::matrix_size;
using sweep_kernels::packed_size;
using sweep_kernels::vector_size;

constexpr std::size_t group_grain = 64;  // groups

/// Lanes without a coupling read arbitrary values and multiply them by zero: these must be finite, also after
/// a solve that overflowed.
void clear(const FloatVectors& vectors) {
  for (float* each : {vectors.data().x, vectors.data().y, vectors.data().z})
    std::memset(each, 0, vectors.size() * sizeof(float));
}

/// Returns the index of position i in a vector by group: x, then y and z at offsets of `lanes`.
std::size_t place(std::size_t i) { return i / lanes * vector_size + i % lanes; }

}  // namespace

sweep_kernels::Sweep EisenstatPcg::sweep(const Part& part, int task) const {
  const EliminationOrder& pattern = part.couplings->pattern();
  sweep_kernels::Sweep sweep;
  sweep.group_begin = pattern.tasks()[at(task)].group_begin;
  sweep.group_end = pattern.tasks()[at(task)].group_end;
  sweep.groups = pattern.groups().data();
  sweep.blocks = pattern.blocks().data();
  sweep.links = pattern.links().data();
  sweep.coefficients = part.full ? part.full->coefficients() : part.couplings->coefficients();
  sweep.units = part.full ? part.full->units() : part.couplings->units();
  sweep.pivots = {pivots_.data() + packed_size * part.first_group, pivot_units_.data() + part.first_group};
  sweep.excess = {excess_.data() + packed_size * part.first_group, excess_units_.data() + part.first_group};
  sweep.flat = flat_.data() + static_cast<std::ptrdiff_t>(lanes * part.first_group);
  return sweep;
}

/// The sum of body(kernels, sweep, offset of the part's vectors) over all tasks, phase by phase.
template <class Body>
double EisenstatPcg::forward(const Body& body) const {
  double sum = 0;
  for (const Part& part : parts_) {
    const std::vector<int>& phases = part.couplings->pattern().phases();
    for (std::size_t phase = 0; phase + 1 < phases.size(); ++phase) {
      sum += parallel_sum(at(phases[phase + 1] - phases[phase]), 1, 0.0, [&](std::size_t t, std::size_t) {
        return body(part.kernels(), sweep(part, phases[phase] + static_cast<int>(t)),
                    vector_size * part.first_group);
      });
    }
  }
  return sum;
}

template <class Body>
double EisenstatPcg::backward(const Body& body) const {
  double sum = 0;
  for (const Part& part : parts_) {
    const std::vector<int>& phases = part.couplings->pattern().phases();
    for (std::size_t phase = phases.size() - 1; phase-- > 0;) {
      sum += parallel_sum(at(phases[phase + 1] - phases[phase]), 1, 0.0, [&](std::size_t t, std::size_t) {
        return body(part.kernels(), sweep(part, phases[phase] + static_cast<int>(t)),
                    vector_size * part.first_group);
      });
    }
  }
  return sum;
}

/// body(vertex, position among all); −1 for an empty position. `by_vertex` is the data accessed there, which
/// is prefetched: the elimination order traverses it in as many strides as a level has vertices, which
/// hardware prefetchers do not predict.
template <class Value, class Body>
void EisenstatPcg::for_each_vertex(const Value* by_vertex, const Body& body) const {
  constexpr std::size_t ahead = 64;
  for (const Part& part : parts_) {
    const EliminationOrder& pattern = part.couplings->pattern();
    const std::int64_t first = static_cast<std::int64_t>(part.couplings->first());
    parallel_for(pattern.groups().size(), group_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin * lanes; i < end * lanes; ++i) {
        const int v = pattern.vertex(i), next = pattern.vertex(std::min(i + ahead, end * lanes - 1));
        if (next >= 0) __builtin_prefetch(by_vertex + first + next);
        body(v < 0 ? -1 : first + v, part.first_group * lanes + i);
      }
    });
  }
}

/// The identity and which vertices are free, by position.
void EisenstatPcg::arrange_identity() {
  const float* const identity = h_->identity();
  const std::uint8_t* const fixed = h_->fixed().data();
  const std::size_t count = h_->size();
  std::vector<std::shared_ptr<const EliminationOrder>> patterns;
  for (const SpringHessian* set : h_->sets()) patterns.push_back(set->shared_pattern());
  const bool as_before = patterns == patterns_ && identity_by_vertex_.size() == count &&
                         std::memcmp(identity_by_vertex_.data(), identity, count * sizeof(float)) == 0 &&
                         std::memcmp(fixed_by_vertex_.data(), fixed, count) == 0;
  if (as_before) return;
  patterns_ = std::move(patterns);
  identity_by_vertex_.assign(identity, identity + count);
  fixed_by_vertex_.assign(fixed, fixed + count);
  free_.assign(group_count_, 0);
  for_each_vertex(identity, [&](std::int64_t v, std::size_t i) {
    identity_.data()[i] = v < 0 ? 0 : identity[v];
    if (v >= 0 && fixed[v] == 0)
      free_[i / lanes] = static_cast<std::uint16_t>(free_[i / lanes] | 1U << i % lanes);
  });
}

double EisenstatPcg::factor(Linearization& h) {
  h_ = &h;
  parts_.clear();
  group_count_ = 0;
  for (const SpringHessian* set : h.sets()) {
    parts_.push_back({set, h.full(*set), group_count_});
    group_count_ += set->pattern().groups().size();
  }
  const std::size_t positions = lanes * group_count_;
  identity_.resize(positions);
  for (auto* packed : {&pivots_, &excess_}) packed->resize(packed_size * group_count_);
  for (auto* units : {&pivot_units_, &excess_units_}) units->resize(group_count_);
  rest_.resize(h.has_remainder() ? 6 * positions : 0);
  r_ = h.workspace((h.has_remainder() ? 15 : 12) * positions).data();
  p_ = r_ + 3 * positions;
  x_ = p_ + 3 * positions;
  c_ = x_ + 3 * positions;
  further_ = h.has_remainder() ? c_ + 3 * positions : nullptr;
  flat_.resize(positions);

  arrange_identity();
  if (h.has_remainder()) {
    const Floats upper = h.remainder_upper().data(), lower = h.remainder_lower().data();
    for_each_vertex(upper.x, [&](std::int64_t v, std::size_t i) {
      const float* const from[6] = {upper.x, upper.y, upper.z, lower.x, lower.y, lower.z};
      for (std::size_t k = 0; k < 6; ++k)
        rest_.data()[i / lanes * matrix_size + k * lanes + i % lanes] = v < 0 ? 0 : from[k][v];
    });
  }

  // M by position, for the neighbours, in the memory of the vectors.
  float* const m = r_;
  std::memset(m, 0, 6 * positions * sizeof(float));
  const Floats m_upper = {m, m + positions, m + 2 * positions};
  const Floats m_lower = {m + 3 * positions, m + 4 * positions, m + 5 * positions};
  struct Largest {
    float value = 0;
    Largest operator+(const Largest& other) const { return {std::max(value, other.value)}; }
  };
  Largest stiffest;
  for (const Part& part : parts_) {
    const auto first = static_cast<std::ptrdiff_t>(lanes * part.first_group);
    sweep_kernels::Diagonal diagonal;
    diagonal.identity = identity_.data() + first;
    diagonal.free = free_.data() + part.first_group;
    diagonal.rest = h.has_remainder() ? rest_.data() + 6 * first : nullptr;
    const std::vector<int>& phases = part.couplings->pattern().phases();
    for (std::size_t phase = 0; phase + 1 < phases.size(); ++phase) {
      const auto tasks = at(phases[phase + 1] - phases[phase]);
      stiffest = stiffest + parallel_sum(tasks, 1, Largest{}, [&](std::size_t t, std::size_t) {
                   return Largest{part.kernels().factor(sweep(part, phases[phase] + static_cast<int>(t)),
                                                        diagonal, m_upper + first, m_lower + first)};
                 });
    }
  }
  return std::sqrt(static_cast<double>(stiffest.value));
}

double EisenstatPcg::start(ConstVectors b, double scale) {
  for_each_vertex(b.data(), [&](std::int64_t v, std::size_t i) {
    for (int c = 0; c < 3; ++c)
      r_[place(i) + at(c) * lanes] = v < 0 ? 0 : static_cast<float>(scale * b[at(v)][c]);
  });
  std::memset(p_, 0, 2 * vector_size * group_count_ * sizeof(float));  // and x
  clear(flat_);
  return forward([&](const sweep_kernels::Kernels& kernels, const sweep_kernels::Sweep& sweep,
                     std::size_t offset) { return kernels.solve_forward(sweep, r_ + offset); });
}

double EisenstatPcg::direction(double alpha, double beta) {
  const double curvature = backward(
      [&](const sweep_kernels::Kernels& kernels, const sweep_kernels::Sweep& sweep, std::size_t offset) {
        return kernels.direction(sweep, static_cast<float>(alpha), static_cast<float>(beta), r_ + offset,
                                 x_ + offset, p_ + offset, c_ + offset);
      });
  return h_->has_remainder() ? curvature + add_remainder_product() : curvature;
}

double EisenstatPcg::corrected_direction(double alpha, double beta) {
  const double curvature = backward(
      [&](const sweep_kernels::Kernels& kernels, const sweep_kernels::Sweep& sweep, std::size_t offset) {
        return kernels.corrected_direction(sweep, static_cast<float>(alpha), static_cast<float>(beta),
                                           r_ + offset, x_ + offset, p_ + offset, c_ + offset,
                                           other_.data() + static_cast<std::ptrdiff_t>(offset / 3));
      });
  return h_->has_remainder() ? curvature + add_remainder_product() : curvature;
}

double EisenstatPcg::residual(double alpha) {
  return forward(
      [&](const sweep_kernels::Kernels& kernels, const sweep_kernels::Sweep& sweep, std::size_t offset) {
        return kernels.residual(sweep, static_cast<float>(alpha), c_ + offset,
                                further_ ? further_ + offset : nullptr, r_ + offset);
      });
}

double EisenstatPcg::residual_and_product(double alpha) {
  return forward(
      [&](const sweep_kernels::Kernels& kernels, const sweep_kernels::Sweep& sweep, std::size_t offset) {
        return kernels.residual_and_product(sweep, static_cast<float>(alpha), c_ + offset,
                                            further_ ? further_ + offset : nullptr, r_ + offset,
                                            other_.data() + static_cast<std::ptrdiff_t>(offset / 3));
      });
}

void EisenstatPcg::find_product() {
  other_.resize(flat_.size());
  clear(other_);
  clear(flat_);
  std::memset(c_, 0, (further_ ? 2 : 1) * vector_size * group_count_ * sizeof(float));
  residual_and_product(0);
}

/// further = K t; returns tᵀK t.
double EisenstatPcg::add_remainder_product() {
  t_.resize(h_->size());
  product_.resize(h_->size());
  const Floats from = flat_.data();
  Float4 *const t = t_.data(), *const y = product_.data();
  for_each_vertex(t, [&](std::int64_t v, std::size_t i) {
    if (v < 0) return;
    t[v] = Float4{from.x[i], from.y[i], from.z[i], 0};
    y[v] = Float4{0, 0, 0, 0};
  });
  const double curvature = h_->add_remainder_product(t, y);
  for_each_vertex(y, [&](std::int64_t v, std::size_t i) {
    const Float4 value = v < 0 ? Float4{0, 0, 0, 0} : y[v];
    float* const to = further_ + place(i);
    to[0] = value[0], to[lanes] = value[1], to[2 * lanes] = value[2];
  });
  return curvature;
}

void EisenstatPcg::precondition(double scale, Vectors z) { solve_backward(1, r_, scale, z); }

void EisenstatPcg::solution(double alpha, double scale, Vectors s) { solve_backward(alpha, p_, scale, s); }

/// s = scale · F⁻ᵀ (x̂ + alpha p).
void EisenstatPcg::solve_backward(double alpha, const float* p, double scale, Vectors s) {
  backward([&](const sweep_kernels::Kernels& kernels, const sweep_kernels::Sweep& sweep, std::size_t offset) {
    kernels.solve_backward(sweep, static_cast<float>(alpha), x_ + offset, p + offset);
    return 0.0;
  });
  const Floats t = flat_.data();
  for_each_vertex(s.data(), [&](std::int64_t v, std::size_t i) {
    if (v >= 0) s[at(v)] = scale * Vec3(t.x[i], t.y[i], t.z[i]);
  });
}

std::size_t EisenstatPcg::bytes() const {
  return identity_.bytes() + rest_.bytes() + pivots_.bytes() + excess_.bytes() + pivot_units_.bytes() +
         excess_units_.bytes() + flat_.bytes() + other_.bytes() + free_.capacity() * sizeof(free_[0]) +
         identity_by_vertex_.capacity() * sizeof(float) + fixed_by_vertex_.capacity() + t_.bytes() +
         product_.bytes();
}

}  // namespace muslin
