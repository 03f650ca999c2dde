// The baseline every speed is quoted against: implicit Euler on a mass-spring mesh as a textbook writes it.
// Newton on the incremental potential with the Hessian projected to positive semidefinite spring by spring,
// assembled into 3×3 block compressed rows in double, solved by conjugate gradients with block-Jacobi
// preconditioning, backtracking line search (Baraff and Witkin 1998; Nocedal and Wright 2006, ch. 3, 5, 7).
// Compiled with the same flags as muslin. One thread.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "muslin/core/vectors.hpp"

namespace muslin::bench {

struct TextbookSpring {
  int a = 0, b = 0;
  double stiffness = 0;    ///< [N/m]
  double rest_length = 0;  ///< [m]
};

struct TextbookProblem {
  std::vector<TextbookSpring> springs;
  std::vector<double> masses;       ///< #V [kg]
  std::vector<std::uint8_t> fixed;  ///< #V
  Vec3 gravity = Vec3::Zero();      ///< [m/s²]
  double dt = 0;                    ///< [s]
};

struct TextbookReport {
  int newton_iterations = 0;
  int linear_iterations = 0;
  double residual = 0;  ///< max ‖∂E/∂xᵢ‖ / (mᵢ dt²) [m/s²]
  bool converged = false;
};

/// Measures of a position as the end of a step, by which the results of any two methods are compared.
struct TextbookMeasure {
  double energy = 0;    ///< E(x), the gravity's constant left out [J s²]
  double residual = 0;  ///< as in TextbookReport
};

class TextbookSolver {
 public:
  explicit TextbookSolver(TextbookProblem problem);

  /// Called with every iterate and its report before it is improved on; true ends the step.
  using Watch = std::function<bool(ConstVectors x, const TextbookReport& report)>;
  /// Asked once per conjugate gradient iteration; true gives up.
  using GiveUp = std::function<bool()>;

  /// One implicit Euler step from (x, v) until `watch` or `give_up` ends it; each linear system to the
  /// relative residual `forcing`. Positions and velocities are updated. Converged if `watch` ended it.
  TextbookReport implicit_euler(double forcing, const Watch& watch, const GiveUp& give_up,
                                std::vector<Vec3>& x, std::vector<Vec3>& v);

  /// One linearly implicit step on the exact tangent, the linear system to relative residual `forcing`.
  TextbookReport linearly_implicit_euler(double forcing, std::vector<Vec3>& x, std::vector<Vec3>& v);

  /// Measures `result` as the end of a step that began with (x, v).
  TextbookMeasure measure(ConstVectors x, ConstVectors v, ConstVectors result) const;

  /// Bytes of matrix, preconditioner and vectors.
  std::size_t bytes() const;

 private:
  double energy(ConstVectors x, ConstVectors predicted) const;
  void gradient(ConstVectors x, ConstVectors predicted, Vectors g) const;
  void assemble(ConstVectors x, bool projected);
  void multiply(ConstVectors p, Vectors y) const;
  std::vector<Vec3> inertial_prediction(ConstVectors x, ConstVectors v) const;
  double residual(ConstVectors g) const;
  int conjugate_gradients(ConstVectors rhs, double forcing, const GiveUp& give_up, Vectors solution);

  TextbookProblem problem_;
  // Block rows: row v has blocks row_[v] … row_[v+1]−1 with columns column_.
  std::vector<std::int64_t> row_;
  std::vector<int> column_;
  std::vector<Mat3> blocks_;
  std::vector<Mat3> inverse_diagonal_;
  std::vector<std::int64_t> diagonal_;                 // of each row
  std::vector<std::array<std::int64_t, 2>> coupling_;  // of each spring: blocks (a,b) and (b,a)
  std::vector<Vec3> r_, z_, p_, q_;
};

}  // namespace muslin::bench
