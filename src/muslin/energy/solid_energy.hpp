// SolidEnergy is the elastic energy of the tetrahedra of a lattice, six a voxel, with a law of the measures
// I_C and J of tetrahedron_stencil.hpp:
//
//   W = Σ f V ψ(F),   V = width³/6
//
// f the share of the voxel that the solid fills. The tetrahedra are Kuhn's (lattice/springs.hpp): their edges
// are the seven directions of the springs, so the stiffness has blocks between the same vertices, and springs
// of the same Young's modulus stand in for it where the linear solver needs springs. The linear solver gets
// the exact stiffness. SolidRows computes all that a step needs; the remaining stiffness is computed
// tetrahedron by tetrahedron. Linear tetrahedra are too stiff in bending for coarse lattices and for
// Poisson's ratios near ½; docs/theory/solids.md has the errors.
//
// solid_laws.hpp lists the laws. A law is instantiated in one source file, which includes
// elements_methods.hpp and solid_rows_methods.hpp.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "muslin/energy/elements.hpp"
#include "muslin/energy/solid_rows.hpp"
#include "muslin/energy/tetrahedron_stencil.hpp"
#include "muslin/lattice/lattice.hpp"
#include "muslin/potential/spring_network.hpp"

namespace muslin {

/// Young's modulus E > 0 [Pa], −1 < ν < ½.
struct SolidModuli {
  double youngs_modulus = 0;
  double poisson = 0;
};
/// Throws Error(usage) unless E > 0 and −1 < ν < 0.5.
void require_moduli(const SolidModuli& moduli);

/// Returns the pairs of vertices in a tetrahedron of the lattice.
std::shared_ptr<const SymmetricPattern> tetrahedron_pattern(const Lattice& lattice);

/// The tetrahedra of a lattice, weighted by its fill.
struct SolidElements {
  explicit SolidElements(const Lattice& lattice);
  std::shared_ptr<const ElementSlabs<4>> slabs;
  TetrahedronStencil stencil;
};

/// Springs that stand in for a solid in the linear solver.
class SolidSprings {
 public:
  SolidSprings(const Lattice& lattice, double youngs_modulus);
  void stand_in(ConstVectors x, const std::shared_ptr<const SymmetricPattern>& pattern, double factor,
                HessianSink& into, std::size_t first) const;

 private:
  std::shared_ptr<const SpringNetwork> network_;
  std::vector<double> stiffness_;  // by kind [N/m]
};

template <class Law>
class SolidEnergy : public Elements<TetrahedronStencil, Law> {
  using Base = Elements<TetrahedronStencil, Law>;

 public:
  /// `pattern` is the lattice's tetrahedron_pattern, or null. Errors: usage, if a modulus is out of its
  /// range.
  SolidEnergy(const Lattice& lattice, const SolidModuli& moduli,
              std::shared_ptr<const SymmetricPattern> pattern = nullptr)
      : SolidEnergy(SolidElements(lattice), lattice, moduli, std::move(pattern)) {}

  double value(ConstVectors x) const override { return rows_.value(x); }
  void add_gradient(ConstVectors x, Vectors g) const override { rows_.add_gradient_and_value(x, g); }
  double add_gradient_and_value(ConstVectors x, Vectors g) const override {
    return rows_.add_gradient_and_value(x, g);
  }
  void add_stiffness_product(Stiffness kind, ConstVectors x, ConstVectors p, Vectors y) const override {
    if (kind == Stiffness::exact || kind == Stiffness::material)
      return rows_.add_stiffness_product(kind, x, p, y);
    Base::add_stiffness_product(kind, x, p, y);
  }
  void linearize(ConstVectors x, HessianSink& into, std::size_t first) const override {
    if (!this->pattern()) return Base::linearize(x, into, first);
    linearize_stiffness(Stiffness::exact, x, 1, into, first);
  }
  /// `kind` is exact or material.
  void linearize_stiffness(Stiffness kind, ConstVectors x, double factor, HessianSink& into,
                           std::size_t first) const override {
    bool fresh = false;
    const PairBlocks to = into.pair_blocks_to_set(this->pattern(), first, fresh);
    rows_.add_pair_blocks(kind, x, into.scale() * factor, fresh, to);
    springs_->stand_in(x, this->pattern(), factor, into, first);
  }

 private:
  SolidEnergy(const SolidElements& elements, const Lattice& lattice, const SolidModuli& moduli,
              std::shared_ptr<const SymmetricPattern> pattern)
      : Base(elements.slabs, elements.stencil,
             LawConstants<Law>(*elements.slabs, [c = constants(moduli)](std::size_t) { return c; }),
             std::move(pattern)),
        rows_(lattice, constants(moduli), this->pattern().get()) {
    if (this->pattern()) springs_ = std::make_shared<const SolidSprings>(lattice, moduli.youngs_modulus);
  }
  static typename Law::Constants constants(const SolidModuli& moduli) {
    require_moduli(moduli);
    return Law::constants(moduli.youngs_modulus, moduli.poisson);
  }

  SolidRows<Law> rows_;
  std::shared_ptr<const SolidSprings> springs_;
};

}  // namespace muslin
