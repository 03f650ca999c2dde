#include "muslin/solver/line_preconditioner.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "muslin/core/parallel.hpp"
#include "muslin/solver/line_kernels.hpp"

namespace muslin {
namespace {

using line_kernels::CouplingStretch;
using line_kernels::lanes;
using line_kernels::PivotStretch;

constexpr float largest = 32767;
constexpr std::size_t vertices_per_task = 4096;
constexpr int strip = 16;  // steps brought to lanes at a time, so that they stay in the first-level cache

std::size_t at(int i) { return static_cast<std::size_t>(i); }

CouplingStretch stretch(const Couplings& couplings, const LineSegment& segment) {
  const CouplingPiece& piece = couplings.pattern().pieces()[at(segment.piece)];
  const std::uint16_t* const c = couplings.coefficients(piece) + segment.offset;
  const float unit = couplings.unit(segment.piece);
  return {c, c + piece.length, c + 2 * piece.length, c + 3 * piece.length, unit * unit};
}

std::size_t bundles_per_task(const CouplingPattern& pattern) {
  const std::size_t bundles = (pattern.chains().size() + lanes - 1) / lanes;
  return std::max<std::size_t>(
      1, bundles * vertices_per_task / std::max<std::size_t>(1, at(pattern.vertex_count())));
}

}  // namespace

void LinePreconditioner::factor(const Linearization& h, FloatVectors& scratch_upper,
                                FloatVectors& scratch_lower) {
  scratch_upper.resize(h.size());
  scratch_lower.resize(h.size());
  w_.resize(h.size());
  bodies_.resize(h.sets().size());
  uncovered_.clear();
  inverse_.clear();
  std::size_t covered = 0;
  const auto leave = [&](std::size_t end) {
    for (; covered < end; ++covered) uncovered_.push_back(covered);
  };
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    Body& body = bodies_[b];
    body.couplings = h.sets()[b];
    leave(body.couplings->first());
    covered += at(body.couplings->pattern().vertex_count());
    const auto first = static_cast<std::ptrdiff_t>(body.couplings->first());
    const Floats upper = scratch_upper.data() + first, lower = scratch_lower.data() + first;
    factor_chains(h, body);
    for (const int axis : {1, 2}) factor_lines(h, body, axis, upper, lower);
  }
  leave(h.size());
  const Floats u = h.upper().data(), l = h.lower().data();
  for (const std::size_t v : uncovered_) {
    const auto i = static_cast<std::ptrdiff_t>(v);
    std::array<float, 6> m;
    const Floats mu{&m[0], &m[1], &m[2]}, ml{&m[3], &m[4], &m[5]};
    line_kernels::factor(1, u + i, l + i, h.fixed() + v, mu, ml);
    inverse_.push_back(m);
  }
}

void LinePreconditioner::factor_chains(const Linearization& h, Body& body) {
  const CouplingPattern& pattern = body.couplings->pattern();
  const auto& chains = pattern.chains();
  const std::size_t bundles = (chains.size() + lanes - 1) / lanes;
  body.first_step.assign(bundles + 1, 0);
  for (std::size_t b = 0; b < bundles; ++b)
    body.first_step[b + 1] = body.first_step[b] + at(chains[b * lanes].length);
  body.chain_pivots.resize(6 * lanes * body.first_step[bundles]);
  body.chain_couplings.resize(4 * lanes * body.first_step[bundles]);
  body.chain_units.resize(7 * lanes * bundles);

  const Floats upper = h.upper().data() + static_cast<std::ptrdiff_t>(body.couplings->first());
  const Floats lower = h.lower().data() + static_cast<std::ptrdiff_t>(body.couplings->first());
  const std::uint8_t* const fixed = h.fixed() + body.couplings->first();
  parallel_for(bundles, bundles_per_task(pattern), [&](std::size_t begin, std::size_t end) {
    std::vector<float> pivots, couplings;
    for (std::size_t bundle = begin; bundle < end; ++bundle) {
      const int steps = chains[bundle * lanes].length;
      const int used = static_cast<int>(std::min<std::size_t>(lanes, chains.size() - bundle * lanes));
      pivots.assign(6 * lanes * at(steps), 0.0F);
      couplings.assign(4 * lanes * at(steps), 0.0F);
      std::array<float, 7 * lanes> entry{};  // the largest
      alignas(64) float a[6 * lanes];
      alignas(64) const float nothing[6 * lanes] = {};
      for (int step = 0; step < steps; ++step) {
        float* const b = couplings.data() + 4 * lanes * step;
        float* const m = pivots.data() + 6 * lanes * step;
        for (int l = 0; l < lanes; ++l) {
          const bool inside = l < used && step < chains[bundle * lanes + at(l)].length;
          const int v = inside ? chains[bundle * lanes + at(l)].vertex + step : 0;
          a[l] = inside ? upper.x[v] : 1, a[lanes + l] = inside ? upper.y[v] : 0;
          a[2 * lanes + l] = inside ? upper.z[v] : 0, a[3 * lanes + l] = inside ? lower.x[v] : 1;
          a[4 * lanes + l] = inside ? lower.y[v] : 0, a[5 * lanes + l] = inside ? lower.z[v] : 1;
          if (!inside) continue;
          const CouplingPattern::Link& link = pattern.chain_links()[at(v)];
          if (link.piece < 0) continue;
          const CouplingPiece& piece = pattern.pieces()[at(link.piece)];
          const std::uint16_t* const c = body.couplings->coefficients(piece) + link.offset;
          const float unit = body.couplings->unit(link.piece);
          for (int k = 0; k < 3; ++k) {
            b[k * lanes + l] = unit * static_cast<float>(static_cast<std::int16_t>(c[k * piece.length]));
            entry[at(6 * lanes + l)] = std::max(entry[at(6 * lanes + l)], std::abs(b[k * lanes + l]));
          }
          b[3 * lanes + l] = std::max(0.0F, line_kernels::cut_float(c[3 * piece.length]));
        }
        line_kernels::factor_lanes(a, step > 0 ? b - 4 * lanes : nothing, step > 0 ? m - 6 * lanes : nothing,
                                   m);
        for (int l = 0; l < lanes; ++l) {
          const bool inside = l < used && step < chains[bundle * lanes + at(l)].length;
          if (inside && fixed[chains[bundle * lanes + at(l)].vertex + step] == 0) continue;
          for (int k = 0; k < 6; ++k) m[k * lanes + l] = 0;
        }
        for (int k = 0; k < 6 * lanes; ++k) entry[at(k)] = std::max(entry[at(k)], std::abs(m[k]));
      }
      std::array<float, 7 * lanes> per_unit;
      for (std::size_t k = 0; k < per_unit.size(); ++k) {
        body.chain_units.data()[bundle * 7 * lanes + k] = entry[k] / largest;
        per_unit[k] = entry[k] > 0 ? largest / entry[k] : 0;
      }
      line_kernels::quantise_bundle(steps, pivots.data(), couplings.data(), per_unit.data(),
                                    body.chain_pivots.data() + 6 * lanes * body.first_step[bundle],
                                    body.chain_couplings.data() + 4 * lanes * body.first_step[bundle]);
    }
  });
}

