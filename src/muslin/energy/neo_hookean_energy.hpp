// NeoHookeanEnergy is a solid with the law of neo_hookean_law.hpp.
#pragma once

#include "muslin/energy/neo_hookean_law.hpp"
#include "muslin/energy/solid_energy.hpp"

namespace muslin {

extern template class Elements<TetrahedronStencil, NeoHookeanLaw>;
extern template class SolidRows<NeoHookeanLaw>;

using NeoHookeanEnergy = SolidEnergy<NeoHookeanLaw>;

}  // namespace muslin
