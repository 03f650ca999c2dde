#include "muslin/energy/hinge_bending.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "muslin/core/error.hpp"
#include "muslin/energy/elements_methods.hpp"

namespace muslin {

template class Elements<HingeStencil, HingeLaw>;

namespace {

double rigidity(const BendingModuli& m, double warp_share) {
  const double weft_share = 1 - warp_share;
  return m.warp * warp_share * warp_share + m.weft * weft_share * weft_share +
         (4 * m.bias - m.warp - m.weft) * warp_share * weft_share;
}

}  // namespace

double lowest_bias(double warp, double weft) {
  const double difference = std::sqrt(warp) - std::sqrt(weft);
  return difference * difference / 4;
}

std::vector<double> hinge_stiffnesses(const Shell& shell, const BendingModuli& moduli) {
  require(moduli.warp >= 0 && moduli.weft >= 0, "a bending modulus is negative", "give 0 or more");
  std::vector<double> stiffnesses;
  for (const Hinge& hinge : shell.hinges)
    stiffnesses.push_back(std::max(0.0, rigidity(moduli, hinge.warp_share)) * hinge.length * hinge.length /
                          hinge.area);
  return stiffnesses;
}

HingeBending::HingeBending(std::shared_ptr<const Slabs> slabs, const Shell& shell,
                           const std::vector<double>& stiffness,
                           std::shared_ptr<const SymmetricPattern> pattern)
    : Elements(
          slabs, HingeStencil(*slabs, shell),
          LawConstants<HingeLaw>(*slabs, [&](std::size_t e) { return HingeLaw::Constants{stiffness[e]}; }),
          std::move(pattern)) {}

HingeBending::HingeBending(const Shell& shell, const BendingModuli& moduli,
                           std::shared_ptr<const SymmetricPattern> pattern)
    : HingeBending(std::make_shared<const Slabs>(hinge_vertices(shell), shell.vertex_count()), shell,
                   hinge_stiffnesses(shell, moduli), std::move(pattern)) {}

}  // namespace muslin
