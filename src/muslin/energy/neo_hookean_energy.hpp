// NeoHookeanEnergy is the elastic energy of the tetrahedra of a lattice, six a voxel, with the law of
// neo_hookean_law.hpp:
//
//   W = Σ f V ψ(F),   V = width³/6
//
// f the share of the voxel that the solid fills. The tetrahedra are Kuhn's (lattice/springs.hpp): their edges
// are the seven directions of the springs, so the stiffness has blocks between the same vertices. Linear
// tetrahedra are too stiff in bending for coarse lattices and for Poisson's ratios near ½;
// docs/theory/solids.md has the errors.
#pragma once

#include <memory>

#include "muslin/energy/elements.hpp"
#include "muslin/energy/neo_hookean_law.hpp"
#include "muslin/energy/tetrahedron_stencil.hpp"
#include "muslin/lattice/lattice.hpp"

namespace muslin {

/// Young's modulus E > 0 [Pa], −1 < ν < ½.
struct SolidModuli {
  double young_modulus = 0;
  double poisson = 0;
};

/// Returns the pairs of vertices in a tetrahedron of the lattice.
std::shared_ptr<const SymmetricPattern> tetrahedron_pattern(const Lattice& lattice);

extern template class Elements<TetrahedronStencil, NeoHookeanLaw>;

class NeoHookeanEnergy : public Elements<TetrahedronStencil, NeoHookeanLaw> {
 public:
  /// `pattern` is the lattice's tetrahedron_pattern, or null. Errors: usage, if a modulus is out of its
  /// range.
  NeoHookeanEnergy(const Lattice& lattice, const SolidModuli& moduli,
                   std::shared_ptr<const SymmetricPattern> pattern = nullptr);

 private:
  NeoHookeanEnergy(std::shared_ptr<const Slabs> slabs, const std::vector<std::array<int, 4>>& tetrahedra,
                   const Lattice& lattice, const SolidModuli& moduli,
                   std::shared_ptr<const SymmetricPattern> pattern);
};

}  // namespace muslin
