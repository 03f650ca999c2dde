// HingeAngles are the angles of all hinges of a shell, as functions of the positions x (#V by 3):
//
//   d = w(θ − θ₀),   J = ∂d/∂x,
//
// θ the angles between the normals at the hinges, θ₀ those at rest, w the same angles within −π … π. All
// energies of bending are functions of d. Vectors by hinge, #H, are in the order of Shell::hinges. A triangle
// without area has no bending direction, and J is zero there.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "muslin/core/vectors.hpp"
#include "muslin/energy/element_slabs.hpp"
#include "muslin/energy/hinge_geometry.hpp"
#include "muslin/energy/shell_pattern.hpp"
#include "muslin/potential/hessian_sink.hpp"
#include "muslin/potential/symmetric_pattern.hpp"
#include "muslin/shell/shell.hpp"

namespace muslin {

class HingeAngles {
 public:
  /// `pattern` is the shell's block_pattern, or null.
  HingeAngles(const Shell& shell, std::shared_ptr<const SymmetricPattern> pattern);

  std::size_t count() const { return count_; }
  const std::shared_ptr<const SymmetricPattern>& pattern() const { return pattern_; }

  /// Returns d.
  std::vector<double> deviations(ConstVectors x) const;
  /// Returns J p.
  std::vector<double> changes(ConstVectors x, ConstVectors p) const;
  /// g += Jᵀ `moments`
  void add_forces(ConstVectors x, std::span<const double> moments, Vectors g) const;
  /// y += Jᵀ `factors` + Σ `moments` ∇²θ p
  void add_force_changes(ConstVectors x, std::span<const double> factors, std::span<const double> moments,
                         ConstVectors p, Vectors y) const;
  /// blocks[v] += the diagonal blocks of Jᵀ Λ J, Λ diagonal.
  void add_blocks(ConstVectors x, std::span<const double> lumped, std::span<Mat3> blocks) const;
  /// Adds `scale` Jᵀ Λ J to `blocks`; sets J, four vectors per hinge, unless null. Needs the pattern.
  void assemble(ConstVectors x, std::span<const double> lumped, double scale, PairBlocks blocks,
                Float4* gradients) const;

 private:
  using Slabs = ElementSlabs<4>;

  void load(std::span<const double> of_hinge, int first, int count, double* lanes) const;

  std::size_t count_;
  std::shared_ptr<const SymmetricPattern> pattern_;
  Slabs slabs_;
  std::vector<double> rest_;         // by entry: θ₀
  std::vector<Slabs::Slots> slots_;  // by entry, with a pattern
};

}  // namespace muslin
