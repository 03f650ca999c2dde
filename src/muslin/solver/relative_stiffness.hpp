// RelativeStiffness holds terms that resist relative motion, in float: the contacts in the Hessian of the
// inner solver.
//
//   K = Σ Aᵀ (a n nᵀ + b (I − n nᵀ)) A,   A p = Σ wᵢ pᵢ
//
// The terms change from one linearisation to the next and involve few of the vertices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "muslin/potential/hessian_sink.hpp"
#include "muslin/solver/float_vectors.hpp"

namespace muslin {

class RelativeStiffness {
 public:
  /// Resets to no terms, for vertices first … first + count − 1.
  void reset(std::size_t first, std::size_t count);
  /// Allocates `terms` terms with `weights` weights in all, each for the caller to set.
  RelativeTerms resize(std::size_t terms, std::size_t weights);
  /// Call when all terms have been set.
  void finish();

  std::size_t first() const { return first_; }
  /// y += K p, three floats and a zero per vertex; p and y begin at the body's first vertex. Returns pᵀK p.
  double add_product(const Float4* p, Float4* y);
  /// Adds the diagonal blocks: xx, xy, xz, yy, yz, zz are the components of `upper` and `lower`. A block
  /// whose trace is more than `most` times the vertex's `identity` is scaled down to that. Returns the
  /// largest ratio of trace to `identity` of a vertex that is not `fixed`.
  double add_diagonal(const float* identity, const std::uint8_t* fixed, float most, Floats upper,
                      Floats lower) const;

  std::size_t bytes() const;

 private:
  struct Share {
    int term;
    float weight;
  };

  std::size_t first_ = 0, count_ = 0;
  std::vector<RelativeTerms::Term> terms_;
  std::vector<RelativeTerms::Weight> weights_;  // by term
  std::vector<int> vertices_;                   // with terms, ascending
  std::vector<int> offsets_;                    // of their shares
  std::vector<Share> shares_;                   // by vertex
  std::vector<int> next_;                       // room for sorting
  std::vector<Float4> forces_;                  // by term
};

}  // namespace muslin
