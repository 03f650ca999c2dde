#include "muslin/energy/neo_hookean_energy.hpp"

#include "muslin/energy/elements_methods.hpp"
#include "muslin/energy/solid_rows_methods.hpp"

namespace muslin {

template class Elements<TetrahedronStencil, NeoHookeanLaw>;
template class SolidRows<NeoHookeanLaw>;

}  // namespace muslin
