// CoarseSpace corrects smooth motions, on which conjugate gradients alone slow down with resolution, by
// interpolation from a coarse grid over the rest positions,
//
//   t = Z B Zᵀ r,   B ≈ (Zᵀ H⁺ Z)⁻¹ by multigrid (Multilevel),
//
// H⁺ the Hessian without the negative t of its couplings, Z trilinear with a spacing of eight edges (of four
// where block matrices couple the vertices). Couplings of one direction within one cell are summed first and
// get the mean of their weights: Σ δᵢδᵢᵀ ⊗ Bᵢ ≈ (Σ δᵢδᵢᵀ) ⊗ (Σ Bᵢ) / n, exact where they are equal and
// positive semidefinite always. Bodies are the components of coupled vertices; small ones are excluded.
// Potentials that are neither couplings nor block matrices contribute their diagonal blocks to H⁺.
#pragma once

#include <memory>
#include <vector>

#include "muslin/solver/linearization.hpp"
#include "muslin/solver/multilevel.hpp"

namespace muslin {

class CoarseSpace {
 public:
  /// For linearisations with the same patterns as `h`; `rest_positions` #V by 3 [m].
  CoarseSpace(const Linearization& h, ConstVectors rest_positions);
  bool fits(const Linearization& h, ConstVectors rest_positions) const;
  /// True if there is nothing to correct.
  bool empty() const { return multilevel_ == nullptr; }

  /// Computes Zᵀ H⁺ Z.
  void assemble(const Linearization& h);
  /// t = Z B Zᵀ r, zero on held vertices; returns rᵀt. Both are indexed by position in the elimination order,
  /// one set of couplings after the other; r in groups of 16 x, 16 y and 16 z.
  double correct(const float* r, Floats t);

  std::size_t bytes() const;

 private:
  struct Set {
    std::shared_ptr<const EliminationOrder> pattern;
    std::size_t first = 0;  // vertex
    std::size_t begin = 0;  // position
    std::size_t first_block = 0;
  };
  struct Matrix {
    std::shared_ptr<const SymmetricPattern> pattern;
    std::size_t first = 0;
  };
  /// The items `begin` … `end` − 1 that a part handles in a loop over `count` items.
  struct Share {
    std::size_t begin, end;
  };
  Share share(std::size_t part, std::size_t count) const {
    return {count * part / sums_.size(), count * (part + 1) / sums_.size()};
  }
  BackgroundGrid::Point point(std::size_t position) const {
    return held_[position] != 0 ? BackgroundGrid::Point{} : grid_.point(position);
  }
  /// A bundle holds the mean of δ_k δ_l over the couplings of one kind in one cell, or over the masses of a
  /// cell's vertices.
  using Square = std::array<float, 36>;  // for nodes k ≤ l of a cell, as add_weighted has them
  struct Bundle {
    int cell = 0;
    float count = 0;
    Square weights{};
  };
  /// Partial sums of a part.
  struct Sums {
    std::vector<Float4> half, right_side;
    std::vector<Block3> couplings;  // by bundle
    std::vector<Square> masses;     // by cell
  };
  void bundle();
  void add_couplings(const SpringHessian& couplings, const Set& set, std::size_t part, Sums& sums) const;
  void add_masses(const Linearization& h, std::size_t part, Sums& sums) const;
  void add_matrix(const SymmetricMatrix& matrix, std::size_t part, Float4* half) const;
  void add_rest_diagonal(const Linearization& h, std::size_t part, Float4* half) const;

  std::vector<Set> sets_;
  std::vector<Matrix> matrices_;
  const Vec3* rest_positions_ = nullptr;
  std::size_t vertex_count_ = 0;
  std::vector<int> position_;  // by vertex
  BackgroundGrid grid_;        // points by position
  GridMatrix grid_matrix_;
  std::vector<std::uint8_t> held_;  // by position
  std::vector<int> bundle_;         // by block of couplings and lane; −1: by itself
  std::vector<Bundle> bundles_;
  std::vector<Sums> sums_;  // by part
  std::unique_ptr<Multilevel> multilevel_;
};

}  // namespace muslin
