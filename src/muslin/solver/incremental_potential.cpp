#include "muslin/solver/incremental_potential.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "muslin/core/vector_code.hpp"
#include "muslin/solver/vector_operations.hpp"

namespace muslin {
namespace {

constexpr int inertia_chunk = 256;  // vertices whose terms are kept in the first-level cache

/// w = ½ m |x − x̃|²
MUSLIN_VECTOR_CODE void inertia(const double* __restrict x, const double* __restrict prediction,
                                const double* __restrict m, int n, double* __restrict w) {
  for (int i = 0; i < n; ++i) {
    const double dx = x[3 * i] - prediction[3 * i], dy = x[3 * i + 1] - prediction[3 * i + 1],
                 dz = x[3 * i + 2] - prediction[3 * i + 2];
    w[i] = 0.5 * m[i] * (dx * dx + dy * dy + dz * dz);
  }
}
/// w = ½ m |x − x̃|², g = scale g + m (x − x̃), zero on held vertices, squares = |g|² and ratios = |g|² / m².
MUSLIN_VECTOR_CODE void inertia_and_gradient(const double* __restrict x, const double* __restrict prediction,
                                             const double* __restrict m, const std::uint8_t* __restrict held,
                                             double scale, int n, double* __restrict g, double* __restrict w,
                                             double* __restrict squares, double* __restrict ratios) {
  for (int i = 0; i < n; ++i) {
    const double dx = x[3 * i] - prediction[3 * i], dy = x[3 * i + 1] - prediction[3 * i + 1],
                 dz = x[3 * i + 2] - prediction[3 * i + 2];
    w[i] = 0.5 * m[i] * (dx * dx + dy * dy + dz * dz);
    const double gx = scale * g[3 * i] + m[i] * dx, gy = scale * g[3 * i + 1] + m[i] * dy,
                 gz = scale * g[3 * i + 2] + m[i] * dz;
    const bool free = held[i] == 0;
    g[3 * i] = free ? gx : 0.0;
    g[3 * i + 1] = free ? gy : 0.0;
    g[3 * i + 2] = free ? gz : 0.0;
    squares[i] = free ? gx * gx + gy * gy + gz * gz : 0.0;
    ratios[i] = squares[i] / (m[i] * m[i]);
  }
}
/// squares = |g|² and ratios = |g|² / m², zero on held vertices.
MUSLIN_VECTOR_CODE void squared_accelerations(const double* __restrict g, const double* __restrict m,
                                              const std::uint8_t* __restrict held, int n,
                                              double* __restrict squares, double* __restrict ratios) {
  for (int i = 0; i < n; ++i) {
    const double square = g[3 * i] * g[3 * i] + g[3 * i + 1] * g[3 * i + 1] + g[3 * i + 2] * g[3 * i + 2];
    squares[i] = held[i] == 0 ? square : 0.0;
    ratios[i] = squares[i] / (m[i] * m[i]);
  }
}
/// Sums in independent lanes, for instruction-level parallelism.
MUSLIN_VECTOR_CODE double sum_of(const double* w, int n) {
  constexpr int lanes = 8;
  double sum[lanes] = {};
  int i = 0;
  for (; i + lanes <= n; i += lanes)
    for (int l = 0; l < lanes; ++l) sum[l] += w[i + l];
  for (; i < n; ++i) sum[0] += w[i];
  return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
}

/// Lane-wise maximum; NaNs are ignored.
MUSLIN_VECTOR_CODE double largest_of(const double* w, int n) {
  constexpr int lanes = 8;
  double largest[lanes] = {};
  int i = 0;
  for (; i + lanes <= n; i += lanes)
    for (int l = 0; l < lanes; ++l) largest[l] = w[i + l] > largest[l] ? w[i + l] : largest[l];
  for (; i < n; ++i) largest[0] = std::max(largest[0], w[i]);
  return *std::max_element(largest, largest + lanes);
}
MUSLIN_VECTOR_CODE double largest_magnitude(const double* w, int n) {
  constexpr int lanes = 8;
  double largest[lanes] = {};
  int i = 0;
  for (; i + lanes <= n; i += lanes) {
    for (int l = 0; l < lanes; ++l) {
      const double magnitude = std::abs(w[i + l]);
      largest[l] = magnitude > largest[l] ? magnitude : largest[l];
    }
  }
  for (; i < n; ++i) largest[0] = std::max(largest[0], std::abs(w[i]));
  return *std::max_element(largest, largest + lanes);
}

/// The largest ratio, the first of equal ones, and the sum of the squares.
struct Worst {
  double ratio = 0;
  int vertex = -1;
  double square = 0;

  // Detects NaN, which compares false with everything.
  void consider(double r, int v) {
    if (!(r <= ratio) && !std::isnan(ratio)) ratio = r, vertex = v;
  }
  void consider(const double* squares, const double* ratios, int n, std::size_t first) {
    const double sum = sum_of(squares, n);
    square += sum;
    if (largest_of(ratios, n) <= ratio && std::isfinite(sum)) return;
    for (int i = 0; i < n; ++i) consider(ratios[i], static_cast<int>(first) + i);
  }
  Worst operator+(const Worst& later) const {
    Worst worst = *this;
    worst.consider(later.ratio, later.vertex);
    worst.square += later.square;
    return worst;
  }
};

IncrementalPotential::Imbalance imbalance_of(const Worst& worst, double dt) {
  return {std::sqrt(worst.ratio) / (dt * dt), worst.vertex, std::sqrt(worst.square)};
}

/// Calls body(first, n) for chunks of [begin, end).
template <class Body>
void for_each_chunk(std::size_t begin, std::size_t end, const Body& body) {
  for (std::size_t v = begin; v < end; v += inertia_chunk)
    body(v, static_cast<int>(std::min<std::size_t>(inertia_chunk, end - v)));
}

}  // namespace

struct IncrementalPotential::Inertia {
  double value = 0;
  Worst worst;

