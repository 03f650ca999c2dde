// PlasticSprings are the springs of a lattice that dents: each yields where it is stretched or compressed too
// far (energy/plastic_spring_law.hpp) and keeps its plastic strain in the history (potential/history.hpp).
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "muslin/energy/bar_stencil.hpp"
#include "muslin/energy/elements.hpp"
#include "muslin/energy/plastic_spring_law.hpp"
#include "muslin/energy/strain_yield.hpp"
#include "muslin/lattice/springs.hpp"
#include "muslin/potential/potential.hpp"

namespace muslin {

extern template class Elements<BarStencil, PlasticSpringLaw>;

class PlasticSprings : public Load {
 public:
  /// Springs as those of SpringEnergy. `name` is unique among the loads of a run and names the array of
  /// plastic strains in the history, one per spring. `vertices` is their number. Errors: usage, if a number
  /// of `yield` is out of range.
  PlasticSprings(const std::string& name, const Springs& springs, std::size_t vertices, double width,
                 const std::array<double, 3>& moduli, std::span<const float> weights,
                 const StrainYield& yield);
  ~PlasticSprings() override;

  std::unique_ptr<Potential> potential(const StepContext& step) const override;
  void end_step(const Potential& potential, ConstVectors x, History& history) const override;

 private:
  class Energy;

  std::string name_;
  std::shared_ptr<const Energy> at_rest_;
};

}  // namespace muslin
