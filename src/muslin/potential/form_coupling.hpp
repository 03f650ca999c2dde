// FormCoupling is a constant symmetric matrix between linear forms of a body's motion p,
//
//   Σ c_ef gₑ g_fᵀ,   gₑ·p = Σ gₑᵢ·pᵢ over four vertices,
//
// such as the changes of the angles of hinges.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace muslin {

struct FormCoupling {
  std::vector<std::array<int, 4>> vertices;  ///< of each form
  /// Row e has columns[k], values[k] for first[e] ≤ k < first[e + 1].
  std::vector<int> first, columns;
  std::vector<float> values;
  /// Vertex v is corner shares[k] % 4 of form shares[k] / 4 for first_share[v] ≤ k < first_share[v + 1].
  std::vector<int> first_share, shares;

  /// Fills first_share and shares.
  void find_shares(std::size_t vertex_count) {
    first_share.assign(vertex_count + 1, 0);
    for (const auto& form : vertices)
      for (const int v : form) ++first_share[static_cast<std::size_t>(v) + 1];
    for (std::size_t v = 0; v < vertex_count; ++v) first_share[v + 1] += first_share[v];
    std::vector<int> next(first_share.begin(), first_share.end() - 1);
    shares.resize(4 * vertices.size());
    for (std::size_t e = 0; e < vertices.size(); ++e) {
      for (std::size_t c = 0; c < 4; ++c) {
        int& place = next[static_cast<std::size_t>(vertices[e][c])];
        shares[static_cast<std::size_t>(place++)] = static_cast<int>(4 * e + c);
      }
    }
  }
};

}  // namespace muslin
