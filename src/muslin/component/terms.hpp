// PotentialTerm and LoadTerm are potentials and loads with a name and a role in the energy balance.
#pragma once

#include <memory>
#include <string>

#include "muslin/potential/potential.hpp"

namespace muslin {

/// Role of a potential in the energy balance.
enum class EnergyRole {
  elastic,      ///< stored in the material
  joint,        ///< stored in springs between bodies
  potential,    ///< stored in a fixed field (gravity)
  work,         ///< done on the bodies from outside (point forces, wind)
  support,      ///< likewise, by what holds a body; its force answers to others and starts no motion
  dissipation,  ///< lost (damping)
};

/// A potential of the vertices of one component, or of all vertices of a model.
struct PotentialTerm {
  std::string name;
  EnergyRole role = EnergyRole::elastic;
  std::shared_ptr<const Potential> potential;
};
/// A load of the vertices of one component, or of all vertices of a model.
struct LoadTerm {
  std::string name;
  EnergyRole role = EnergyRole::work;
  std::shared_ptr<const Load> load;
};

}  // namespace muslin
