#include "muslin/potential/couplings.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "muslin/core/parallel.hpp"
#include "muslin/core/vector_code.hpp"

namespace muslin {
namespace {

constexpr int block_size = CouplingPattern::block_size;
constexpr float largest = 32767;
constexpr std::size_t room = 64;  // vector code may read this far past the end

MUSLIN_INLINE float upper_half(std::uint16_t bits) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(bits) << 16);
}
MUSLIN_INLINE float whole(std::uint16_t bits) { return static_cast<float>(static_cast<std::int16_t>(bits)); }

/// Which ends of the couplings of a piece are written to.
enum class Ends { both, a, b };

/// f = B (p_b − p_a), y_a −= f, y_b += f.
template <Ends ends>
MUSLIN_INLINE void apply_piece(const std::uint16_t* __restrict c, float q, int n, Floats pa, Floats pb,
                               Floats ya, Floats yb) {
  alignas(64) float fx[block_size], fy[block_size], fz[block_size];
  for (int i = 0; i < n; ++i) {
    const float dx = pb.x[i] - pa.x[i], dy = pb.y[i] - pa.y[i], dz = pb.z[i] - pa.z[i];
    const float sx = whole(c[i]), sy = whole(c[n + i]), sz = whole(c[2 * n + i]);
    const float t = upper_half(c[3 * n + i]);
    const float along = q * (sx * dx + sy * dy + sz * dz);
    fx[i] = along * sx + t * dx;
    fy[i] = along * sy + t * dy;
    fz[i] = along * sz + t * dz;
  }
  if constexpr (ends != Ends::b) {
    for (int i = 0; i < n; ++i) ya.x[i] -= fx[i];
    for (int i = 0; i < n; ++i) ya.y[i] -= fy[i];
    for (int i = 0; i < n; ++i) ya.z[i] -= fz[i];
  }
  if constexpr (ends != Ends::a) {
    for (int i = 0; i < n; ++i) yb.x[i] += fx[i];
    for (int i = 0; i < n; ++i) yb.y[i] += fy[i];
    for (int i = 0; i < n; ++i) yb.z[i] += fz[i];
  }
}

MUSLIN_VECTOR_CODE void apply_own(const std::uint16_t* c, float q, int n, Floats pa, Floats pb, Floats ya,
                                  Floats yb) {
  apply_piece<Ends::both>(c, q, n, pa, pb, ya, yb);
}
/// The same where the two ends' vertices are apart, so that nothing need be kept in between.
MUSLIN_VECTOR_CODE void apply_apart(const std::uint16_t* __restrict c, float q, int n, Floats pa, Floats pb,
                                    Floats ya, Floats yb) {
  MUSLIN_INDEPENDENT
  for (int i = 0; i < n; ++i) {
    const float dx = pb.x[i] - pa.x[i], dy = pb.y[i] - pa.y[i], dz = pb.z[i] - pa.z[i];
    const float sx = whole(c[i]), sy = whole(c[n + i]), sz = whole(c[2 * n + i]);
    const float t = upper_half(c[3 * n + i]);
    const float along = q * (sx * dx + sy * dy + sz * dz);
    const float fx = along * sx + t * dx, fy = along * sy + t * dy, fz = along * sz + t * dz;
    ya.x[i] -= fx, ya.y[i] -= fy, ya.z[i] -= fz;
    yb.x[i] += fx, yb.y[i] += fy, yb.z[i] += fz;
  }
}
MUSLIN_VECTOR_CODE void apply_to_a(const std::uint16_t* c, float q, int n, Floats pa, Floats pb, Floats ya) {
  apply_piece<Ends::a>(c, q, n, pa, pb, ya, ya);
}
MUSLIN_VECTOR_CODE void apply_to_b(const std::uint16_t* c, float q, int n, Floats pa, Floats pb, Floats yb) {
  apply_piece<Ends::b>(c, q, n, pa, pb, yb, yb);
}

MUSLIN_VECTOR_CODE void start_product(const float* __restrict m, int n, Floats p, Floats y) {
  float* __restrict yx = y.x;
  float* __restrict yy = y.y;
  float* __restrict yz = y.z;
  for (int i = 0; i < n; ++i) {
    yx[i] = m[i] * p.x[i];
    yy[i] = m[i] * p.y[i];
    yz[i] = m[i] * p.z[i];
  }
}

