#include "muslin/energy/solid_laws.hpp"

#include <algorithm>
#include <utility>

#include "muslin/energy/neo_hookean_energy.hpp"

namespace muslin {
namespace {

template <class Energy>
std::shared_ptr<const ElementEnergy> make(const Lattice& lattice, const SolidModuli& moduli,
                                          std::shared_ptr<const SymmetricPattern> pattern) {
  return std::make_shared<const Energy>(lattice, moduli, std::move(pattern));
}

}  // namespace

const std::vector<SolidLaw>& solid_laws() {
  static const std::vector<SolidLaw> laws = {
      {"neo_hookean", "a solid of tetrahedra in place of springs, with a stated E and ν",
       make<NeoHookeanEnergy>}};
  return laws;
}

const SolidLaw* find_solid_law(std::string_view name) {
  const auto law = std::find_if(solid_laws().begin(), solid_laws().end(),
                                [&](const SolidLaw& each) { return each.name == name; });
  return law != solid_laws().end() ? &*law : nullptr;
}

}  // namespace muslin
