// All forces are potentials: the solver handles nothing else. One implicit step from x_n minimises the
// incremental potential
//
//   E(x) = ½ (x − x̃)ᵀ M (x − x̃) + dt² Σᵢ Wᵢ(x),
//
// with x̃ the inertial prediction (Kane, Marsden, Ortiz, West 2000; Martin et al. 2011).
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <span>

#include "muslin/api.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/potential/state.hpp"

namespace muslin {

class HessianSink;

/// W(x) in joule for positions x (#V by 3, m). Implementations are immutable, safe to call from several
/// threads, deterministic for any thread count, and parallel inside where that is faster.
class MUSLIN_API Potential {
 public:
  virtual ~Potential() = default;

  virtual double value(ConstVectors x) const = 0;

  /// g += ∂W/∂x, #V by 3, N.
  virtual void add_gradient(ConstVectors x, Vectors g) const = 0;

  /// Computes both in one pass where a potential can; the bits are those of add_gradient and value.
  virtual double add_gradient_and_value(ConstVectors x, Vectors g) const {
    add_gradient(x, g);
    return value(x);
  }

  /// y += ∂²W/∂x² p, the true (possibly indefinite) Hessian at x.
  virtual void add_hessian_product(ConstVectors x, ConstVectors p, Vectors y) const = 0;

  /// blocks[v] += the diagonal 3×3 block of a positive semidefinite approximation of the Hessian, for the
  /// preconditioner, N/m.
  virtual void add_diagonal_blocks(ConstVectors x, std::span<Mat3> blocks) const = 0;

  /// Adds the Hessian at x to `into`, where this potential's vertices are numbered first, first + 1, …. x
  /// must stay valid while `into` is used. By default a potential is added as its Hessian product.
  virtual void linearize(ConstVectors x, HessianSink& into, std::size_t first) const;

  /// The part of value(x) that is lost, not stored, once a step ends at x [J]: plastic work.
  virtual double dissipated(ConstVectors x) const {
    (void)x;
    return 0;
  }

  /// The largest t such that moving from x by t·d stays where W is finite and safe (1 means: all the way
  /// and beyond is safe too).
  virtual double max_step(ConstVectors x, ConstVectors d) const {
    (void)x, (void)d;
    return std::numeric_limits<double>::infinity();
  }
};

/// A load that depends on time, velocity or history (gravity, wind, damping): at the start of a step it
/// yields the potential which that step minimises. Null means that nothing acts during this step.
class MUSLIN_API Load {
 public:
  virtual ~Load() = default;
  virtual std::unique_ptr<Potential> potential(const StepContext& step) const = 0;

  /// Ends a step at x. `potential` is the one that this load yielded for the step. Writes data for later
  /// steps into `history`.
  virtual void end_step(const Potential& potential, ConstVectors x, History& history) const {
    (void)potential, (void)x, (void)history;
  }
};

}  // namespace muslin
