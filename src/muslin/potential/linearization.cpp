#include "muslin/potential/linearization.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "muslin/core/parallel.hpp"
#include "muslin/core/vector_code.hpp"
#include "muslin/potential/potential.hpp"

namespace muslin {
namespace {

constexpr std::size_t grain = 4096;

double dot(Floats a, Floats b, std::size_t begin, std::size_t end) {
  double sum = 0;
  for (std::size_t v = begin; v < end; ++v) {
    sum += static_cast<double>(a.x[v]) * b.x[v] + static_cast<double>(a.y[v]) * b.y[v] +
           static_cast<double>(a.z[v]) * b.z[v];
  }
  return sum;
}

/// Calls body(begin, end) for the stretches of vertices that no set of couplings covers; sets in ascending
/// order of their first vertex.
template <class Body>
void for_each_gap(std::span<const Couplings* const> sets, std::size_t size, const Body& body) {
  std::size_t at = 0;
  for (const Couplings* set : sets) {
    if (set->first() > at) body(at, set->first());
    at = set->first() + static_cast<std::size_t>(set->pattern().vertex_count());
  }
  if (at < size) body(at, size);
}

}  // namespace

void Linearization::reset(std::span<const double> masses, std::span<const std::uint8_t> fixed, double scale) {
  masses_ = masses;
  fixed_ = fixed;
  scale_ = scale;
  sets_.clear();
  matrices_.clear();
  generals_.clear();
  owned_.clear();
  identity_.resize(masses.size());
  for (std::size_t v = 0; v < masses.size(); ++v) identity_.data()[v] = static_cast<float>(masses[v]);
}

Couplings& Linearization::couplings(const std::shared_ptr<const CouplingPattern>& pattern,
                                    std::size_t first) {
  const auto is_it = [&](const Couplings& c) { return &c.pattern() == pattern.get() && c.first() == first; };
  const auto stored =
      std::find_if(storage_.begin(), storage_.end(), [&](const auto& c) { return is_it(*c); });
  if (stored != storage_.end()) {
    Couplings& set = **stored;
    if (std::find(sets_.begin(), sets_.end(), &set) == sets_.end()) {
      set.reset(pattern, first);
      sets_.push_back(&set);
    }
    return set;
  }
  storage_.push_back(std::make_unique<Couplings>());
  storage_.back()->reset(pattern, first);
  sets_.push_back(storage_.back().get());
  return *storage_.back();
}

BlockMatrix& Linearization::matrix(const std::shared_ptr<const BlockPattern>& pattern, std::size_t first) {
  const auto stored = std::find_if(matrix_storage_.begin(), matrix_storage_.end(),
                                   [&](const auto& m) { return m->is_of(pattern) && m->first() == first; });
  const bool is_new = stored == matrix_storage_.end();
  if (is_new) matrix_storage_.push_back(std::make_unique<BlockMatrix>());
  BlockMatrix& matrix = is_new ? *matrix_storage_.back() : **stored;
  if (std::find(matrices_.begin(), matrices_.end(), &matrix) == matrices_.end()) {
    matrix.reset(pattern, first);
    matrices_.push_back(&matrix);
  }
  return matrix;
}

void Linearization::add_general(const Potential& potential, std::size_t first, ConstVectors x) {
  generals_.push_back({&potential, first, x});
}

void Linearization::add_general(std::shared_ptr<const Potential> potential, std::size_t first,
                                ConstVectors x) {
  owned_.push_back(std::move(potential));
  add_general(*owned_.back(), first, x);
}

void Linearization::finish() {
  // Sets of other bodies than before are of no use any more.
  std::erase_if(storage_,
                [&](const auto& c) { return std::find(sets_.begin(), sets_.end(), c.get()) == sets_.end(); });
  std::erase_if(matrix_storage_, [&](const auto& m) {
    return std::find(matrices_.begin(), matrices_.end(), m.get()) == matrices_.end();
  });
  std::sort(sets_.begin(), sets_.end(),
            [](const Couplings* p, const Couplings* q) { return p->first() < q->first(); });
  upper_.resize(size());
  lower_.resize(size());
  const Floats u = upper_.data(), l = lower_.data();
  const float* const m = identity_.data();
  parallel_for(size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      u.x[v] = l.x[v] = l.z[v] = m[v];
      u.y[v] = u.z[v] = l.y[v] = 0;
    }
  });
  for (const Couplings* set : sets_) {
    const auto first = static_cast<std::ptrdiff_t>(set->first());
    set->add_diagonal(u + first, l + first);
  }
  for (const BlockMatrix* matrix : matrices_) {
    const auto first = static_cast<std::ptrdiff_t>(matrix->first());
    matrix->add_diagonal(u + first, l + first);
  }
  if (!generals_.empty()) {
    blocks_.assign(size(), Mat3::Zero());
    for (const General& g : generals_)
      g.potential->add_diagonal_blocks(g.x, std::span(blocks_).subspan(g.first, g.x.size()));
    for (std::size_t v = 0; v < size(); ++v) {
      const Mat3 block = scale_ * blocks_[v];
      u.x[v] += static_cast<float>(block(0, 0));
      u.y[v] += static_cast<float>(block(1, 0));
      u.z[v] += static_cast<float>(block(2, 0));
      l.x[v] += static_cast<float>(block(1, 1));
      l.y[v] += static_cast<float>(block(2, 1));
      l.z[v] += static_cast<float>(block(2, 2));
    }
  }
  struct Largest {
    double value = 0;
    Largest operator+(const Largest& other) const { return {std::max(value, other.value)}; }
  };
  stiffest_ =
      parallel_sum(size(), grain, Largest{}, [&](std::size_t begin, std::size_t end) {
        double largest = 0;
        for (std::size_t v = begin; v < end; ++v) {
          if (fixed_[v] != 0) continue;
          const double m_v = masses_[v];
          const auto part = [&](float a) { return a / m_v; };
          const double square =
              part(u.x[v]) * part(u.x[v]) + part(l.x[v]) * part(l.x[v]) + part(l.z[v]) * part(l.z[v]) +
              2 * (part(u.y[v]) * part(u.y[v]) + part(u.z[v]) * part(u.z[v]) + part(l.y[v]) * part(l.y[v]));
          largest = std::max(largest, square);
        }
        return Largest{largest};
      }).value;
  stiffest_ = std::sqrt(stiffest_);
}

