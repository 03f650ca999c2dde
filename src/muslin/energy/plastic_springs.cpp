#include "muslin/energy/plastic_springs.hpp"

#include <utility>

#include "muslin/core/error.hpp"
#include "muslin/core/index.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/energy/elements_methods.hpp"
#include "muslin/potential/history.hpp"

namespace muslin {

template class Elements<BarStencil, PlasticSpringLaw>;

namespace {

using SpringConstants = PlasticSpringLaw::Constants;

std::shared_ptr<const SymmetricPattern> pattern_of(const std::vector<std::array<int, 2>>& bars,
                                                   std::size_t vertices) {
  std::vector<std::pair<int, int>> pairs;
  pairs.reserve(bars.size());
  for (const auto& bar : bars) pairs.emplace_back(bar[0], bar[1]);
  return std::make_shared<SymmetricPattern>(std::move(pairs), vertices);
}

}  // namespace

/// The energy of one step.
class PlasticSprings::Energy : public Elements<BarStencil, PlasticSpringLaw> {
 public:
  struct Bars {
    std::vector<std::array<int, 2>> vertices;
    std::vector<double> lengths;  // at rest [m]
  };

  Energy(std::shared_ptr<const Slabs> slabs, std::shared_ptr<const Bars> bars,
         std::vector<SpringConstants> constants, std::size_t vertices)
      : Elements(slabs, BarStencil(*slabs, bars->lengths), lanes(*slabs, constants),
                 pattern_of(bars->vertices, vertices)),
        bars_(std::move(bars)),
        constants_(std::move(constants)) {}
  Energy(const Energy& other, std::vector<SpringConstants> constants)
      : Elements(other, lanes(other.slabs(), constants)),
        bars_(other.bars_),
        constants_(std::move(constants)) {}

  double dissipated(ConstVectors x) const override {
    constexpr std::size_t grain = 4096;
    return parallel_sum(constants_.size(), grain, 0.0, [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t i = begin; i < end; ++i)
        sum += PlasticSpringLaw::dissipated(constants_[i], strain(i, x));
      return sum;
    });
  }
  const std::vector<SpringConstants>& constants() const { return constants_; }
  /// Returns the plastic strain after a step that ends at x.
  double set(std::size_t i, ConstVectors x) const {
    const double of = strain(i, x);
    return of - PlasticSpringLaw::elastic(constants_[i], of);
  }

 private:
  static LawConstants<PlasticSpringLaw> lanes(const Slabs& slabs,
                                              const std::vector<SpringConstants>& constants) {
    return LawConstants<PlasticSpringLaw>(slabs, [&](std::size_t i) { return constants[i]; });
  }
  double strain(std::size_t i, ConstVectors x) const {
    const auto& [a, b] = bars_->vertices[i];
    return (x[at(b)] - x[at(a)]).norm() / bars_->lengths[i] - 1;
  }

  std::shared_ptr<const Bars> bars_;
  std::vector<SpringConstants> constants_;  // by spring
};

PlasticSprings::PlasticSprings(const std::string& name, const Springs& springs, std::size_t vertices,
                               double width, const std::array<double, 3>& moduli,
                               std::span<const float> weights, const StrainYield& yield)
    : name_(name + ".plastic_strain") {
  require(yield.strain > 0, "a yield strain is not positive", "give more than 0");
  require(yield.hardening >= 0 && yield.hardening <= 1, "the hardening of springs is not between 0 and 1",
          "give 0 to 1");
  auto bars = std::make_shared<Energy::Bars>();
  std::vector<SpringConstants> constants(at(springs.count));
  bars->vertices.resize(constants.size());
  bars->lengths.resize(constants.size());
  for (const SpringRun& run : springs.runs) {
    const SpringDirection& direction = springs.directions[at(run.direction)];
    const double length = width * direction.offset.cast<double>().norm();
    const double stiffness = moduli[static_cast<std::size_t>(direction.kind)] * width;
    for (int i = 0; i < run.length; ++i) {
      const std::size_t spring = at(run.first + i);
      const double weight = weights.empty() ? 1.0 : static_cast<double>(weights[spring]);
      bars->vertices[spring] = {run.a + i, run.b + i};
      bars->lengths[spring] = length;
      constants[spring] = {weight * stiffness * length * length, yield.strain, yield.hardening, 0};
    }
  }
  at_rest_ = std::make_shared<const Energy>(std::make_shared<const ElementSlabs<2>>(bars->vertices, vertices),
                                            bars, std::move(constants), vertices);
}

PlasticSprings::~PlasticSprings() = default;

std::unique_ptr<Potential> PlasticSprings::potential(const StepContext& step) const {
  std::vector<SpringConstants> constants = at_rest_->constants();
  if (step.history != nullptr) {
    const std::span<const double> plastic = step.history->find(name_, constants.size());
    for (std::size_t i = 0; i < plastic.size(); ++i) constants[i].plastic = plastic[i];
  }
  return std::make_unique<Energy>(*at_rest_, std::move(constants));
}

void PlasticSprings::end_step(const Potential& potential, ConstVectors x, History& history) const {
  const auto& energy = static_cast<const Energy&>(potential);
  const std::span<double> plastic = history.get(name_, energy.constants().size());
  for (std::size_t i = 0; i < plastic.size(); ++i) plastic[i] = energy.set(i, x);
}

}  // namespace muslin
