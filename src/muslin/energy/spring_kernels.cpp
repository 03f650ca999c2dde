#include "muslin/energy/spring_kernels.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "muslin/core/buffer.hpp"
#include "muslin/core/vector_code.hpp"
#include "muslin/energy/spring_law.hpp"

namespace muslin {
namespace {

constexpr std::array<float, max_springs> ones = [] {
  std::array<float, max_springs> a{};
  a.fill(1);
  return a;
}();

const float* weights_of(const SpringType& type) { return type.weight != nullptr ? type.weight : ones.data(); }

// Each kernel twice: `apart` adds to both ends, none of which is another spring's other end; `buffered`
// leaves the forces in f, for all other cases.

MUSLIN_VECTOR_CODE void spring_forces_apart(double k, double rest, const float* weight, int n, Columns a,
                                            Columns b, Columns y_a, Columns y_b, double* w) {
  const double least = shortest_spring * rest;
  MUSLIN_INDEPENDENT
  for (int i = 0; i < n; ++i) {
    const double zx = b.x[i] - a.x[i], zy = b.y[i] - a.y[i], zz = b.z[i] - a.z[i];
    const SpringLaw::Force force =
        SpringLaw::force(k * static_cast<double>(weight[i]), rest, least, zx, zy, zz);
    w[i] += force.w;
    const double fx = force.f * zx, fy = force.f * zy, fz = force.f * zz;
    y_a.x[i] -= fx, y_a.y[i] -= fy, y_a.z[i] -= fz;
    y_b.x[i] += fx, y_b.y[i] += fy, y_b.z[i] += fz;
  }
}
MUSLIN_VECTOR_CODE void spring_forces_buffered(double k, double rest, const float* weight, int n, Columns a,
                                               Columns b, Columns f, double* w) {
  const double least = shortest_spring * rest;
  MUSLIN_INDEPENDENT
  for (int i = 0; i < n; ++i) {
    const double zx = b.x[i] - a.x[i], zy = b.y[i] - a.y[i], zz = b.z[i] - a.z[i];
    const SpringLaw::Force force =
        SpringLaw::force(k * static_cast<double>(weight[i]), rest, least, zx, zy, zz);
    w[i] += force.w;
    f.x[i] = force.f * zx, f.y[i] = force.f * zy, f.z[i] = force.f * zz;
  }
}
MUSLIN_VECTOR_CODE void spring_energies(double k, double rest, const float* weight, int n, Columns a,
                                        Columns b, double* w) {
  MUSLIN_INDEPENDENT
  for (int i = 0; i < n; ++i) {
    const double zx = b.x[i] - a.x[i], zy = b.y[i] - a.y[i], zz = b.z[i] - a.z[i];
    w[i] += SpringLaw::energy(k * static_cast<double>(weight[i]), rest, zx, zy, zz);
  }
}

MUSLIN_VECTOR_CODE void dashpot_forces_apart(double k, double rest, const float* weight, int n, Columns a,
                                             Columns b, Columns p_a, Columns p_b, Columns y_a, Columns y_b,
                                             double* w) {
  const double least = (shortest_spring * rest) * (shortest_spring * rest);
  MUSLIN_INDEPENDENT
  for (int i = 0; i < n; ++i) {
    const double zx = b.x[i] - a.x[i], zy = b.y[i] - a.y[i], zz = b.z[i] - a.z[i];
    const double dx = p_b.x[i] - p_a.x[i], dy = p_b.y[i] - p_a.y[i], dz = p_b.z[i] - p_a.z[i];
    const SpringLaw::Force force =
        DashpotLaw::force(k * static_cast<double>(weight[i]), least, zx, zy, zz, dx, dy, dz);
    w[i] += force.w;
    const double fx = force.f * zx, fy = force.f * zy, fz = force.f * zz;
    y_a.x[i] -= fx, y_a.y[i] -= fy, y_a.z[i] -= fz;
    y_b.x[i] += fx, y_b.y[i] += fy, y_b.z[i] += fz;
  }
}
MUSLIN_VECTOR_CODE void dashpot_forces_buffered(double k, double rest, const float* weight, int n, Columns a,
                                                Columns b, Columns p_a, Columns p_b, Columns f, double* w) {
  const double least = (shortest_spring * rest) * (shortest_spring * rest);
  MUSLIN_INDEPENDENT
  for (int i = 0; i < n; ++i) {
    const double zx = b.x[i] - a.x[i], zy = b.y[i] - a.y[i], zz = b.z[i] - a.z[i];
    const double dx = p_b.x[i] - p_a.x[i], dy = p_b.y[i] - p_a.y[i], dz = p_b.z[i] - p_a.z[i];
    const SpringLaw::Force force =
        DashpotLaw::force(k * static_cast<double>(weight[i]), least, zx, zy, zz, dx, dy, dz);
    w[i] += force.w;
    f.x[i] = force.f * zx, f.y[i] = force.f * zy, f.z[i] = force.f * zz;
  }
}
MUSLIN_VECTOR_CODE void dashpot_energies(double k, double rest, const float* weight, int n, Columns a,
                                         Columns b, Columns p_a, Columns p_b, double* w) {
  const double least = (shortest_spring * rest) * (shortest_spring * rest);
  MUSLIN_INDEPENDENT
  for (int i = 0; i < n; ++i) {
    const double zx = b.x[i] - a.x[i], zy = b.y[i] - a.y[i], zz = b.z[i] - a.z[i];
    const double dx = p_b.x[i] - p_a.x[i], dy = p_b.y[i] - p_a.y[i], dz = p_b.z[i] - p_a.z[i];
    w[i] += DashpotLaw::force(k * static_cast<double>(weight[i]), least, zx, zy, zz, dx, dy, dz).w;
  }
}

MUSLIN_VECTOR_CODE void spring_products_buffered(double k, double rest, const float* weight, int n, Columns a,
                                                 Columns b, Columns p_a, Columns p_b, Columns f) {
  const double least = shortest_spring * rest;
  MUSLIN_INDEPENDENT
  for (int i = 0; i < n; ++i) {
    const double zx = b.x[i] - a.x[i], zy = b.y[i] - a.y[i], zz = b.z[i] - a.z[i];
    const double dx = p_b.x[i] - p_a.x[i], dy = p_b.y[i] - p_a.y[i], dz = p_b.z[i] - p_a.z[i];
    const SpringLaw::Product c =
        SpringLaw::product(k * static_cast<double>(weight[i]), rest, least, zx, zy, zz, dx, dy, dz);
    f.x[i] = c.z * zx + c.d * dx, f.y[i] = c.z * zy + c.d * dy, f.z[i] = c.z * zz + c.d * dz;
  }
}

// Forces from a buffer to one column of vectors.

MUSLIN_VECTOR_CODE void subtract(const double* __restrict f, int n, double* __restrict y) {
  for (int i = 0; i < n; ++i) y[i] -= f[i];
}
MUSLIN_VECTOR_CODE void add(const double* __restrict f, int n, double* __restrict y) {
  for (int i = 0; i < n; ++i) y[i] += f[i];
}
/// y[i] −= f[i] and y[i + apart] += f[i], apart < n, touching every y once.
MUSLIN_VECTOR_CODE void add_chain(const double* __restrict f, int n, int apart, double* __restrict y) {
  for (int i = 0; i < apart; ++i) y[i] -= f[i];
  for (int i = apart; i < n; ++i) y[i] += f[i - apart] - f[i];
  for (int i = n; i < n + apart; ++i) y[i] += f[i - apart];
}

struct Buffered {
  alignas(64) double x[max_springs], y[max_springs], z[max_springs];
  Columns columns() { return {x, y, z}; }
};

bool apart(const SpringTargets& to, int n) {
  return to.y_a.x != nullptr && to.y_b.x != nullptr && to.b_after_a >= n;
}

void add_buffered(Columns f, int n, const SpringTargets& to) {
  const std::array<const double*, 3> from = {f.x, f.y, f.z};
  const std::array<double*, 3> y_a = {to.y_a.x, to.y_a.y, to.y_a.z}, y_b = {to.y_b.x, to.y_b.y, to.y_b.z};
  for (std::size_t c = 0; c < 3; ++c) {
    if (y_a[c] != nullptr && y_b[c] != nullptr && to.b_after_a < n) {
      add_chain(from[c], n, to.b_after_a, y_a[c]);
      continue;
    }
    if (y_a[c] != nullptr) subtract(from[c], n, y_a[c]);
    if (y_b[c] != nullptr) add(from[c], n, y_b[c]);
  }
}

}  // namespace

std::size_t column_stride(int n) {
  // An odd number of cache lines, so that columns do not compete for the same cache sets.
  return (static_cast<std::size_t>(n) + 1023) / 1024 * 1024 + 168;
}

double* column_memory(std::size_t entries) {
  thread_local Buffer<double> memory;
  if (memory.size() < entries) memory.resize(entries);
  return memory.data();
}

MUSLIN_VECTOR_CODE void load_columns(const double* __restrict vectors, int n, Columns to) {
  MUSLIN_INDEPENDENT
  for (int i = 0; i < n; ++i) {
    to.x[i] = vectors[3 * i];
    to.y[i] = vectors[3 * i + 1];
    to.z[i] = vectors[3 * i + 2];
  }
}

MUSLIN_VECTOR_CODE void load_differences(const double* __restrict p, const double* __restrict q, int n,
                                         Columns to) {
  MUSLIN_INDEPENDENT
  for (int i = 0; i < n; ++i) {
    to.x[i] = p[3 * i] - q[3 * i];
    to.y[i] = p[3 * i + 1] - q[3 * i + 1];
    to.z[i] = p[3 * i + 2] - q[3 * i + 2];
  }
}

void clear_columns(Columns c, int n) {
  for (double* each : {c.x, c.y, c.z}) std::fill_n(each, n, 0.0);
}

MUSLIN_VECTOR_CODE void add_columns(Columns from, int n, double* __restrict vectors) {
  MUSLIN_INDEPENDENT
  for (int i = 0; i < n; ++i) {
    vectors[3 * i] += from.x[i];
    vectors[3 * i + 1] += from.y[i];
    vectors[3 * i + 2] += from.z[i];
  }
}

MUSLIN_VECTOR_CODE double sum_of(const double* w, int n) {
  constexpr int lanes = 8;
  double sum[lanes] = {};
  int i = 0;
  for (; i + lanes <= n; i += lanes)
    for (int l = 0; l < lanes; ++l) sum[l] += w[i + l];
  for (; i < n; ++i) sum[0] += w[i];
  return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
}

void add_spring_energies(const SpringType& type, int n, Columns a, Columns b, double* w) {
  spring_energies(type.k, type.rest, weights_of(type), n, a, b, w);
}

void add_spring_forces(const SpringType& type, int n, Columns a, Columns b, const SpringTargets& to,
                       double* w) {
  if (apart(to, n)) {
    spring_forces_apart(type.k, type.rest, weights_of(type), n, a, b, to.y_a, to.y_b, w);
    return;
  }
  Buffered f;
  spring_forces_buffered(type.k, type.rest, weights_of(type), n, a, b, f.columns(), w);
  add_buffered(f.columns(), n, to);
}

void add_spring_products(const SpringType& type, int n, Columns a, Columns b, Columns p_a, Columns p_b,
                         const SpringTargets& to) {
  Buffered f;
  spring_products_buffered(type.k, type.rest, weights_of(type), n, a, b, p_a, p_b, f.columns());
  add_buffered(f.columns(), n, to);
}

void add_dashpot_forces(const SpringType& type, int n, Columns a, Columns b, Columns p_a, Columns p_b,
                        const SpringTargets& to, double* w) {
  if (apart(to, n)) {
    dashpot_forces_apart(type.k, type.rest, weights_of(type), n, a, b, p_a, p_b, to.y_a, to.y_b, w);
    return;
  }
  Buffered f;
  dashpot_forces_buffered(type.k, type.rest, weights_of(type), n, a, b, p_a, p_b, f.columns(), w);
  add_buffered(f.columns(), n, to);
}

void add_dashpot_energies(const SpringType& type, int n, Columns a, Columns b, Columns p_a, Columns p_b,
                          double* w) {
  dashpot_energies(type.k, type.rest, weights_of(type), n, a, b, p_a, p_b, w);
}

}  // namespace muslin
