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

MUSLIN_VECTOR_CODE void deviations_of(const Batch<4>& x, const double* rest, double* out) {
  BentHinge h;
  bend_hinge(x, h);
  HingeStencil::find_deviations(h, rest, out);
}

MUSLIN_VECTOR_CODE void gradients_of(const Batch<4>& x, Batch<4>& out) {
  BentHinge h;
  AngleGradient d;
  bend_hinge(x, h);
  gradient_of_angle(h, d);
  angle_to_corners(d, out);
}

MUSLIN_VECTOR_CODE void changes_of(const Batch<4>& x, const Batch<4>& p, double* out) {
  BentHinge h;
  AngleGradient d;
  Batch<4> g;
  bend_hinge(x, h);
  gradient_of_angle(h, d);
  angle_to_corners(d, g);
  for (int l = 0; l < element_lanes; ++l)
    out[l] = dot_lanes(g[0], p[0], l) + dot_lanes(g[1], p[1], l) + dot_lanes(g[2], p[2], l) +
             dot_lanes(g[3], p[3], l);
}

/// force = factor ∇θ
MUSLIN_VECTOR_CODE void forces_of(const Batch<4>& x, const double* factor, Batch<4>& force) {
  BentHinge h;
  AngleGradient d;
  bend_hinge(x, h);
  gradient_of_angle(h, d);
  angle_to_corners(d, force);
  for (int c = 0; c < 4; ++c)
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < element_lanes; ++l) force[c][k][l] *= factor[l];
}

