#include "muslin/energy/shell_bending.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "muslin/core/index.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

// Up to this ratio of the stiffness of all hinges times dt² to the masses, Newton's method with the lumped
// matrix takes at most a few iterations more, and linear iterations cost half (docs/notebook/bending.md).
constexpr double stiff = 16;

std::shared_ptr<const FormCoupling> difference_of(const Shell& shell, const HingeCoupling& coupling) {
  auto difference = std::make_shared<FormCoupling>();
  difference->vertices = hinge_vertices(shell);
  difference->first = coupling.first;
  difference->columns = coupling.columns;
  difference->values.reserve(coupling.values.size());
  for (std::size_t e = 0; e + 1 < coupling.first.size(); ++e) {
    for (int k = coupling.first[e]; k < coupling.first[e + 1]; ++k) {
      const double lumped = at(coupling.columns[at(k)]) == e ? coupling.lumped[e] : 0;
      difference->values.push_back(static_cast<float>(coupling.values[at(k)] - lumped));
    }
  }
  difference->find_shares(shell.vertex_count());
  return difference;
}

/// The plate of these rigidities along the threads, with the twisting rigidity of the unbent curves and the
/// coupling of their least slopes.
BendingModuli plate_of(const BendingCurves& c, double warp, double weft) {
  const double twist = c.bias - lowest_bias(c.warp.slope(0), c.weft.slope(0), c.poisson);
  const double coupling = c.poisson * std::sqrt(c.warp.least_slope() * c.weft.least_slope());
  const double mean = std::sqrt(warp * weft), poisson = mean > 0 ? coupling / mean : 0;
  return {warp, weft, lowest_bias(warp, weft, poisson) + twist, poisson};
}

}  // namespace

ShellBending::ShellBending(const Shell& shell, const BendingModuli& moduli,
                           std::shared_ptr<const SymmetricPattern> pattern,
                           std::span<const std::uint8_t> held)
    : ShellBending(shell, std::span(&moduli, 1), std::move(pattern), held) {}

ShellBending::ShellBending(const Shell& shell, std::span<const BendingModuli> moduli,
                           std::shared_ptr<const SymmetricPattern> pattern,
                           std::span<const std::uint8_t> held)
    : ElementEnergy(pattern),
      angles_(std::make_shared<const HingeAngles>(shell, std::move(pattern))),
      coupling_(couple_hinges(shell, moduli, held)) {
  prepare_systems(shell, coupling_);
}

ShellBending::ShellBending(const Shell& shell, const BendingCurves& curves,
                           std::shared_ptr<const SymmetricPattern> pattern,
                           std::span<const std::uint8_t> held)
    : ShellBending(shell, plate_of(curves, curves.warp.least_slope(), curves.weft.least_slope()),
                   std::move(pattern), held) {
  const double warp = curves.warp.least_slope(), weft = curves.weft.least_slope();
  curves_.emplace(plate_curvatures(shell, plate_of(curves, warp, weft), held), shell.areas,
                  curves.warp.plus(-warp), curves.weft.plus(-weft));
  const HingeCoupling stiffest = couple_hinges(
      shell, plate_of(curves, curves.warp.greatest_slope(), curves.weft.greatest_slope()), held);
  coupling_.lumped = stiffest.lumped;
  prepare_systems(shell, stiffest);
}

void ShellBending::prepare_systems(const Shell& shell, const HingeCoupling& stiffest) {
  if (!pattern()) return;
  difference_ = difference_of(shell, stiffest);
  // A mean of (1/h₁ + 1/h₂)², h₁ and h₂ the heights of its triangles.
  stiffness_ = 0;
  for (std::size_t e = 0; e < shell.hinges.size(); ++e)
    stiffness_ += stiffest.lumped[e] * std::pow(2 * shell.hinges[e].length / shell.hinges[e].area, 2);
}

namespace {

double half_product(std::span<const double> p, std::span<const double> q) {
  return parallel_sum(p.size(), 4096, 0.0, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t e = begin; e < end; ++e) sum += p[e] * q[e];
    return 0.5 * sum;
  });
}

}  // namespace

double ShellBending::value(ConstVectors x) const {
  const std::vector<double> bent = angles_->deviations(x);
  const double linear = half_product(bent, coupling_.times(bent));
  return curves_ ? linear + curves_->energy(bent) : linear;
}

double ShellBending::add_gradient_and_value(ConstVectors x, Vectors g) const {
  const std::vector<double> bent = angles_->deviations(x);
  std::vector<double> moments = coupling_.times(bent);
  double energy = half_product(bent, moments);
  if (curves_) energy += curves_->add_moments(bent, moments);
  angles_->add_forces(x, moments, g);
  return energy;
}

void ShellBending::add_gradient(ConstVectors x, Vectors g) const { add_gradient_and_value(x, g); }

void ShellBending::add_stiffness_product(Stiffness kind, ConstVectors x, ConstVectors p, Vectors y) const {
  const bool exact = kind == Stiffness::exact;
  const std::vector<double> change = angles_->changes(x, p);
  std::vector<double> factors = coupling_.times(change), bent;
  if (exact || curves_) bent = angles_->deviations(x);
  if (curves_) curves_->add_changes(bent, change, factors);
  if (!exact) return angles_->add_forces(x, factors, y);
  std::vector<double> moments = coupling_.times(bent);
  if (curves_) curves_->add_moments(bent, moments);
  angles_->add_force_changes(x, factors, moments, p, y);
}

void ShellBending::add_stiffness_blocks(Stiffness, ConstVectors x, std::span<Mat3> blocks) const {
  angles_->add_blocks(x, coupling_.lumped, blocks);
}

void ShellBending::add_stiffness_matrix(Stiffness, ConstVectors x, double scale, std::span<const double>,
                                        PairBlocks blocks) const {
  angles_->assemble(x, coupling_.lumped, scale, blocks, nullptr);
}

bool ShellBending::is_stiff(double scale, std::span<const double> masses,
                            std::span<const std::uint8_t> fixed) const {
  double free = 0;
  for (std::size_t v = 0; v < masses.size(); ++v) free += fixed[v] == 0 ? masses[v] : 0;
  return scale * stiffness_ > stiff * free;
}

void ShellBending::linearize_stiffness(Stiffness, ConstVectors x, double factor, HessianSink& into,
                                       std::size_t first) const {
  const double scale = into.scale() * factor;
  const bool whole =
      is_stiff(scale, into.masses().subspan(first, x.size()), into.fixed().subspan(first, x.size()));
  angles_->assemble(x, coupling_.lumped, scale, into.pair_blocks(pattern(), first),
                    whole ? into.coupled_forms(difference_, first, scale) : nullptr);
}

}  // namespace muslin
