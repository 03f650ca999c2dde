// ElementEnergy is the interface of elastic energies of elements, with four kinds of stiffness.
// ElementDamping is the damping made from one of them.
#pragma once

#include <memory>
#include <span>
#include <utility>

#include "muslin/potential/hessian_sink.hpp"
#include "muslin/potential/potential.hpp"
#include "muslin/potential/symmetric_pattern.hpp"

namespace muslin {

/// Selects a part of ∂²W/∂x². With W = ½ k s(x)², s a strain or an angle, it is k ∇s∇sᵀ + k s ∇²s.
enum class Stiffness {
  material,   ///< the first term only: resists changes of strain; positive semidefinite
  projected,  ///< the first term and the tensile part of the second, without buckling; positive semidefinite
  bounded,    ///< as projected, and for membranes as much buckling as the masses allow; matrices only
  exact,      ///< both
};

/// An elastic energy of elements. Its Hessian is exact. The matrix for the inner solver is bounded, which
/// spares conjugate gradients and the coarse space negative curvature; without a pattern it is projected
/// (docs/theory/shells.md).
class ElementEnergy : public Potential {
 public:
  explicit ElementEnergy(std::shared_ptr<const SymmetricPattern> pattern)
      : pattern_(std::move(pattern)), projected_(*this) {}

  /// y += K p, K the stiffness of this kind at x, #V by 3.
  virtual void add_stiffness_product(Stiffness kind, ConstVectors x, ConstVectors p, Vectors y) const = 0;
  /// blocks[v] += the diagonal blocks of K or, where elements are coupled (energy/shell_bending.hpp), of a
  /// matrix A with K ≤ 2 A; `kind` is material or projected.
  virtual void add_stiffness_blocks(Stiffness kind, ConstVectors x, std::span<Mat3> blocks) const = 0;

  void add_hessian_product(ConstVectors x, ConstVectors p, Vectors y) const override {
    add_stiffness_product(Stiffness::exact, x, p, y);
  }
  void add_diagonal_blocks(ConstVectors x, std::span<Mat3> blocks) const override {
    add_stiffness_blocks(Stiffness::projected, x, blocks);
  }
  /// Adds `scale` K, or `scale` A as above, to the blocks of a matrix of pattern(); `kind` is not exact. With
  /// `bounded`, M + scale K is at least a tenth of M, the diagonal of `masses` (#V, read only then), in every
  /// direction; only the membrane's law uses the masses.
  virtual void add_stiffness_matrix(Stiffness kind, ConstVectors x, double scale,
                                    std::span<const double> masses, PairBlocks blocks) const = 0;
  /// Adds `factor` K, or `factor` A as above, to a linear system in which the energy's vertices are numbered
  /// first, first + 1, …; `kind` is not exact. Needs a pattern.
  virtual void linearize_stiffness(Stiffness kind, ConstVectors x, double factor, HessianSink& into,
                                   std::size_t first) const;
  /// Returns the pattern, if given; without it the inner solver computes products from x.
  const std::shared_ptr<const SymmetricPattern>& pattern() const { return pattern_; }

  void linearize(ConstVectors x, HessianSink& into, std::size_t first) const override;

 private:
  /// This energy with the projected Hessian.
  class Projected : public Potential {
   public:
    explicit Projected(const ElementEnergy& energy) : energy_(energy) {}
    double value(ConstVectors x) const override { return energy_.value(x); }
    void add_gradient(ConstVectors x, Vectors g) const override { energy_.add_gradient(x, g); }
    void add_hessian_product(ConstVectors x, ConstVectors p, Vectors y) const override {
      energy_.add_stiffness_product(Stiffness::projected, x, p, y);
    }
    void add_diagonal_blocks(ConstVectors x, std::span<Mat3> blocks) const override {
      energy_.add_diagonal_blocks(x, blocks);
    }

   private:
    const ElementEnergy& energy_;
  };

  std::shared_ptr<const SymmetricPattern> pattern_;
  Projected projected_;
};

/// Dashpots beside the elastic forces, Rayleigh's stiffness-proportional damping: the force −β K v with K
/// the material stiffness at the positions predicted for the time the step's velocity belongs to
/// (StepContext::velocity_time) and v = (x − anchor) / dt. K does not resist rigid motions, so that free fall
/// is not damped, rotation only by the prediction's error, and W = β (x − anchor)ᵀ K (x − anchor) / (2 dt) is
/// quadratic.
class ElementDamping : public Load {
 public:
  /// beta [s] ≥ 0.
  ElementDamping(std::shared_ptr<const ElementEnergy> energy, double beta);
  std::unique_ptr<Potential> potential(const StepContext& step) const override;

 private:
  std::shared_ptr<const ElementEnergy> energy_;
  double beta_;
};

}  // namespace muslin