void LinePreconditioner::factor_lines(const Linearization& h, Body& body, int axis, Floats upper,
                                      Floats lower) {
  const CouplingPattern& pattern = body.couplings->pattern();
  const LinePattern& lines = pattern.lines(axis);
  const std::size_t count = at(pattern.vertex_count());
  Buffer<std::int16_t>& pivots = body.pivots[axis - 1];
  auto& units = body.units[axis - 1];
  pivots.resize(6 * count + lanes);
  units.resize(lines.groups.size());
  const auto first = static_cast<std::ptrdiff_t>(body.couplings->first());
  const Floats au = h.upper().data() + first, al = h.lower().data() + first;
  const std::uint8_t* const fixed = h.fixed() + first;
  parallel_for(lines.tasks.size() - 1, 1, [&](std::size_t begin, std::size_t end) {
    for (int g = lines.tasks[begin]; g < lines.tasks[end]; ++g) {
      const LinePattern::Group& group = lines.groups[at(g)];
      std::array<float, 6> entry{};
      for (int s = group.forward_begin; s < group.forward_end; ++s) {
        const LineSegment& segment = lines.forward[at(s)];
        const std::ptrdiff_t v = segment.vertex, other = segment.other;
        if (segment.piece < 0) {
          line_kernels::factor(segment.length, au + v, al + v, fixed + v, upper + v, lower + v);
        } else {
          line_kernels::factor(segment.length, au + v, al + v, fixed + v, stretch(*body.couplings, segment),
                               upper + other, lower + other, upper + v, lower + v);
        }
        const float* const m[6] = {upper.x + v, upper.y + v, upper.z + v,
                                   lower.x + v, lower.y + v, lower.z + v};
        for (std::size_t k = 0; k < 6; ++k)
          entry[k] = std::max(entry[k], line_kernels::largest_entry(segment.length, m[k]));
      }
      for (std::size_t k = 0; k < 6; ++k) units[at(g)][k] = entry[k] / largest;
      for (int s = group.forward_begin; s < group.forward_end; ++s) {
        const LineSegment& segment = lines.forward[at(s)];
        const std::ptrdiff_t v = segment.vertex;
        const float* const m[6] = {upper.x + v, upper.y + v, upper.z + v,
                                   lower.x + v, lower.y + v, lower.z + v};
        for (std::size_t k = 0; k < 6; ++k) {
          line_kernels::quantise(segment.length, m[k], entry[k] > 0 ? largest / entry[k] : 0,
                                 pivots.data() + k * count + segment.pivot);
        }
      }
    }
  });
}

