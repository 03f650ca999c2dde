#include "muslin/energy/stretch_limit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "muslin/core/error.hpp"
#include "muslin/energy/elements_methods.hpp"

namespace muslin {

template class Elements<TriangleStencil, StretchLimitLaw>;

namespace {

constexpr double gravity = 9.81;        // [m/s²]
constexpr double end_of_barrier = 0.5;  // share of the range from onset to limit

LawConstants<StretchLimitLaw> limit_constants(const ElementSlabs<3>& slabs, std::span<const double> limits,
                                              std::span<const double> stiffnesses) {
  return LawConstants<StretchLimitLaw>(slabs, [&](std::size_t t) {
    require(stiffnesses[t] >= 0, "the stiffness of a stretch limit is negative", "give 0 or more");
    return StretchLimitLaw::Constants{stiffnesses[t], StretchBarrier(limits[t]).numbers()};
  });
}

}  // namespace

StretchBarrier::StretchBarrier(double limit) {
  require(limit > 1, "a stretch limit is not above 1", "give the largest length over the rest length");
  n_.limit = limit;
  n_.onset = 0.5 * (1 + limit);
  n_.width = limit - n_.onset;
  n_.stiff = n_.onset + end_of_barrier * n_.width;
  const Law there = barrier(end_of_barrier);
  n_.value = there.value, n_.slope = there.slope, n_.curvature = there.curvature;
}

double stretch_limit_stiffness(double membrane, double mass, double mean_edge, double limit) {
  return 2 * std::max(membrane, mass * gravity / (mean_edge * (limit - 1)));
}

StretchLimitEnergy::StretchLimitEnergy(const Shell& shell, std::span<const double> limits,
                                       std::span<const double> stiffnesses,
                                       std::shared_ptr<const SymmetricPattern> pattern)
    : StretchLimitEnergy(triangle_slabs(shell), shell, limits, stiffnesses, std::move(pattern)) {}

StretchLimitEnergy::StretchLimitEnergy(const Shell& shell, double limit, double stiffness,
                                       std::shared_ptr<const SymmetricPattern> pattern)
    : StretchLimitEnergy(shell, std::vector<double>(shell.triangles.size(), limit),
                         std::vector<double>(shell.triangles.size(), stiffness), std::move(pattern)) {}

StretchLimitEnergy::StretchLimitEnergy(std::shared_ptr<const Slabs> slabs, const Shell& shell,
                                       std::span<const double> limits, std::span<const double> stiffnesses,
                                       std::shared_ptr<const SymmetricPattern> pattern)
    : Elements(slabs, TriangleStencil(*slabs, shell), limit_constants(*slabs, limits, stiffnesses),
               std::move(pattern)) {}

StretchLimitEnergy::StretchLimitEnergy(const StretchLimitEnergy& other, std::span<const double> limits,
                                       std::span<const double> stiffnesses)
    : Elements(other, limit_constants(other.slabs(), limits, stiffnesses)) {}

}  // namespace muslin
