// Elements is the elastic energy of a law on the elements of a mesh,
//
//   W = Σ weight ψ(measure),
//
// and everything that does not depend on the law: loops over elements, gathering of corners, products,
// blocks. The stencil computes the measure of an element and its derivatives with respect to the corners, and
// combines them with the derivatives of ψ. For every law it provides these functions over the lanes of a
// batch:
//
//   energies, forces         false where no element of the batch stores energy
//   stiffen                  the stiffness of a kind at x, from which the following compute
//   multiply                 its product with a motion of the corners
//   add_corner_block         one diagonal block
//   add_pair_blocks          all blocks, in float
//
// A pair of law and stencil is instantiated in one source file, which includes elements_methods.hpp.
#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "muslin/energy/element_energy.hpp"
#include "muslin/energy/element_slabs.hpp"
#include "muslin/energy/law.hpp"

namespace muslin {

template <class Stencil, class Law>
class Elements : public ElementEnergy {
 public:
  static constexpr int corners = Stencil::corners;
  using Slabs = ElementSlabs<corners>;

  /// `pattern` has the pairs of vertices of all elements; null: the linear solver computes products from x.
  Elements(std::shared_ptr<const Slabs> slabs, Stencil stencil, LawConstants<Law> constants,
           std::shared_ptr<const SymmetricPattern> pattern);
  /// The elements of `other` with other constants.
  Elements(const Elements& other, LawConstants<Law> constants);

  double value(ConstVectors x) const override;
  void add_gradient(ConstVectors x, Vectors g) const override;
  double add_gradient_and_value(ConstVectors x, Vectors g) const override;
  void add_stiffness_product(Stiffness kind, ConstVectors x, ConstVectors p, Vectors y) const override;
  void add_stiffness_blocks(Stiffness kind, ConstVectors x, std::span<Mat3> blocks) const override;
  void add_stiffness_matrix(Stiffness kind, ConstVectors x, double scale, std::span<const double> masses,
                            PairBlocks blocks) const override;

 protected:
  const Slabs& slabs() const { return *slabs_; }
  const Stencil& stencil() const { return stencil_; }

 private:
  std::shared_ptr<const Slabs> slabs_;
  Stencil stencil_;
  LawConstants<Law> constants_;
  // By entry: the block of each pair of corners.
  std::shared_ptr<const std::vector<typename Slabs::Slots>> slots_;
};

}  // namespace muslin