void LinePreconditioner::solve_chains(const Body& body, float alpha, Floats q, Floats r, Floats z) {
  const CouplingPattern& pattern = body.couplings->pattern();
  const auto& chains = pattern.chains();
  const std::size_t bundles = body.first_step.size() - 1;
  parallel_for(bundles, bundles_per_task(pattern), [&](std::size_t begin, std::size_t end) {
    Buffer<float> buffer;
    buffer.resize(3 * lanes * at(chains[begin * lanes].length));
    for (std::size_t bundle = begin; bundle < end; ++bundle) {
      const int steps = chains[bundle * lanes].length;
      const std::size_t used = std::min<std::size_t>(lanes, chains.size() - bundle * lanes);
      const CouplingPattern::Chain* const chain = chains.data() + bundle * lanes;
      if (used < lanes || chain[used - 1].length < steps)
        std::memset(buffer.data(), 0, 3 * lanes * at(steps) * sizeof(float));
      for (int step = 0; step < steps; step += strip) {
        for (std::size_t l = 0; l < used; ++l) {
          const int n = std::min(strip, chain[l].length - step);
          const std::ptrdiff_t v = chain[l].vertex + step;
          if (n > 0)
            line_kernels::update_and_gather(n, static_cast<int>(l), alpha, q + v, r + v,
                                            buffer.data() + 3 * lanes * step);
        }
      }
      line_kernels::solve_bundle(steps, body.chain_pivots.data() + 6 * lanes * body.first_step[bundle],
                                 body.chain_couplings.data() + 4 * lanes * body.first_step[bundle],
                                 body.chain_units.data() + 7 * lanes * bundle, buffer.data());
      for (int step = 0; step < steps; step += strip) {
        for (std::size_t l = 0; l < used; ++l) {
          const int n = std::min(strip, chain[l].length - step);
          if (n > 0)
            line_kernels::scatter(n, static_cast<int>(l), buffer.data() + 3 * lanes * step,
                                  z + (chain[l].vertex + step));
        }
      }
    }
  });
}

double LinePreconditioner::solve_lines(const Body& body, int axis, Floats r, Floats z) const {
  const CouplingPattern& pattern = body.couplings->pattern();
  const LinePattern& lines = pattern.lines(axis);
  const std::size_t count = at(pattern.vertex_count());
  const Floats w = w_.data() + static_cast<std::ptrdiff_t>(body.couplings->first());
  const std::int16_t* const pivots = body.pivots[axis - 1].data();
  const auto pivots_of = [&](const LineSegment& segment, const std::array<float, 6>& unit) {
    PivotStretch out{{}, unit.data()};
    for (std::size_t k = 0; k < 6; ++k) out.m[k] = pivots + k * count + segment.pivot;
    return out;
  };
  return parallel_sum(lines.tasks.size() - 1, 1, 0.0, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (int g = lines.tasks[begin]; g < lines.tasks[end]; ++g) {
      const LinePattern::Group& group = lines.groups[at(g)];
      const std::array<float, 6>& unit = body.units[axis - 1][at(g)];
      for (int s = group.forward_begin; s < group.forward_end; ++s) {
        const LineSegment& segment = lines.forward[at(s)];
        const std::ptrdiff_t v = segment.vertex, other = segment.other;
        if (segment.piece < 0) {
          line_kernels::forward(segment.length, pivots_of(segment, unit), r + v, w + v);
        } else {
          line_kernels::forward(segment.length, pivots_of(segment, unit), r + v,
                                stretch(*body.couplings, segment), w + other, w + v);
        }
      }
      for (int s = group.backward_begin; s < group.backward_end; ++s) {
        const LineSegment& segment = lines.backward[at(s)];
        const std::ptrdiff_t v = segment.vertex, other = segment.other;
        if (segment.piece < 0) {
          line_kernels::backward(segment.length, w + v, z + v);
        } else {
          line_kernels::backward(segment.length, pivots_of(segment, unit), stretch(*body.couplings, segment),
                                 w + other, w + v, z + v);
        }
        if (axis == 1) sum += line_kernels::dot(segment.length, r + v, z + v);
      }
    }
    return sum;
  });
}

double LinePreconditioner::apply(float alpha, const FloatVectors& q, FloatVectors& r, FloatVectors& z) const {
  double sum = 0;
  for (const Body& body : bodies_) {
    const auto first = static_cast<std::ptrdiff_t>(body.couplings->first());
    const Floats rb = r.data() + first, zb = z.data() + first;
    solve_chains(body, alpha, q.data() + first, rb, zb);
    solve_lines(body, 2, rb, zb);
    sum += solve_lines(body, 1, rb, zb);
  }
  const Floats rv = r.data(), qv = q.data(), zv = z.data();
  for (std::size_t i = 0; i < uncovered_.size(); ++i) {
    const auto v = static_cast<std::ptrdiff_t>(uncovered_[i]);
    sum += line_kernels::update_and_solve(alpha, inverse_[i], qv + v, rv + v, zv + v);
  }
  return sum;
}

std::size_t LinePreconditioner::bytes() const {
  std::size_t bytes = w_.bytes() + inverse_.capacity() * sizeof(inverse_[0]);
  for (const Body& body : bodies_) {
    bytes += body.chain_pivots.bytes() + body.chain_couplings.bytes() + body.chain_units.bytes();
    for (int axis = 0; axis < 2; ++axis)
      bytes += body.pivots[axis].bytes() + body.units[axis].capacity() * sizeof(body.units[axis][0]);
  }
  return bytes;
}

}  // namespace muslin
