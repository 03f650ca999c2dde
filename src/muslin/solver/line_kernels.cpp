#include "muslin/solver/line_kernels.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "muslin/core/vector_code.hpp"

namespace muslin::line_kernels {
namespace {

struct Triple {
  float x, y, z;
};
/// Lower triangular M by rows, or a symmetric matrix: xx, xy, xz, yy, yz, zz in the same places.
struct Six {
  float a00, a10, a20, a11, a21, a22;
};

MUSLIN_INLINE float whole(std::uint16_t bits) { return static_cast<float>(static_cast<std::int16_t>(bits)); }
MUSLIN_INLINE float upper_half(std::uint16_t bits) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(bits) << 16);
}

MUSLIN_INLINE Triple solve(const Six& m, const Triple& u) {
  const float y0 = m.a00 * u.x;
  const float y1 = m.a10 * u.x + m.a11 * u.y;
  const float y2 = m.a20 * u.x + m.a21 * u.y + m.a22 * u.z;
  return {m.a00 * y0 + m.a10 * y1 + m.a20 * y2, m.a11 * y1 + m.a21 * y2, m.a22 * y2};
}
MUSLIN_INLINE Triple couple(float q, float sx, float sy, float sz, float t, const Triple& w) {
  const float along = q * (sx * w.x + sy * w.y + sz * w.z);
  return {along * sx + t * w.x, along * sy + t * w.y, along * sz + t * w.z};
}

/// D⁻¹ = MᵀM from the Cholesky factor D = G Gᵀ, M = G⁻¹. Rounding cannot make a root vanish.
MUSLIN_INLINE Six inverse_factor(const Six& d) {
  constexpr float least = 1e-6F;
  const float m00 = 1.0F / std::sqrt(d.a00);
  const float g10 = d.a10 * m00, g20 = d.a20 * m00;
  const float m11 = 1.0F / std::sqrt(std::max(d.a11 - g10 * g10, least * d.a11));
  const float g21 = (d.a21 - g20 * g10) * m11;
  const float m22 = 1.0F / std::sqrt(std::max(d.a22 - g20 * g20 - g21 * g21, least * d.a22));
  const float m10 = -g10 * m00 * m11;
  const float m21 = -g21 * m11 * m22;
  const float m20 = -(g20 * m00 + g21 * m10) * m22;
  return {m00, m10, m20, m11, m21, m22};
}
/// A − B NᵀN B.
MUSLIN_INLINE Six schur(const Six& a, const Six& b, const Six& n) {
  const float k00 = n.a00 * b.a00, k01 = n.a00 * b.a10, k02 = n.a00 * b.a20;
  const float k10 = n.a10 * b.a00 + n.a11 * b.a10, k11 = n.a10 * b.a10 + n.a11 * b.a11,
              k12 = n.a10 * b.a20 + n.a11 * b.a21;
  const float k20 = n.a20 * b.a00 + n.a21 * b.a10 + n.a22 * b.a20,
              k21 = n.a20 * b.a10 + n.a21 * b.a11 + n.a22 * b.a21,
              k22 = n.a20 * b.a20 + n.a21 * b.a21 + n.a22 * b.a22;
  return {a.a00 - (k00 * k00 + k10 * k10 + k20 * k20), a.a10 - (k00 * k01 + k10 * k11 + k20 * k21),
          a.a20 - (k00 * k02 + k10 * k12 + k20 * k22), a.a11 - (k01 * k01 + k11 * k11 + k21 * k21),
          a.a21 - (k01 * k02 + k11 * k12 + k21 * k22), a.a22 - (k02 * k02 + k12 * k12 + k22 * k22)};
}
MUSLIN_INLINE Six block(float q, float sx, float sy, float sz, float t) {
  return {q * sx * sx + t, q * sx * sy, q * sx * sz, q * sy * sy + t, q * sy * sz, q * sz * sz + t};
}

