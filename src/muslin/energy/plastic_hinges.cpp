#include "muslin/energy/plastic_hinges.hpp"

#include <algorithm>
#include <numbers>
#include <span>
#include <string>
#include <utility>

#include "muslin/core/error.hpp"
#include "muslin/energy/elements_methods.hpp"

namespace muslin {

template class Elements<HingeStencil, PlasticHingeLaw>;

namespace {

double rigidity(const BendingModuli& m, double warp_share) {
  const double weft_share = 1 - warp_share;
  return m.warp * warp_share * warp_share + m.weft * weft_share * weft_share +
         (4 * m.bias - m.warp - m.weft) * warp_share * weft_share;
}

/// ψ'' of every hinge [N·m].
std::vector<double> hinge_stiffnesses(const Shell& shell, const BendingModuli& moduli) {
  require(moduli.warp >= 0 && moduli.weft >= 0, "a bending modulus is negative", "give 0 or more");
  std::vector<double> stiffnesses;
  for (const Hinge& hinge : shell.hinges)
    stiffnesses.push_back(std::max(0.0, rigidity(moduli, hinge.warp_share)) * hinge.length * hinge.length /
                          hinge.area);
  return stiffnesses;
}

}  // namespace

/// The energy of one step.
class PlasticHinges::Energy : public Elements<HingeStencil, PlasticHingeLaw> {
 public:
  using Constants = PlasticHingeLaw::Constants;

  Energy(std::shared_ptr<const Slabs> slabs, const Shell& shell, std::vector<Constants> constants,
         std::shared_ptr<const SymmetricPattern> pattern)
      : Elements(slabs, HingeStencil(*slabs, shell), lanes(*slabs, constants), std::move(pattern)),
        hinges_(std::make_shared<const std::vector<Hinge>>(shell.hinges)),
        constants_(std::move(constants)) {}
  Energy(const Energy& other, std::vector<Constants> constants)
      : Elements(other, lanes(other.slabs(), constants)),
        hinges_(other.hinges_),
        constants_(std::move(constants)) {}

  double dissipated(ConstVectors x) const override {
    double sum = 0;
    for (std::size_t h = 0; h < constants_.size(); ++h)
      sum += PlasticHingeLaw::dissipated(constants_[h], deviation(h, x));
    return sum;
  }

  const std::vector<Constants>& constants() const { return constants_; }
  /// θ − θ₀ within −π … π.
  double deviation(std::size_t h, ConstVectors x) const {
    constexpr double turn = 2 * std::numbers::pi;
    const Hinge& hinge = (*hinges_)[h];
    const auto at = [&](std::size_t c) { return x[static_cast<std::size_t>(hinge.vertices[c])]; };
    const double difference = hinge_angle(at(0), at(1), at(2), at(3)) - hinge.angle;
    return difference - (difference > turn / 2 ? turn : 0) + (difference < -turn / 2 ? turn : 0);
  }

 private:
  static LawConstants<PlasticHingeLaw> lanes(const Slabs& slabs, const std::vector<Constants>& constants) {
    return LawConstants<PlasticHingeLaw>(slabs, [&](std::size_t h) { return constants[h]; });
  }

  std::shared_ptr<const std::vector<Hinge>> hinges_;
  std::vector<Constants> constants_;  // by hinge
};

PlasticHinges::PlasticHinges(const std::string& name, const Shell& shell, const BendingModuli& moduli,
                             const YieldLimit& limit, std::shared_ptr<const SymmetricPattern> pattern)
    : plastic_name_(name + ".plastic_angle"), slip_name_(name + ".slip"), count_(shell.hinges.size()) {
  require(limit.angle >= 0 && limit.hardening >= 0, "a yield angle or hardening is negative",
          "give 0 or more");
  std::vector<Energy::Constants> constants;
  for (const double stiffness : hinge_stiffnesses(shell, moduli))
    constants.push_back({stiffness, limit.angle, limit.hardening, 0, 0});
  at_rest_ = std::make_shared<const Energy>(
      std::make_shared<const ElementSlabs<4>>(hinge_vertices(shell), shell.vertex_count()), shell,
      std::move(constants), std::move(pattern));
}

PlasticHinges::~PlasticHinges() = default;

std::unique_ptr<Potential> PlasticHinges::potential(const StepContext& step) const {
  std::vector<Energy::Constants> constants = at_rest_->constants();
  if (step.history != nullptr) {
    const std::span<const double> plastic = step.history->find(plastic_name_, count_),
                                  slip = step.history->find(slip_name_, count_);
    for (std::size_t h = 0; h < plastic.size(); ++h) constants[h].plastic = plastic[h];
    for (std::size_t h = 0; h < slip.size(); ++h) constants[h].slipped = slip[h];
  }
  return std::make_unique<Energy>(*at_rest_, std::move(constants));
}

void PlasticHinges::end_step(const Potential& potential, ConstVectors x, History& history) const {
  const Energy& energy = static_cast<const Energy&>(potential);
  std::vector<double> slips(count_);
  const std::span<double> plastic = history.get(plastic_name_, count_);
  for (std::size_t h = 0; h < count_; ++h) {
    const Energy::Constants& c = energy.constants()[h];
    const double w = energy.deviation(h, x);
    slips[h] = PlasticHingeLaw::slip(c, w);
    plastic[h] = c.plastic + (w < c.plastic ? -slips[h] : slips[h]);
  }
  const std::span<double> slipped = history.get(slip_name_, count_);
  for (std::size_t h = 0; h < count_; ++h) slipped[h] = energy.constants()[h].slipped + slips[h];
}

std::span<const double> PlasticHinges::plastic_angles(const History& history) const {
  return history.find(plastic_name_, count_);
}

}  // namespace muslin