/// force = factor ∇θ + moment ∇²θ p
MUSLIN_VECTOR_CODE void changes_of_forces(const Batch<4>& x, const double* factor, const double* moment,
                                          const Batch<4>& p, Batch<4>& force) {
  BentHinge h;
  AngleGradient d;
  Batch<4> change;
  bend_hinge(x, h);
  gradient_of_angle(h, d);
  angle_to_corners(d, force);
  change_of_angle_gradient(h, d, p, change);
  for (int c = 0; c < 4; ++c)
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < element_lanes; ++l)
        force[c][k][l] = factor[l] * force[c][k][l] + moment[l] * change[c][k][l];
}

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
    : ElementEnergy(std::move(pattern)),
      slabs_(hinge_vertices(shell), shell.vertex_count()),
      stencil_(slabs_, shell),
      coupling_(couple_hinges(shell, moduli, held)) {
  if (this->pattern()) slots_ = slabs_.slots(*this->pattern());
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

void ShellBending::load(std::span<const double> of_hinge, int first, int count, double* lanes) const {
  for (int l = 0; l < element_lanes; ++l)
    lanes[l] = of_hinge[at(slabs_.elements()[at(first + std::min(l, count - 1))])];
}

std::vector<double> ShellBending::deviations(ConstVectors x) const {
  std::vector<double> result(coupling_.lumped.size());
  slabs_.for_each_owned_batch([&](int first, int count) {
    Batch<4> corners;
    double lanes[element_lanes];
    slabs_.gather(first, count, x, corners);
    deviations_of(corners, stencil_.at(first), lanes);
    for (int l = 0; l < count; ++l) result[at(slabs_.elements()[at(first + l)])] = lanes[l];
  });
  return result;
}

std::vector<double> ShellBending::changes(ConstVectors x, ConstVectors p) const {
  std::vector<double> result(coupling_.lumped.size());
  slabs_.for_each_owned_batch([&](int first, int count) {
    Batch<4> corners, along;
    double lanes[element_lanes];
    slabs_.gather(first, count, x, corners);
    slabs_.gather(first, count, p, along);
    changes_of(corners, along, lanes);
    for (int l = 0; l < count; ++l) result[at(slabs_.elements()[at(first + l)])] = lanes[l];
  });
  return result;
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
  const std::vector<double> bent = deviations(x);
  const double linear = half_product(bent, coupling_.times(bent));
  return curves_ ? linear + curves_->energy(bent) : linear;
}

double ShellBending::add_gradient_and_value(ConstVectors x, Vectors g) const {
  const std::vector<double> bent = deviations(x);
  std::vector<double> moments = coupling_.times(bent);
  double energy = half_product(bent, moments);
  if (curves_) energy += curves_->add_moments(bent, moments);
  slabs_.for_each_batch([&](int first, int count, const Slabs::Slab& slab) {
    Batch<4> corners, force;
    double moment[element_lanes];
    slabs_.gather(first, count, x, corners);
    load(moments, first, count, moment);
    forces_of(corners, moment, force);
    slabs_.scatter(first, count, slab, force, g);
  });
  return energy;
}

void ShellBending::add_gradient(ConstVectors x, Vectors g) const { add_gradient_and_value(x, g); }

void ShellBending::add_stiffness_product(Stiffness kind, ConstVectors x, ConstVectors p, Vectors y) const {
  const bool exact = kind == Stiffness::exact;
  const std::vector<double> change = changes(x, p);
  std::vector<double> factors = coupling_.times(change), bent, moments;
  if (exact || curves_) bent = deviations(x);
  if (exact) moments = coupling_.times(bent);
  if (curves_) {
    curves_->add_changes(bent, change, factors);
    if (exact) curves_->add_moments(bent, moments);
  }
  slabs_.for_each_batch([&](int first, int count, const Slabs::Slab& slab) {
    Batch<4> corners, along, force;
    double factor[element_lanes], moment[element_lanes];
    slabs_.gather(first, count, x, corners);
    load(factors, first, count, factor);
    if (exact) {
      slabs_.gather(first, count, p, along);
      load(moments, first, count, moment);
      changes_of_forces(corners, factor, moment, along, force);
    } else {
      forces_of(corners, factor, force);
    }
    slabs_.scatter(first, count, slab, force, y);
  });
}

void ShellBending::add_stiffness_blocks(Stiffness, ConstVectors x, std::span<Mat3> blocks) const {
  slabs_.for_each_batch([&](int first, int count, const Slabs::Slab& slab) {
    Batch<4> corners, gradient;
    slabs_.gather(first, count, x, corners);
    gradients_of(corners, gradient);
    for (int l = 0; l < count; ++l) {
      const double lumped = coupling_.lumped[at(slabs_.elements()[at(first + l)])];
      for (int c = 0; c < 4; ++c) {
        const int v = slabs_.vertices()[at(first + l)][at(c)];
        if (v < slab.vertex_begin || v >= slab.vertex_end) continue;
        const Vec3 g(gradient[c][0][l], gradient[c][1][l], gradient[c][2][l]);
        blocks[at(v)] += lumped * g * g.transpose();
      }
    }
  });
}

void ShellBending::assemble(ConstVectors x, double scale, PairBlocks blocks, Float4* gradients) const {
  slabs_.for_each_batch([&](int first, int count, const Slabs::Slab& slab) {
    Batch<4> corners, gradient;
    double lumped[element_lanes];
    unsigned rows[element_lanes];
    slabs_.gather(first, count, x, corners);
    gradients_of(corners, gradient);
    load(coupling_.lumped, first, count, lumped);
    slabs_.corners_in(first, count, slab, rows);
    HingeStencil::add_squares(lumped, gradient, scale, count, rows, slots_.data() + first, blocks.columns);
    if (gradients == nullptr) return;
    for (int l = 0; l < std::min(count, slab.owned_end - first); ++l) {
      Float4* const to = gradients + 4 * at(slabs_.elements()[at(first + l)]);
      for (int c = 0; c < 4; ++c) {
        to[c] = Float4{static_cast<float>(gradient[c][0][l]), static_cast<float>(gradient[c][1][l]),
                       static_cast<float>(gradient[c][2][l]), 0};
      }
    }
  });
}

void ShellBending::add_stiffness_matrix(Stiffness, ConstVectors x, double scale, std::span<const double>,
                                        PairBlocks blocks) const {
  assemble(x, scale, blocks, nullptr);
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
  assemble(x, scale, into.pair_blocks(pattern(), first),
           whole ? into.coupled_forms(difference_, first, scale) : nullptr);
}

}  // namespace muslin