/// Sixteen vertices at a time, computed apart from where they are stored: the last sixteen reach past the end
/// of what is asked for (all arrays have room for that) and are stored in part.
struct Out {
  alignas(64) float x[lanes], y[lanes], z[lanes];
};
MUSLIN_INLINE void put(Out& out, int l, const Triple& value) {
  out.x[l] = value.x, out.y[l] = value.y, out.z[l] = value.z;
}
template <class Body>
MUSLIN_INLINE void for_each_sixteen(int n, Floats to, const Body& body) {
  int i = 0;
  for (; i + lanes <= n; i += lanes) {
    Out out;
    body(i, out);
    for (int l = 0; l < lanes; ++l) to.x[i + l] = out.x[l];
    for (int l = 0; l < lanes; ++l) to.y[i + l] = out.y[l];
    for (int l = 0; l < lanes; ++l) to.z[i + l] = out.z[l];
  }
  if (i == n) return;
  Out out;
  body(i, out);
  for (int l = 0; l < n - i; ++l) to.x[i + l] = out.x[l], to.y[i + l] = out.y[l], to.z[i + l] = out.z[l];
}
MUSLIN_INLINE Six pivot(const PivotStretch& pivots, int i) {
  return {pivots.unit[0] * pivots.m[0][i], pivots.unit[1] * pivots.m[1][i], pivots.unit[2] * pivots.m[2][i],
          pivots.unit[3] * pivots.m[3][i], pivots.unit[4] * pivots.m[4][i], pivots.unit[5] * pivots.m[5][i]};
}
MUSLIN_INLINE Triple force(const CouplingStretch& b, int i, Floats neighbour) {
  return couple(b.q, whole(b.sx[i]), whole(b.sy[i]), whole(b.sz[i]), std::max(0.0F, upper_half(b.t[i])),
                {neighbour.x[i], neighbour.y[i], neighbour.z[i]});
}

}  // namespace

MUSLIN_VECTOR_CODE void forward(int n, PivotStretch pivots, Floats r, Floats w) {
  for_each_sixteen(
      n, w, [&](int i, Out& out) __attribute__((always_inline)) {
        for (int l = 0; l < lanes; ++l)
          put(out, l, solve(pivot(pivots, i + l), {r.x[i + l], r.y[i + l], r.z[i + l]}));
      });
}

MUSLIN_VECTOR_CODE void forward(int n, PivotStretch pivots, Floats r, CouplingStretch b, Floats neighbour,
                                Floats w) {
  for_each_sixteen(
      n, w, [&](int i, Out& out) __attribute__((always_inline)) {
        for (int l = 0; l < lanes; ++l) {
          const Triple f = force(b, i + l, neighbour);
          put(out, l, solve(pivot(pivots, i + l), {r.x[i + l] + f.x, r.y[i + l] + f.y, r.z[i + l] + f.z}));
        }
      });
}

MUSLIN_VECTOR_CODE void backward(int n, Floats w, Floats z) {
  for_each_sixteen(
      n, z, [&](int i, Out& out) __attribute__((always_inline)) {
        for (int l = 0; l < lanes; ++l)
          put(out, l, {z.x[i + l] + w.x[i + l], z.y[i + l] + w.y[i + l], z.z[i + l] + w.z[i + l]});
      });
}

MUSLIN_VECTOR_CODE void backward(int n, PivotStretch pivots, CouplingStretch b, Floats neighbour, Floats w,
                                 Floats z) {
  for_each_sixteen(
      n, w, [&](int i, Out& out) __attribute__((always_inline)) {
        for (int l = 0; l < lanes; ++l) {
          const Triple s = solve(pivot(pivots, i + l), force(b, i + l, neighbour));
          put(out, l, {w.x[i + l] + s.x, w.y[i + l] + s.y, w.z[i + l] + s.z});
        }
      });
  for_each_sixteen(
      n, z, [&](int i, Out& out) __attribute__((always_inline)) {
        for (int l = 0; l < lanes; ++l)
          put(out, l, {z.x[i + l] + w.x[i + l], z.y[i + l] + w.y[i + l], z.z[i + l] + w.z[i + l]});
      });
}

MUSLIN_VECTOR_CODE double dot(int n, Floats r, Floats z) {
  float sum[lanes] = {};
  int i = 0;
  for (; i + lanes <= n; i += lanes) {
    for (int l = 0; l < lanes; ++l)
      sum[l] += r.x[i + l] * z.x[i + l] + r.y[i + l] * z.y[i + l] + r.z[i + l] * z.z[i + l];
  }
  double total = 0;
  for (; i < n; ++i) total += r.x[i] * z.x[i] + r.y[i] * z.y[i] + r.z[i] * z.z[i];
  for (const float s : sum) total += s;
  return total;
}

