// The laws of the solid that a lattice may be filled with, one row each.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "muslin/energy/solid_energy.hpp"

namespace muslin {

struct SolidLaw {
  const char* name;     ///< the value of `law` of a material
  const char* meaning;  ///< in the guide
  std::shared_ptr<const ElementEnergy> (*make)(const Lattice& lattice, const SolidModuli& moduli,
                                               std::shared_ptr<const SymmetricPattern> pattern);
};

const std::vector<SolidLaw>& solid_laws();

/// Returns the law of a name; null if there is none.
const SolidLaw* find_solid_law(std::string_view name);

}  // namespace muslin
