// NeoHookeanEnergy is the elastic energy of the tetrahedra of a lattice, six per voxel, with the law of
// neo_hookean_law.hpp:
//
//   W = Σ f V ψ(F),   V = width³/6
//
// f the share of the voxel that the solid fills. The tetrahedra are Kuhn's (lattice/springs.hpp): their edges
// are the seven directions of the springs, so the stiffness has blocks between the same vertices, and springs
// of the same Young's modulus stand in for it in the preconditioner. Linear tetrahedra are too stiff in
// bending for coarse lattices and for Poisson's ratios near ½; docs/theory/solids.md has the errors.
#pragma once

#include <memory>
#include <vector>

#include "muslin/energy/elements.hpp"
#include "muslin/energy/neo_hookean_law.hpp"
#include "muslin/energy/tetrahedron_stencil.hpp"
#include "muslin/lattice/lattice.hpp"
#include "muslin/potential/spring_network.hpp"

namespace muslin {

/// Young's modulus E > 0 [Pa], −1 < ν < ½.
struct SolidModuli {
  double youngs_modulus = 0;
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

  void linearize(ConstVectors x, HessianSink& into, std::size_t first) const override;

 private:
  NeoHookeanEnergy(std::shared_ptr<const Slabs> slabs, const std::vector<std::array<int, 4>>& tetrahedra,
                   const Lattice& lattice, const SolidModuli& moduli,
                   std::shared_ptr<const SymmetricPattern> pattern);

  // Springs of the same Young's modulus, for the preconditioner.
  std::shared_ptr<const SpringNetwork> network_;
  std::vector<double> stiffness_;  // by kind [N/m]
};

}  // namespace muslin
