#include "muslin/energy/neo_hookean_energy.hpp"

#include "muslin/energy/elements_methods.hpp"

namespace muslin {

template class Elements<TetrahedronStencil, NeoHookeanLaw>;

}  // namespace muslin
