// H p as a Linearization has stored H, coupling by coupling in double: what faster ways are tested against.
#pragma once

#include <cstddef>
#include <vector>

#include "muslin/solver/linearization.hpp"

namespace muslin::test {

/// body(a, b, B) for every coupling of a linearisation: −B between vertices b and a, where b is eliminated
/// later.
template <class Body>
void for_each_coupling(const Linearization& h, const Body& body) {
  constexpr auto lanes = static_cast<std::size_t>(EliminationOrder::lanes);
  for (const SpringHessian* set : h.sets()) {
    const EliminationOrder& pattern = set->pattern();
    const FullCouplings* const full = h.full(*set);
    for (std::size_t b = 0; b < pattern.block_count(); ++b) {
      const EliminationOrder::Block& block = pattern.blocks()[b];
      float sx[lanes], sy[lanes], sz[lanes], t[lanes];
      set->load(b, 1, sx, sy, sz, t);
      float entries[9 * lanes];
      if (full) full->load(b, entries);
      for (std::size_t l = 0; l < lanes; ++l) {
        if ((block.used >> l & 1) == 0) continue;
        const int base = static_cast<int>(l) < block.cut ? block.first : block.second;
        const int earlier = pattern.vertex(l + static_cast<std::size_t>(base));
        const int later = pattern.vertex(static_cast<std::size_t>(block.group) * lanes + l);
        const Vec3 s(sx[l], sy[l], sz[l]);
        Mat3 matrix = s * s.transpose() + static_cast<double>(t[l]) * Mat3::Identity();
        for (std::size_t k = 0; full && k < 9; ++k)
          matrix(static_cast<Eigen::Index>(k / 3), static_cast<Eigen::Index>(k % 3)) =
              static_cast<double>(entries[k * lanes + l]);
        body(set->first() + static_cast<std::size_t>(earlier), set->first() + static_cast<std::size_t>(later),
             matrix);
      }
    }
  }
}

inline std::vector<Vec3> product(Linearization& h, ConstVectors p) {
  std::vector<Vec3> y(p.size());
  for (std::size_t v = 0; v < p.size(); ++v) y[v] = static_cast<double>(h.identity()[v]) * p[v];
  for_each_coupling(h, [&](std::size_t a, std::size_t b, const Mat3& block) {
    const Mat3 diagonal = 0.5 * (block + block.transpose());
    y[a] += diagonal * p[a] - block.transpose() * p[b];
    y[b] += diagonal * p[b] - block * p[a];
  });
  if (!h.has_remainder()) return y;
  std::vector<Float4> from(p.size()), to(p.size(), Float4{0, 0, 0, 0});
  for (std::size_t v = 0; v < p.size(); ++v) {
    from[v] =
        Float4{static_cast<float>(p[v].x()), static_cast<float>(p[v].y()), static_cast<float>(p[v].z()), 0};
  }
  h.add_remainder_product(from.data(), to.data());
  for (std::size_t v = 0; v < p.size(); ++v) y[v] += Vec3(to[v][0], to[v][1], to[v][2]);
  return y;
}

}  // namespace muslin::test
