#include "muslin/energy/membrane_energy.hpp"

#include <cassert>
#include <cmath>
#include <utility>

#include "muslin/core/error.hpp"
#include "muslin/energy/elements_methods.hpp"

namespace muslin {

template class Elements<TriangleStencil, MembraneLaw>;

PlaneModuli plane_moduli(const MembraneModuli& moduli) {
  require(moduli.warp >= 0 && moduli.weft >= 0 && moduli.shear >= 0, "a membrane modulus is negative",
          "give 0 or more");
  require(std::abs(moduli.poisson) < 1, "the Poisson ratio of a membrane is not between -1 and 1",
          "give 0 to 0.5");
  const double plane_stress = 1 / (1 - moduli.poisson * moduli.poisson);
  PlaneModuli constants;
  constants.c11 = moduli.warp * plane_stress;
  constants.c22 = moduli.weft * plane_stress;
  constants.c12 = moduli.poisson * std::sqrt(moduli.warp * moduli.weft) * plane_stress;
  constants.g = moduli.shear;
  return constants;
}

namespace {

std::vector<PlaneModuli> plane_moduli(std::span<const MembraneModuli> moduli) {
  std::vector<PlaneModuli> constants;
  for (const MembraneModuli& of_triangle : moduli) constants.push_back(plane_moduli(of_triangle));
  return constants;
}

MembraneLaw::Constants constants_of(const PlaneModuli& m, const BucklingRigidity& rigidity) {
  return {m.c11, m.c12, m.c22, m.g, buckling_load(rigidity.warp), buckling_load(rigidity.weft)};
}

/// By triangle, one for all, or none.
BucklingRigidity rigidity_at(std::span<const BucklingRigidity> rigidities, std::size_t t) {
  return rigidities.empty() ? BucklingRigidity{} : rigidities[rigidities.size() > 1 ? t : 0];
}

TriangleStencil stencil_of(const ElementSlabs<3>& slabs, const Shell& shell,
                           const std::vector<PlaneModuli>& moduli, bool bounded) {
  TriangleStencil stencil(slabs, shell);
  if (bounded) stencil.use_masses(slabs, shell, moduli);
  return stencil;
}

}  // namespace

MembraneEnergy::MembraneEnergy(std::shared_ptr<const Slabs> slabs, const Shell& shell,
                               const std::vector<PlaneModuli>& moduli,
                               std::span<const BucklingRigidity> rigidities,
                               std::shared_ptr<const SymmetricPattern> pattern)
    : Elements(
          slabs, stencil_of(*slabs, shell, moduli, pattern != nullptr),
          LawConstants<MembraneLaw>(
              *slabs, [&](std::size_t t) { return constants_of(moduli[t], rigidity_at(rigidities, t)); }),
          pattern) {}

MembraneEnergy::MembraneEnergy(const Shell& shell, const MembraneModuli& moduli,
                               std::shared_ptr<const SymmetricPattern> pattern,
                               const BucklingRigidity& rigidity)
    : MembraneEnergy(triangle_slabs(shell), shell,
                     std::vector<PlaneModuli>(shell.triangles.size(), plane_moduli(moduli)),
                     std::span(&rigidity, 1), std::move(pattern)) {}

MembraneEnergy::MembraneEnergy(const Shell& shell, std::span<const MembraneModuli> moduli,
                               std::shared_ptr<const SymmetricPattern> pattern,
                               std::span<const BucklingRigidity> rigidities)
    : MembraneEnergy(triangle_slabs(shell), shell, plane_moduli(moduli), rigidities, std::move(pattern)) {
  assert(moduli.size() == shell.triangles.size());
  assert(rigidities.empty() || rigidities.size() == moduli.size());
}

}  // namespace muslin
