// PlasticMembrane is the membrane of cloth that bags: its threads stay longer where they are pulled too far
// (energy/plastic_membrane_law.hpp). The plastic strains are in the history (potential/history.hpp).
#pragma once

#include <memory>
#include <string>

#include "muslin/energy/elements.hpp"
#include "muslin/energy/membrane_energy.hpp"
#include "muslin/energy/plastic_membrane_law.hpp"
#include "muslin/energy/strain_yield.hpp"
#include "muslin/energy/triangle_stencil.hpp"
#include "muslin/potential/potential.hpp"
#include "muslin/shell/shell.hpp"

namespace muslin {

extern template class Elements<TriangleStencil, PlasticMembraneLaw>;

class PlasticMembrane : public Load {
 public:
  /// `name` is unique among the loads of a run and names the array of plastic strains in the history, those
  /// of warp and weft of each triangle. `pattern` is the shell's block_pattern, or null. Errors: usage, if a
  /// modulus or a number of `yield` is out of range; warp and weft must resist stretch.
  PlasticMembrane(const std::string& name, const Shell& shell, const MembraneModuli& moduli,
                  const StrainYield& yield, std::shared_ptr<const SymmetricPattern> pattern = nullptr);
  ~PlasticMembrane() override;

  std::unique_ptr<Potential> potential(const StepContext& step) const override;
  void end_step(const Potential& potential, ConstVectors x, History& history) const override;

 private:
  class Energy;

  std::string name_;
  std::shared_ptr<const Energy> at_rest_;
};

}  // namespace muslin
