// IncrementalPotential is the function that one implicit step minimises over the free vertices:
//
//   E(x) = ½ (x − x̃)ᵀ M (x − x̃) + dt² Σᵢ Wᵢ(x)   [J s²]
//
// x̃ is the inertial prediction. Held vertices are not unknowns: their rows are zero.
#pragma once

#include <cmath>
#include <span>

#include "muslin/solver/linearization.hpp"
#include "muslin/solver/solver.hpp"

namespace muslin {

class IncrementalPotential {
 public:
  /// Keeps references to the problem and to `prediction`, x̃. dt is the integrator's effective step [s].
  IncrementalPotential(const StepProblem& problem, ConstVectors prediction, double dt);

  struct Value {
    double value = 0;
    double magnitude = 0;  ///< sum of the absolute values of the terms, to which rounding is relative

    Value& operator+=(double term) {
      value += term;
      magnitude += std::abs(term);
      return *this;
    }
  };
  Value value(ConstVectors x) const;

  /// g = ∂E/∂x, zero on held vertices.
  void gradient(ConstVectors x, Vectors g) const;
  /// Computes both in as few passes as the potentials allow; the same bits.
  Value value_and_gradient(ConstVectors x, Vectors g) const;
  /// y = ∂²E/∂x² p, zero on held vertices; p need not be zero there.
  void hessian_product(ConstVectors x, ConstVectors p, Vectors y) const;
  /// Sets positive definite diagonal blocks of (an approximation of) the Hessian; blocks of held vertices
  /// contain only their mass.
  void diagonal_blocks(ConstVectors x, std::span<Mat3> blocks) const;
  /// Adds up the Hessian at x for the inner solver. x is kept by reference.
  void linearize(ConstVectors x, Linearization& into) const;
  /// Returns the largest safe t along d over all potentials.
  double max_step(ConstVectors x, ConstVectors d) const;

  struct Imbalance {
    double largest = 0;  ///< max ‖gᵢ‖ / (mᵢ dt²) over free vertices [m/s²]; NaN if any is
    int vertex = -1;
    double norm = 0;  ///< ‖g‖ over free vertices [kg m]
  };
  Imbalance imbalance(ConstVectors g) const;
  /// Value, gradient and imbalance, computed in as few passes as the potentials allow; the same bits.
  struct Evaluation {
    Value value;
    Imbalance imbalance;
  };
  Evaluation evaluate(ConstVectors x, Vectors g) const;
  /// Returns the part of the imbalance due to rounding: half a unit in the last place of every coordinate,
  /// multiplied by the Hessian [m/s²]. Lower tolerances cannot be met. `stiffest` is the largest ‖diagonal
  /// block‖ / mass.
  double rounding_floor(ConstVectors x, double stiffest) const;

  std::span<const double> masses() const { return problem_.masses; }
  bool held(std::size_t v) const { return problem_.fixed[v] != 0; }
  std::size_t size() const { return prediction_.size(); }
  ConstVectors prediction() const { return prediction_; }
  double dt() const { return dt_; }
  ConstVectors rest_positions() const { return problem_.rest_positions; }

 private:
  struct Inertia;
  Inertia add_inertia(ConstVectors x, Vectors g) const;

  const StepProblem& problem_;
  ConstVectors prediction_;
  double dt_;
};

}  // namespace muslin
