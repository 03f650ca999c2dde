#include "muslin/energy/plastic_membrane.hpp"

#include <utility>
#include <vector>

#include "muslin/core/error.hpp"
#include "muslin/core/index.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/energy/elements_methods.hpp"
#include "muslin/potential/history.hpp"

namespace muslin {

template class Elements<TriangleStencil, PlasticMembraneLaw>;

namespace {

using SheetConstants = PlasticMembraneLaw::Constants;

TriangleStencil stencil_with_masses(const ElementSlabs<3>& slabs, const Shell& shell,
                                    const PlaneModuli& moduli) {
  TriangleStencil stencil(slabs, shell);
  stencil.use_masses(slabs, shell, std::vector<PlaneModuli>(shell.triangles.size(), moduli));
  return stencil;
}

}  // namespace

/// The energy of one step.
class PlasticMembrane::Energy : public Elements<TriangleStencil, PlasticMembraneLaw> {
 public:
  struct Triangles {
    std::vector<Vec3i> corners;
    std::vector<Mat2> inverses;
    std::vector<double> areas;
  };

  Energy(std::shared_ptr<const Slabs> slabs, const Shell& shell, std::vector<SheetConstants> constants,
         std::shared_ptr<const SymmetricPattern> pattern)
      : Elements(slabs,
                 stencil_with_masses(*slabs, shell,
                                     {constants.front().c11, constants.front().c12, constants.front().c22,
                                      constants.front().g}),
                 lanes(*slabs, constants), std::move(pattern)),
        triangles_(
            std::make_shared<const Triangles>(Triangles{shell.triangles, shell.inverses, shell.areas})),
        constants_(std::move(constants)) {}
  Energy(const Energy& other, std::vector<SheetConstants> constants)
      : Elements(other, lanes(other.slabs(), constants)),
        triangles_(other.triangles_),
        constants_(std::move(constants)) {}

  double dissipated(ConstVectors x) const override {
    constexpr std::size_t grain = 4096;
    return parallel_sum(constants_.size(), grain, 0.0, [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t t = begin; t < end; ++t)
        sum += PlasticMembraneLaw::dissipated(constants_[t], triangles_->areas[t], metric_of(t, x));
      return sum;
    });
  }
  const std::vector<SheetConstants>& constants() const { return constants_; }
  PlasticMembraneLaw::Slip slip(std::size_t t, ConstVectors x) const {
    return PlasticMembraneLaw::slip(constants_[t], metric_of(t, x));
  }

 private:
  static LawConstants<PlasticMembraneLaw> lanes(const Slabs& slabs,
                                                const std::vector<SheetConstants>& constants) {
    return LawConstants<PlasticMembraneLaw>(slabs, [&](std::size_t t) { return constants[t]; });
  }
  Metric metric_of(std::size_t t, ConstVectors x) const {
    const Vec3i& v = triangles_->corners[t];
    const Vec3 e1 = x[at(v[1])] - x[at(v[0])], e2 = x[at(v[2])] - x[at(v[0])];
    const Mat2& d = triangles_->inverses[t];
    const Vec3 a = e1 * d(0, 0) + e2 * d(1, 0), b = e1 * d(0, 1) + e2 * d(1, 1);
    return {a.squaredNorm(), b.squaredNorm(), a.dot(b)};
  }

  std::shared_ptr<const Triangles> triangles_;
  std::vector<SheetConstants> constants_;  // by triangle
};

PlasticMembrane::PlasticMembrane(const std::string& name, const Shell& shell, const MembraneModuli& moduli,
                                 const StrainYield& yield, std::shared_ptr<const SymmetricPattern> pattern)
    : name_(name + ".plastic_strain") {
  require(yield.strain > 0, "the yield strain of a membrane is not positive", "give more than 0");
  require(yield.hardening >= 0 && yield.hardening <= 1, "the hardening of threads is not between 0 and 1",
          "give 0 to 1");
  require(moduli.warp > 0 && moduli.weft > 0, "a thread that yields has no stiffness", "give more than 0");
  const PlaneModuli c = plane_moduli(moduli);
  const SheetConstants constants{
      c.c11,           c.c12, c.c22, c.g, moduli.warp * yield.strain, moduli.weft * yield.strain,
      yield.hardening, 0,     0};
  at_rest_ = std::make_shared<const Energy>(
      triangle_slabs(shell), shell, std::vector(shell.triangles.size(), constants), std::move(pattern));
}

PlasticMembrane::~PlasticMembrane() = default;

std::unique_ptr<Potential> PlasticMembrane::potential(const StepContext& step) const {
  std::vector<SheetConstants> constants = at_rest_->constants();
  if (step.history != nullptr) {
    const std::span<const double> plastic = step.history->find(name_, 2 * constants.size());
    for (std::size_t t = 0; 2 * t < plastic.size(); ++t) {
      constants[t].plastic_warp = plastic[2 * t];
      constants[t].plastic_weft = plastic[2 * t + 1];
    }
  }
  return std::make_unique<Energy>(*at_rest_, std::move(constants));
}

void PlasticMembrane::end_step(const Potential& potential, ConstVectors x, History& history) const {
  const auto& energy = static_cast<const Energy&>(potential);
  const std::vector<SheetConstants>& constants = energy.constants();
  const std::span<double> plastic = history.get(name_, 2 * constants.size());
  for (std::size_t t = 0; t < constants.size(); ++t) {
    const PlasticMembraneLaw::Slip slip = energy.slip(t, x);
    plastic[2 * t] = constants[t].plastic_warp + slip.warp;
    plastic[2 * t + 1] = constants[t].plastic_weft + slip.weft;
  }
}

}  // namespace muslin
