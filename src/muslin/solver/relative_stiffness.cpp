#include "muslin/solver/relative_stiffness.hpp"

#include <algorithm>

#include "muslin/core/index.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

constexpr std::size_t stiffness_grain = 2048;

}  // namespace

void RelativeStiffness::reset(std::size_t first, std::size_t count) {
  first_ = first;
  count_ = count;
  terms_.clear();
  weights_.clear();
}

RelativeTerms RelativeStiffness::resize(std::size_t terms, std::size_t weights) {
  terms_.resize(terms);
  weights_.resize(weights);
  return {terms_.data(), weights_.data()};
}

void RelativeStiffness::finish() {
  next_.assign(count_, 0);
  for (const RelativeTerms::Weight& w : weights_) ++next_[at(w.vertex)];
  vertices_.clear();
  offsets_.assign(1, 0);
  for (std::size_t v = 0; v < count_; ++v) {
    if (next_[v] == 0) continue;
    vertices_.push_back(static_cast<int>(v));
    offsets_.push_back(offsets_.back() + next_[v]);
    next_[v] = offsets_[offsets_.size() - 2];
  }
  shares_.resize(weights_.size());
  for (std::size_t t = 0; t < terms_.size(); ++t) {
    for (int k = terms_[t].begin; k < terms_[t].end; ++k)
      shares_[at(next_[at(weights_[at(k)].vertex)]++)] = {static_cast<int>(t), weights_[at(k)].weight};
  }
  forces_.resize(terms_.size());
}

double RelativeStiffness::add_product(const Float4* p, Float4* y) {
  const double curvature =
      parallel_sum(terms_.size(), stiffness_grain, 0.0, [&](std::size_t begin, std::size_t end) {
        double sum = 0;
        for (std::size_t t = begin; t < end; ++t) {
          const RelativeTerms::Term& term = terms_[t];
          Float4 u = {0, 0, 0, 0};
          for (int k = term.begin; k < term.end; ++k) u += weights_[at(k)].weight * p[weights_[at(k)].vertex];
          const Float4 n = term.normal * u;
          const Float4 force = term.tangential * u + term.difference * (n[0] + n[1] + n[2]) * term.normal;
          const Float4 work = force * u;
          forces_[t] = force;
          sum += static_cast<double>(work[0] + work[1] + work[2]);
        }
        return sum;
      });
  parallel_for(vertices_.size(), stiffness_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Float4 sum = {0, 0, 0, 0};
      for (int k = offsets_[i]; k < offsets_[i + 1]; ++k)
        sum += shares_[at(k)].weight * forces_[at(shares_[at(k)].term)];
      y[vertices_[i]] += sum;
    }
  });
  return curvature;
}

double RelativeStiffness::add_diagonal(const float* identity, const std::uint8_t* fixed, float most,
                                       Floats upper, Floats lower) const {
  struct Largest {
    float value = 0;
    Largest operator+(const Largest& other) const { return {std::max(value, other.value)}; }
  };
  const auto largest =
      parallel_sum(vertices_.size(), stiffness_grain, Largest{}, [&](std::size_t begin, std::size_t end) {
        Largest ratio;
        for (std::size_t i = begin; i < end; ++i) {
          Float4 x = {0, 0, 0, 0}, y = x;
          float zz = 0;
          for (int k = offsets_[i]; k < offsets_[i + 1]; ++k) {
            const RelativeTerms::Term& term = terms_[at(shares_[at(k)].term)];
            const float square = shares_[at(k)].weight * shares_[at(k)].weight;
            const Float4 n = square * term.difference * term.normal;
            const float tangential = square * term.tangential;
            x += n[0] * term.normal + Float4{tangential, 0, 0, 0};
            y += n[1] * term.normal + Float4{0, tangential, 0, 0};
            zz += n[2] * term.normal[2] + tangential;
          }
          const int v = vertices_[i];
          const float trace = x[0] + y[1] + zz, bound = most * identity[v];
          const float scale = trace > bound ? bound / trace : 1;
          if (fixed[v] == 0) ratio.value = std::max(ratio.value, trace / identity[v]);
          upper.x[v] += scale * x[0], upper.y[v] += scale * x[1], upper.z[v] += scale * x[2];
          lower.x[v] += scale * y[1], lower.y[v] += scale * y[2], lower.z[v] += scale * zz;
        }
        return ratio;
      });
  return static_cast<double>(largest.value);
}

std::size_t RelativeStiffness::bytes() const {
  return terms_.capacity() * sizeof(RelativeTerms::Term) +
         weights_.capacity() * sizeof(RelativeTerms::Weight) +
         (vertices_.capacity() + offsets_.capacity() + next_.capacity()) * sizeof(int) +
         shares_.capacity() * sizeof(Share) + forces_.capacity() * sizeof(Float4);
}

}  // namespace muslin