double Linearization::product(const FloatVectors& p, FloatVectors& y) {
  const Floats from = p.data(), to = y.data();
  double sum = 0;
  for (const Couplings* set : sets_) {
    const auto first = static_cast<std::ptrdiff_t>(set->first());
    sum += set->product(identity_.data() + first, from + first, to + first);
  }
  for_each_gap(sets_, size(), [&](std::size_t begin, std::size_t end) {
    const float* const m = identity_.data();
    for (std::size_t v = begin; v < end; ++v) {
      to.x[v] = m[v] * from.x[v];
      to.y[v] = m[v] * from.y[v];
      to.z[v] = m[v] * from.z[v];
    }
    sum += dot(from, to, begin, end);
  });
  for (const BlockMatrix* matrix : matrices_) {
    const auto first = static_cast<std::ptrdiff_t>(matrix->first());
    sum += matrix->add_product(from + first, to + first);
  }
  if (generals_.empty()) return sum;

  p_.resize(size());
  y_.resize(size());
  parallel_for(size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) p_[v] = Vec3(from.x[v], from.y[v], from.z[v]);
    std::fill(y_.begin() + static_cast<std::ptrdiff_t>(begin), y_.begin() + static_cast<std::ptrdiff_t>(end),
              Vec3::Zero());
  });
  for (const General& g : generals_) {
    g.potential->add_hessian_product(g.x, std::span(p_).subspan(g.first, g.x.size()),
                                     std::span(y_).subspan(g.first, g.x.size()));
  }
  return parallel_sum(size(), grain, 0.0, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      to.x[v] += static_cast<float>(scale_ * y_[v].x());
      to.y[v] += static_cast<float>(scale_ * y_[v].y());
      to.z[v] += static_cast<float>(scale_ * y_[v].z());
    }
    return dot(from, to, begin, end);
  });
}

std::size_t Linearization::bytes() const {
  std::size_t bytes = identity_.bytes() + upper_.bytes() + lower_.bytes() +
                      (p_.capacity() + y_.capacity()) * sizeof(Vec3) + blocks_.capacity() * sizeof(Mat3);
  for (const auto& set : storage_) bytes += set->bytes();
  for (const auto& matrix : matrix_storage_) bytes += matrix->bytes();
  return bytes;
}

}  // namespace muslin