  Inertia operator+(const Inertia& later) const { return {value + later.value, worst + later.worst}; }
};

IncrementalPotential::IncrementalPotential(const StepProblem& problem, ConstVectors prediction, double dt)
    : problem_(problem), prediction_(prediction), dt_(dt) {}

IncrementalPotential::Value IncrementalPotential::value(ConstVectors x) const {
  const double inertial = parallel_sum(size(), vector_grain, 0.0, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for_each_chunk(begin, end, [&](std::size_t v, int n) {
      alignas(64) double w[inertia_chunk];
      inertia(x[v].data(), prediction_[v].data(), &problem_.masses[v], n, w);
      sum += sum_of(w, n);
    });
    return sum;
  });
  Value result{inertial, inertial};
  for (const Potential* potential : problem_.potentials) result += dt_ * dt_ * potential->value(x);
  return result;
}

/// g becomes dt² g plus the gradient of the inertial term.
IncrementalPotential::Inertia IncrementalPotential::add_inertia(ConstVectors x, Vectors g) const {
  return parallel_sum(size(), vector_grain, Inertia{}, [&](std::size_t begin, std::size_t end) {
    Inertia sum;
    for_each_chunk(begin, end, [&](std::size_t v, int n) {
      alignas(64) double w[inertia_chunk], squares[inertia_chunk], ratios[inertia_chunk];
      inertia_and_gradient(x[v].data(), prediction_[v].data(), &problem_.masses[v], &problem_.fixed[v],
                           dt_ * dt_, n, g[v].data(), w, squares, ratios);
      sum.value += sum_of(w, n);
      sum.worst.consider(squares, ratios, n, v);
    });
    return sum;
  });
}

void IncrementalPotential::gradient(ConstVectors x, Vectors g) const {
  set_zero(g);
  for (const Potential* potential : problem_.potentials) potential->add_gradient(x, g);
  add_inertia(x, g);
}

IncrementalPotential::Evaluation IncrementalPotential::evaluate(ConstVectors x, Vectors g) const {
  set_zero(g);
  std::vector<double> terms;
  for (const Potential* potential : problem_.potentials)
    terms.push_back(dt_ * dt_ * potential->add_gradient_and_value(x, g));
  const Inertia inertia = add_inertia(x, g);
  Evaluation result{{inertia.value, inertia.value}, imbalance_of(inertia.worst, dt_)};
  for (const double term : terms) result.value += term;
  return result;
}

IncrementalPotential::Value IncrementalPotential::value_and_gradient(ConstVectors x, Vectors g) const {
  return evaluate(x, g).value;
}

void IncrementalPotential::hessian_product(ConstVectors x, ConstVectors p, Vectors y) const {
  set_zero(y);
  for (const Potential* potential : problem_.potentials) potential->add_hessian_product(x, p, y);
  parallel_for(size(), vector_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      y[v] = held(v) ? Vec3(Vec3::Zero()) : Vec3(dt_ * dt_ * y[v] + problem_.masses[v] * p[v]);
    }
  });
}

void IncrementalPotential::diagonal_blocks(ConstVectors x, std::span<Mat3> blocks) const {
  std::fill(blocks.begin(), blocks.end(), Mat3::Zero());
  for (const Potential* potential : problem_.potentials) potential->add_diagonal_blocks(x, blocks);
  parallel_for(size(), vector_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      if (held(v)) {
        blocks[v].setZero();
      } else {
        blocks[v] *= dt_ * dt_;
      }
      blocks[v].diagonal().array() += problem_.masses[v];
    }
  });
}

void IncrementalPotential::linearize(ConstVectors x, Linearization& into) const {
  into.reset(problem_.masses, problem_.fixed, dt_ * dt_);
  for (const Potential* potential : problem_.potentials) potential->linearize(x, into, 0);
  into.finish();
}

double IncrementalPotential::max_step(ConstVectors x, ConstVectors d) const {
  double t = std::numeric_limits<double>::infinity();
  for (const Potential* potential : problem_.potentials) t = std::min(t, potential->max_step(x, d));
  return t;
}

IncrementalPotential::Imbalance IncrementalPotential::imbalance(ConstVectors g) const {
  const Worst worst = parallel_sum(size(), vector_grain, Worst{}, [&](std::size_t begin, std::size_t end) {
    Worst of_block;
    for_each_chunk(begin, end, [&](std::size_t v, int n) {
      alignas(64) double squares[inertia_chunk], ratios[inertia_chunk];
      squared_accelerations(g[v].data(), &problem_.masses[v], &problem_.fixed[v], n, squares, ratios);
      of_block.consider(squares, ratios, n, v);
    });
    return of_block;
  });
  return imbalance_of(worst, dt_);
}

double IncrementalPotential::rounding_floor(ConstVectors x, double stiffest) const {
  constexpr double half_ulp = std::numeric_limits<double>::epsilon() / 2;
  struct Largest {
    double value = 0;
    Largest operator+(const Largest& other) const { return {std::max(value, other.value)}; }
  };
  const double farthest =  // coordinate [m]
      parallel_sum(x.size(), vector_grain, Largest{}, [&](std::size_t begin, std::size_t end) {
        Largest largest;
        for_each_chunk(begin, end, [&](std::size_t v, int n) {
          largest.value = std::max(largest.value, largest_magnitude(x[v].data(), 3 * n));
        });
        return largest;
      }).value;
  // The neighbours' couplings sum to at most the diagonal block.
  return 2 * stiffest / (dt_ * dt_) * farthest * half_ulp;
}

}  // namespace muslin
