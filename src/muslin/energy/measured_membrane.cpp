#include "muslin/energy/measured_membrane.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "muslin/core/error.hpp"
#include "muslin/energy/elements_methods.hpp"

namespace muslin {

template class Elements<TriangleStencil, MeasuredMembraneLaw>;

namespace {

MeasuredMembraneLaw::Constants constants_of(const SheetStress& stress, double poisson,
                                            const BucklingRigidity& rigidity) {
  require(poisson >= 0 && poisson < 1 && poisson <= highest_poisson(stress),
          "a sheet of these curves and this Poisson ratio is unstable", "give 0 to highest_poisson");
  const double warp = stress.warp.slope(0), weft = stress.weft.slope(0);
  const double square = poisson * poisson, narrowed = square / (1 - square);
  Threads threads{warp + narrowed * warp, poisson * std::sqrt(warp * weft) / (1 - square),
                  weft + narrowed * weft, buckling_load(rigidity.warp), buckling_load(rigidity.weft)};
  // So that no thread buckles while it is stretched, where its curve may soften.
  const double load_warp = threads.load_warp, load_weft = threads.load_weft;
  if (threads.c22 > 0) threads.load_warp = std::max(load_warp, threads.c12 / threads.c22 * load_weft);
  if (threads.c11 > 0) threads.load_weft = std::max(load_weft, threads.c12 / threads.c11 * load_warp);
  return {threads, stress.warp.plus(-warp), stress.weft.plus(-weft), stress.shear};
}

/// The masses hold what buckles only where the stiffest state leaves them digits.
TriangleStencil stencil_of(const ElementSlabs<3>& slabs, const Shell& shell,
                           const MeasuredMembraneLaw::Constants& c, bool bounded) {
  TriangleStencil stencil(slabs, shell);
  const PlaneModuli stiffest{c.threads.c11 + c.warp.greatest_slope(), c.threads.c12,
                             c.threads.c22 + c.weft.greatest_slope(), c.shear.greatest_slope()};
  if (bounded) stencil.use_masses(slabs, shell, std::vector<PlaneModuli>(shell.triangles.size(), stiffest));
  return stencil;
}

}  // namespace

MeasuredMembrane::MeasuredMembrane(std::shared_ptr<const Slabs> slabs, const Shell& shell,
                                   const MeasuredMembraneLaw::Constants& constants,
                                   std::shared_ptr<const SymmetricPattern> pattern)
    : Elements(slabs, stencil_of(*slabs, shell, constants, pattern != nullptr),
               LawConstants<MeasuredMembraneLaw>(constants), pattern) {}

MeasuredMembrane::MeasuredMembrane(const Shell& shell, const SheetStress& stress, double poisson,
                                   std::shared_ptr<const SymmetricPattern> pattern,
                                   const BucklingRigidity& rigidity)
    : MeasuredMembrane(triangle_slabs(shell), shell, constants_of(stress, poisson, rigidity),
                       std::move(pattern)) {}

}  // namespace muslin
