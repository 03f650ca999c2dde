// PlasticHinges is the bending of a shell that stays bent where it is folded too far, as paper, foil or a
// crease. Each hinge remembers its plastic angle and its slip (potential/history.hpp).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "muslin/energy/elements.hpp"
#include "muslin/energy/hinge_bending.hpp"
#include "muslin/energy/hinge_stencil.hpp"
#include "muslin/energy/plastic_hinge_law.hpp"
#include "muslin/shell/shell.hpp"

namespace muslin {

struct YieldLimit {
  double angle = 0;      ///< θ_y ≥ 0 of a hinge
  double hardening = 0;  ///< h ≥ 0
};

extern template class Elements<HingeStencil, PlasticHingeLaw>;

class PlasticHinges : public Load {
 public:
  /// `name` is unique among the loads of a run and names what the hinges remember. `pattern` is the shell's
  /// block_pattern, or null. Errors: usage, if a modulus or the limit is negative.
  PlasticHinges(std::string name, const Shell& shell, const BendingModuli& moduli, const YieldLimit& limit,
                std::shared_ptr<const SymmetricPattern> pattern = nullptr);
  ~PlasticHinges() override;

  std::unique_ptr<Potential> potential(const StepContext& step) const override;
  void end_step(const Potential& potential, ConstVectors x, History& history) const override;

  /// Returns θ_p of every hinge, in a history of a run; empty before the first step.
  std::span<const double> plastic_angles(const History& history) const;

 private:
  class Energy;

  std::string plastic_name_, slip_name_;
  std::size_t count_;
  std::shared_ptr<const Energy> at_rest_;
};

}  // namespace muslin
