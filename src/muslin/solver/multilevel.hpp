// Multilevel is multigrid on block matrices: an approximate inverse, symmetric and positive definite, whose
// quality does not depend on the number of unknowns.
//
// One V-cycle: a Gauss-Seidel sweep forwards, the remaining residual restricted to a grid of twice the
// spacing and solved for there in the same way, its correction interpolated back, a sweep backwards. The
// coarser matrices are Pᵀ A P (Galerkin), P trilinear interpolation; the coarsest one is factorised (Briggs,
// Henson, McCormick, A Multigrid Tutorial, 2000).
//
// Chunks of nodes are swept side by side. A = D + L + Lᵀ + O, D + L within chunks and O between them: a sweep
// inverts M = D + Λ + L with Λᵢ = ½ Σⱼ ‖Oᵢⱼ‖ I. M + Mᵀ − A = D + 2Λ − O is positive definite, hence sweeps
// converge for any number of chunks (Baker, Falgout, Kolev, Yang, Multigrid smoothers for ultraparallel
// computing, 2011).
#pragma once

#include <array>
#include <memory>
#include <vector>

#include <Eigen/Cholesky>

#include "muslin/solver/background_grid.hpp"

namespace muslin {

class Multilevel {
 public:
  /// For matrices of this pattern between nodes at `points` (#P by 3) of `components` (#P). `spacings` by
  /// component: of the first coarser grid.
  Multilevel(std::shared_ptr<const BlockPattern> pattern, ConstVectors points,
             std::span<const int> components, std::vector<double> spacings);

  /// Returns the matrix, to be filled before `prepare`: symmetric, positive definite, with the pattern given.
  BlockMatrix& matrix() { return levels_[0].matrix; }
  /// Computes the coarser matrices.
  void prepare();

  /// Return the right side, to be filled before `solve`, and the solution; three floats and a zero per node.
  std::vector<Float4>& right_side() { return levels_[0].b; }
  const std::vector<Float4>& solution() const { return levels_[0].x; }
  /// solution = B · right side, B ≈ the inverse of the matrix.
  void solve() { solve(0); }

  std::size_t bytes() const;

 private:
  struct Level {
    std::shared_ptr<const BlockPattern> pattern;
    BlockMatrix matrix;
    std::vector<std::array<int, 2>> inside;  // by row: its entries within the chunk, from and to
    std::vector<float> added;                // Λ
    std::vector<Block3> inverse;             // of D + Λ
    std::vector<Float4> b, x, before;        // x before a sweep; the residual after one
    BackgroundGrid grid;                     // behind it
    GridMatrix coarser;
    std::vector<Float4> half;  // of the coarser matrix
  };
  enum class Direction { forward, backward };
  void solve(std::size_t level);
  static void sweep(Level& level, Direction direction);
  void make_coarser_matrix(std::size_t level);

  std::vector<Level> levels_;
  Eigen::LLT<Eigen::MatrixXd> direct_;
  bool has_direct_ = false;
};

}  // namespace muslin