MUSLIN_VECTOR_CODE void factor(int n, Floats au, Floats al, const std::uint8_t* fixed, Floats mu, Floats ml) {
  MUSLIN_INDEPENDENT
  for (int i = 0; i < n; ++i) {
    const float free = fixed[i] != 0 ? 0.0F : 1.0F;
    const Six m = inverse_factor({au.x[i], au.y[i], au.z[i], al.x[i], al.y[i], al.z[i]});
    mu.x[i] = free * m.a00, mu.y[i] = free * m.a10, mu.z[i] = free * m.a20;
    ml.x[i] = free * m.a11, ml.y[i] = free * m.a21, ml.z[i] = free * m.a22;
  }
}

MUSLIN_VECTOR_CODE void factor(int n, Floats au, Floats al, const std::uint8_t* fixed, CouplingStretch b,
                               Floats nu, Floats nl, Floats mu, Floats ml) {
  MUSLIN_INDEPENDENT
  for (int i = 0; i < n; ++i) {
    const float free = fixed[i] != 0 ? 0.0F : 1.0F;
    const Six coupling =
        block(b.q, whole(b.sx[i]), whole(b.sy[i]), whole(b.sz[i]), std::max(0.0F, upper_half(b.t[i])));
    const Six d = schur({au.x[i], au.y[i], au.z[i], al.x[i], al.y[i], al.z[i]}, coupling,
                        {nu.x[i], nu.y[i], nu.z[i], nl.x[i], nl.y[i], nl.z[i]});
    const Six m = inverse_factor(d);
    mu.x[i] = free * m.a00, mu.y[i] = free * m.a10, mu.z[i] = free * m.a20;
    ml.x[i] = free * m.a11, ml.y[i] = free * m.a21, ml.z[i] = free * m.a22;
  }
}

MUSLIN_VECTOR_CODE float largest_entry(int n, const float* m) {
  float entry[lanes] = {};
  int i = 0;
  for (; i + lanes <= n; i += lanes)
    for (int l = 0; l < lanes; ++l) entry[l] = std::max(entry[l], std::abs(m[i + l]));
  for (; i < n; ++i) entry[0] = std::max(entry[0], std::abs(m[i]));
  return *std::max_element(entry, entry + lanes);
}

MUSLIN_VECTOR_CODE void quantise(int n, const float* __restrict m, float per_unit,
                                 std::int16_t* __restrict out) {
  for (int i = 0; i < n; ++i) {
    const float scaled = per_unit * m[i];
    out[i] = static_cast<std::int16_t>(static_cast<std::int32_t>(scaled + (scaled < 0 ? -0.5F : 0.5F)));
  }
}

MUSLIN_VECTOR_CODE void solve_bundle(int steps, const std::int16_t* __restrict pivots,
                                     const std::uint16_t* __restrict couplings, const float* __restrict units,
                                     float* __restrict buffer) {
  const auto pivot = [&](int step, int l) __attribute__((always_inline)) {
    const std::int16_t* const m = pivots + 6 * lanes * step + l;
    return Six{units[l] * m[0],
               units[lanes + l] * m[lanes],
               units[2 * lanes + l] * m[2 * lanes],
               units[3 * lanes + l] * m[3 * lanes],
               units[4 * lanes + l] * m[4 * lanes],
               units[5 * lanes + l] * m[5 * lanes]};
  };
  const auto force = [&](int step, int l, const Triple& w) __attribute__((always_inline)) {
    const std::uint16_t* const c = couplings + 4 * lanes * step + l;
    const float unit = units[6 * lanes + l];
    return couple(unit * unit, whole(c[0]), whole(c[lanes]), whole(c[2 * lanes]), upper_half(c[3 * lanes]),
                  w);
  };
  for (int l = 0; l < lanes; ++l) {
    float* const at = buffer + l;
    const Triple w = solve(pivot(0, l), {at[0], at[lanes], at[2 * lanes]});
    at[0] = w.x, at[lanes] = w.y, at[2 * lanes] = w.z;
  }
  for (int step = 1; step < steps; ++step) {
    float* const row = buffer + 3 * lanes * step;
    for (int l = 0; l < lanes; ++l) {
      float* const at = row + l;
      const float* const before = at - 3 * lanes;
      const Triple f = force(step - 1, l, {before[0], before[lanes], before[2 * lanes]});
      const Triple w = solve(pivot(step, l), {at[0] + f.x, at[lanes] + f.y, at[2 * lanes] + f.z});
      at[0] = w.x, at[lanes] = w.y, at[2 * lanes] = w.z;
    }
  }
  for (int step = steps - 2; step >= 0; --step) {
    float* const row = buffer + 3 * lanes * step;
    for (int l = 0; l < lanes; ++l) {
      float* const at = row + l;
      const float* const after = at + 3 * lanes;
      const Triple f = force(step, l, {after[0], after[lanes], after[2 * lanes]});
      const Triple w = solve(pivot(step, l), f);
      at[0] += w.x, at[lanes] += w.y, at[2 * lanes] += w.z;
    }
  }
}

