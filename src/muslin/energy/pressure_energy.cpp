#include "muslin/energy/pressure_energy.hpp"

#include <cmath>
#include <utility>
#include <vector>

#include "muslin/core/error.hpp"
#include "muslin/core/index.hpp"
#include "muslin/potential/hessian_sink.hpp"

namespace muslin {
namespace {

constexpr double least_share = 0.01;  // of V₀, below which the pressure is linear

Mat3 cross_matrix(const Vec3& e) {
  Mat3 m;
  m << 0, -e.z(), e.y(), e.z(), 0, -e.x(), -e.y(), e.x(), 0;
  return m;
}

/// Half of |p||e|/6 (1 − ê êᵀ).
Mat3 positive_part(double pressure, const Vec3& e) {
  const double length = e.norm();
  if (!(length > 0)) return Mat3::Zero();
  return std::abs(pressure) * length / 12 * (Mat3::Identity() - e * e.transpose() / (length * length));
}

}  // namespace

Gas::At Gas::at(double volume) const {
  if (rest_volume == 0) return {-pressure * volume, pressure, 0};
  const double amount = (atmosphere + pressure) * rest_volume;  // p V [J]
  const auto inside = [&](double v) {
    return At{-amount * std::log(v / rest_volume) + atmosphere * (v - rest_volume), amount / v - atmosphere,
              -amount / (v * v)};
  };
  const double least = least_share * rest_volume;
  if (volume > least) return inside(volume);
  const At there = inside(least);
  const double beyond = volume - least;
  return {there.energy - beyond * (there.pressure + 0.5 * there.slope * beyond),
          there.pressure + there.slope * beyond, there.slope};
}

PressureEnergy::PressureEnergy(std::shared_ptr<const EnclosedVolume> surface, const Gas& gas)
    : surface_(std::move(surface)), gas_(gas) {
  require(std::isfinite(gas.pressure) && std::isfinite(gas.atmosphere) && std::isfinite(gas.rest_volume),
          "a pressure is not finite", "give pascal");
  require(gas.rest_volume >= 0 && (gas.rest_volume == 0 || gas.atmosphere + gas.pressure >= 0),
          "the gas in a surface has a negative volume or absolute pressure",
          "orient the surface outward, and give no less than minus the atmosphere");
  const int count = static_cast<int>(surface_->vertex_count());
  std::vector<std::pair<int, int>> pairs;
  for (const EnclosedVolume::Edge& edge : surface_->edges())
    if (edge.b < count) pairs.emplace_back(edge.a, edge.b);
  pattern_ = std::make_shared<const SymmetricPattern>(std::move(pairs), surface_->vertex_count());
  std::vector<int> slots;
  for (const EnclosedVolume::Edge& edge : surface_->edges())
    slots.push_back(edge.b < count ? pattern_->find(edge.a, edge.b) : -1);
  slots_ = std::make_shared<const std::vector<int>>(std::move(slots));
}

PressureEnergy::PressureEnergy(const PressureEnergy& other, const Gas& gas)
    : surface_(other.surface_), gas_(gas), pattern_(other.pattern_), slots_(other.slots_) {}

double PressureEnergy::value(ConstVectors x) const { return gas_.at(surface_->value(x)).energy; }

void PressureEnergy::add_gradient(ConstVectors x, Vectors g) const {
  surface_->add_gradient(x, -gas_.at(surface_->value(x)).pressure, g);
}

void PressureEnergy::add_hessian_product(ConstVectors x, ConstVectors p, Vectors y) const {
  const Gas::At gas = gas_.at(surface_->value(x));
  surface_->add_hessian_product(x, p, -gas.pressure, y);
  if (gas.slope == 0) return;
  std::vector<Vec3> gradient(x.size(), Vec3::Zero());
  surface_->add_gradient(x, 1, gradient);
  double along = 0;
  for (std::size_t v = 0; v < x.size(); ++v) along += gradient[v].dot(p[v]);
  for (std::size_t v = 0; v < x.size(); ++v) y[v] -= gas.slope * along * gradient[v];
}

void PressureEnergy::add_diagonal_blocks(ConstVectors x, std::span<Mat3> blocks) const {
  const Gas::At gas = gas_.at(surface_->value(x));
  const std::vector<Vec3> all = surface_->with_centres(x);
  for (const EnclosedVolume::Edge& edge : surface_->edges()) {
    if (at(edge.b) >= x.size()) continue;
    const Mat3 part = positive_part(gas.pressure, all[at(edge.right)] - all[at(edge.left)]);
    blocks[at(edge.a)] += part;
    blocks[at(edge.b)] += part;
  }
  if (gas.slope == 0) return;
  std::vector<Vec3> gradient(x.size(), Vec3::Zero());
  surface_->add_gradient(x, 1, gradient);
  for (std::size_t v = 0; v < x.size(); ++v) blocks[v] -= gas.slope * gradient[v] * gradient[v].transpose();
}

void PressureEnergy::linearize(ConstVectors x, HessianSink& into, std::size_t first) const {
  const Gas::At gas = gas_.at(surface_->value(x));
  const std::vector<Vec3> all = surface_->with_centres(x);
  const PairBlocks blocks = into.pair_blocks(pattern_, first);
  const double scale = into.scale();
  const auto add = [&](int slot, const Mat3& matrix) {
    Float4* const columns = blocks.block(slot);
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l) columns[k][l] += static_cast<float>(scale * matrix(l, k));
  };
  for (std::size_t e = 0; e < slots_->size(); ++e) {
    if ((*slots_)[e] < 0) continue;
    const EnclosedVolume::Edge& edge = surface_->edges()[e];
    const Vec3 across = all[at(edge.right)] - all[at(edge.left)];
    add((*slots_)[e], -gas.pressure / 12 * cross_matrix(across));
    const Mat3 part = positive_part(gas.pressure, across);
    add(pattern_->first()[at(edge.a)], part);
    add(pattern_->first()[at(edge.b)], part);
  }
  if (gas.slope == 0) return;
  std::vector<Vec3> gradient(x.size(), Vec3::Zero());
  surface_->add_gradient(x, 1, gradient);
  RankOneTerm term{-scale * gas.slope, {}, {}};
  for (std::size_t v = 0; v < x.size(); ++v) {
    if (gradient[v].isZero(0)) continue;
    term.vertices.push_back(static_cast<int>(v));
    term.gradients.push_back(gradient[v]);
  }
  into.add_rank_one(std::move(term), first);
}

Pressure::Pressure(std::shared_ptr<const EnclosedVolume> surface, GasOfStep gas)
    : none_(std::move(surface), Gas()), gas_(std::move(gas)) {}

std::unique_ptr<Potential> Pressure::potential(const StepContext& step) const {
  const std::optional<Gas> gas = gas_(step.time_begin, step.time_end);
  if (!gas) return nullptr;
  return std::unique_ptr<Potential>(new PressureEnergy(none_, *gas));
}

}  // namespace muslin