MUSLIN_VECTOR_CODE double dot_product(int n, Floats p, Floats y) {
  constexpr int lanes = 16;
  float sum[lanes] = {};
  int i = 0;
  for (; i + lanes <= n; i += lanes) {
    for (int l = 0; l < lanes; ++l)
      sum[l] += p.x[i + l] * y.x[i + l] + p.y[i + l] * y.y[i + l] + p.z[i + l] * y.z[i + l];
  }
  double total = 0;
  for (; i < n; ++i) total += p.x[i] * y.x[i] + p.y[i] * y.y[i] + p.z[i] * y.z[i];
  for (float s : sum) total += s;
  return total;
}

template <Ends ends>
MUSLIN_INLINE void add_blocks(const std::uint16_t* __restrict c, float q, int n, Floats ua, Floats la,
                              Floats ub, Floats lb) {
  alignas(64) float b[6][block_size];
  for (int i = 0; i < n; ++i) {
    const float sx = whole(c[i]), sy = whole(c[n + i]), sz = whole(c[2 * n + i]);
    const float t = std::max(0.0F, upper_half(c[3 * n + i]));
    b[0][i] = q * sx * sx + t;
    b[1][i] = q * sx * sy;
    b[2][i] = q * sx * sz;
    b[3][i] = q * sy * sy + t;
    b[4][i] = q * sy * sz;
    b[5][i] = q * sz * sz + t;
  }
  float* const a_side[6] = {ua.x, ua.y, ua.z, la.x, la.y, la.z};
  float* const b_side[6] = {ub.x, ub.y, ub.z, lb.x, lb.y, lb.z};
  for (int k = 0; k < 6; ++k) {
    if constexpr (ends != Ends::b)
      for (int i = 0; i < n; ++i) a_side[k][i] += b[k][i];
    if constexpr (ends != Ends::a)
      for (int i = 0; i < n; ++i) b_side[k][i] += b[k][i];
  }
}
MUSLIN_VECTOR_CODE void add_blocks_own(const std::uint16_t* c, float q, int n, Floats ua, Floats la,
                                       Floats ub, Floats lb) {
  add_blocks<Ends::both>(c, q, n, ua, la, ub, lb);
}
MUSLIN_VECTOR_CODE void add_blocks_one(const std::uint16_t* c, float q, int n, Floats u, Floats l) {
  add_blocks<Ends::a>(c, q, n, u, l, u, l);
}

MUSLIN_VECTOR_CODE void load_piece(const std::uint16_t* __restrict c, float unit, int n, float* __restrict sx,
                                   float* __restrict sy, float* __restrict sz, float* __restrict t) {
  for (int i = 0; i < n; ++i) {
    sx[i] = unit * whole(c[i]);
    sy[i] = unit * whole(c[n + i]);
    sz[i] = unit * whole(c[2 * n + i]);
    t[i] = upper_half(c[3 * n + i]);
  }
}
MUSLIN_VECTOR_CODE float largest_entry(int n, const float* x, const float* y, const float* z) {
  constexpr int lanes = 16;
  float entry[lanes] = {};
  int i = 0;
  for (; i + lanes <= n; i += lanes) {
    for (int l = 0; l < lanes; ++l) {
      const float xy = std::max(std::abs(x[i + l]), std::abs(y[i + l]));
      entry[l] = std::max(entry[l], std::max(xy, std::abs(z[i + l])));
    }
  }
  for (; i < n; ++i) entry[0] = std::max({entry[0], std::abs(x[i]), std::abs(y[i]), std::abs(z[i])});
  return *std::max_element(entry, entry + lanes);
}
MUSLIN_VECTOR_CODE void store_piece(std::uint16_t* __restrict c, float per_unit, int n,
                                    const float* __restrict sx, const float* __restrict sy,
                                    const float* __restrict sz, const float* __restrict t) {
  const auto rounded = [&](float s) __attribute__((always_inline)) {
    const float scaled = per_unit * s;
    return static_cast<std::uint16_t>(
        static_cast<std::int16_t>(static_cast<std::int32_t>(scaled + (scaled < 0 ? -0.5F : 0.5F))));
  };
  for (int i = 0; i < n; ++i) {
    c[i] = rounded(sx[i]);
    c[n + i] = rounded(sy[i]);
    c[2 * n + i] = rounded(sz[i]);
    const auto bits = std::bit_cast<std::uint32_t>(t[i]);
    c[3 * n + i] = static_cast<std::uint16_t>((bits + 0x7fffU + (bits >> 16 & 1U)) >> 16);
  }
}

}  // namespace