MUSLIN_VECTOR_CODE void factor_lanes(const float* __restrict a, const float* __restrict b,
                                     const float* __restrict before, float* __restrict m) {
  constexpr int n = lanes;
  for (int l = 0; l < n; ++l) {
    const Six coupling = block(1, b[l], b[n + l], b[2 * n + l], b[3 * n + l]);
    const Six d = schur({a[l], a[n + l], a[2 * n + l], a[3 * n + l], a[4 * n + l], a[5 * n + l]}, coupling,
                        {before[l], before[n + l], before[2 * n + l], before[3 * n + l], before[4 * n + l],
                         before[5 * n + l]});
    const Six out = inverse_factor(d);
    m[l] = out.a00, m[n + l] = out.a10, m[2 * n + l] = out.a20;
    m[3 * n + l] = out.a11, m[4 * n + l] = out.a21, m[5 * n + l] = out.a22;
  }
}

MUSLIN_VECTOR_CODE void quantise_bundle(int steps, const float* __restrict pivots,
                                        const float* __restrict couplings, const float* __restrict per_unit,
                                        std::int16_t* __restrict pivots_out,
                                        std::uint16_t* __restrict couplings_out) {
  const auto rounded = [](float scaled) __attribute__((always_inline)) {
    return static_cast<std::int16_t>(static_cast<std::int32_t>(scaled + (scaled < 0 ? -0.5F : 0.5F)));
  };
  for (int step = 0; step < steps; ++step) {
    for (int k = 0; k < 6 * lanes; ++k)
      pivots_out[6 * lanes * step + k] = rounded(per_unit[k] * pivots[6 * lanes * step + k]);
    for (int k = 0; k < 3; ++k) {
      for (int l = 0; l < lanes; ++l) {
        const int i = (4 * step + k) * lanes + l;
        couplings_out[i] = static_cast<std::uint16_t>(rounded(per_unit[6 * lanes + l] * couplings[i]));
      }
    }
    for (int l = 0; l < lanes; ++l) {
      const int i = (4 * step + 3) * lanes + l;
      const auto bits = std::bit_cast<std::uint32_t>(couplings[i]);
      couplings_out[i] = static_cast<std::uint16_t>((bits + 0x7fffU + (bits >> 16 & 1U)) >> 16);
    }
  }
}

double update_and_solve(float alpha, const std::array<float, 6>& m, Floats q, Floats r, Floats z) {
  *r.x -= alpha * *q.x, *r.y -= alpha * *q.y, *r.z -= alpha * *q.z;
  const Triple out = solve({m[0], m[1], m[2], m[3], m[4], m[5]}, {*r.x, *r.y, *r.z});
  *z.x = out.x, *z.y = out.y, *z.z = out.z;
  return static_cast<double>(*r.x) * out.x + static_cast<double>(*r.y) * out.y +
         static_cast<double>(*r.z) * out.z;
}

void gather(int steps, int lane, Floats r, float* to) {
  float* at = to + lane;
  for (int i = 0; i < steps; ++i, at += 3 * lanes) {
    at[0] = r.x[i];
    at[lanes] = r.y[i];
    at[2 * lanes] = r.z[i];
  }
}

MUSLIN_VECTOR_CODE void subtract(int n, float alpha, Floats q, Floats r) {
  MUSLIN_INDEPENDENT
  for (int i = 0; i < n; ++i) {
    r.x[i] -= alpha * q.x[i];
    r.y[i] -= alpha * q.y[i];
    r.z[i] -= alpha * q.z[i];
  }
}

void update_and_gather(int steps, int lane, float alpha, Floats q, Floats r, float* to) {
  subtract(steps, alpha, q, r);
  gather(steps, lane, r, to);
}

void scatter(int steps, int lane, const float* from, Floats z) {
  const float* at = from + lane;
  for (int i = 0; i < steps; ++i, at += 3 * lanes) {
    z.x[i] = at[0];
    z.y[i] = at[lanes];
    z.z[i] = at[2 * lanes];
  }
}

}  // namespace muslin::line_kernels