void Couplings::reset(std::shared_ptr<const CouplingPattern> pattern, std::size_t first) {
  pattern_ = std::move(pattern);
  first_ = first;
  coefficients_.resize(4 * static_cast<std::size_t>(pattern_->slot_count()) + room);
  units_.resize(pattern_->pieces().size());
  std::memset(coefficients_.data(), 0, coefficients_.size() * sizeof(std::uint16_t));
  std::fill_n(units_.data(), units_.size(), 0.0F);
}

void Couplings::load(const CouplingPiece& piece, float* sx, float* sy, float* sz, float* t) const {
  load_piece(coefficients(piece), unit(piece.index), piece.length, sx, sy, sz, t);
}

void Couplings::store(const CouplingPiece& piece, const float* sx, const float* sy, const float* sz,
                      const float* t) {
  const float entry = largest_entry(piece.length, sx, sy, sz);
  units_.data()[piece.index] = entry / largest;
  store_piece(coefficients_.data() + 4 * piece.slot, entry > 0 ? largest / entry : 0, piece.length, sx, sy,
              sz, t);
}

double Couplings::product(const float* identity, Floats p, Floats y) const {
  const auto& slabs = pattern_->slabs();
  const auto& pieces = pattern_->pieces();
  return parallel_sum(slabs.size(), 1, 0.0, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (int b = slabs[begin].block_begin; b < slabs[end - 1].block_end; ++b) {
      const CouplingPattern::Block& block = pattern_->blocks()[static_cast<std::size_t>(b)];
      start_product(identity + block.start_begin, block.start_end - block.start_begin, p + block.start_begin,
                    y + block.start_begin);
      for (int i = block.entering_begin; i < block.entering_end; ++i) {
        const CouplingPiece& c =
            pieces[static_cast<std::size_t>(pattern_->entering()[static_cast<std::size_t>(i)])];
        const float u = unit(c.index);
        apply_to_b(coefficients(c), u * u, c.length, p + c.a, p + c.b, y + c.b);
      }
      for (int i = block.own_begin; i < block.own_end; ++i) {
        const CouplingPiece& c = pieces[static_cast<std::size_t>(i)];
        const float u = unit(c.index);
        const auto apply = c.b - c.a >= c.length ? apply_apart : apply_own;
        apply(coefficients(c), u * u, c.length, p + c.a, p + c.b, y + c.a, y + c.b);
      }
      for (int i = block.leaving_begin; i < block.leaving_end; ++i) {
        const CouplingPiece& c = pieces[static_cast<std::size_t>(i)];
        const float u = unit(c.index);
        apply_to_a(coefficients(c), u * u, c.length, p + c.a, p + c.b, y + c.a);
      }
      sum += dot_product(block.end - block.begin, p + block.begin, y + block.begin);
    }
    return sum;
  });
}

void Couplings::add_diagonal(Floats upper, Floats lower) const {
  const auto& slabs = pattern_->slabs();
  const auto& pieces = pattern_->pieces();
  parallel_for(slabs.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (int b = slabs[begin].block_begin; b < slabs[end - 1].block_end; ++b) {
      const CouplingPattern::Block& block = pattern_->blocks()[static_cast<std::size_t>(b)];
      for (int i = block.entering_begin; i < block.entering_end; ++i) {
        const CouplingPiece& c =
            pieces[static_cast<std::size_t>(pattern_->entering()[static_cast<std::size_t>(i)])];
        const float u = unit(c.index);
        add_blocks_one(coefficients(c), u * u, c.length, upper + c.b, lower + c.b);
      }
      for (int i = block.own_begin; i < block.own_end; ++i) {
        const CouplingPiece& c = pieces[static_cast<std::size_t>(i)];
        const float u = unit(c.index);
        add_blocks_own(coefficients(c), u * u, c.length, upper + c.a, lower + c.a, upper + c.b, lower + c.b);
      }
      for (int i = block.leaving_begin; i < block.leaving_end; ++i) {
        const CouplingPiece& c = pieces[static_cast<std::size_t>(i)];
        const float u = unit(c.index);
        add_blocks_one(coefficients(c), u * u, c.length, upper + c.a, lower + c.a);
      }
    }
  });
}

}  // namespace muslin
