#include "muslin/energy/bending_friction.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/energy/element_energy.hpp"
#include "muslin/energy/hinge_coupling.hpp"

namespace muslin {
namespace {

constexpr std::size_t friction_block = 1024;
// A slider that has just slipped counts as sticking until it slips further, whatever its rounding.
constexpr double slipping = 1 + 1e-9;

/// The response of a spring and its slider to the extension e = κ − κ_s of both.
struct Slider {
  double limit, reach;  // M₀, κ₀

  double slip(double e) const { return std::max(0.0, std::abs(e) - reach); }
  double lost(double e) const { return limit * slip(e); }
  double stored(double e) const {
    const double stretched = std::abs(e) - slip(e);
    return 0.5 * limit / reach * stretched * stretched;
  }
  double moment(double e) const { return limit / reach * std::clamp(e, -reach, reach); }
  double stiffness(double e) const { return std::abs(e) <= slipping * reach ? limit / reach : 0; }
};

}  // namespace

struct BendingFriction::Sheet {
  std::shared_ptr<const HingeAngles> angles;
  PlateCurvatures curvatures;
  std::vector<double> areas;
  Slider warp, weft;
};

/// The energy of one step.
class BendingFriction::Energy : public ElementEnergy {
 public:
  Energy(std::shared_ptr<const Sheet> sheet, std::vector<Vec2> slid)
      : ElementEnergy(sheet->angles->pattern()), sheet_(std::move(sheet)), slid_(std::move(slid)) {}

  double value(ConstVectors x) const override { return value_at(extensions(x)); }
  void add_gradient(ConstVectors x, Vectors g) const override {
    sheet_->angles->add_forces(x, moments(extensions(x)), g);
  }
  double add_gradient_and_value(ConstVectors x, Vectors g) const override {
    const std::vector<Vec2> e = extensions(x);
    sheet_->angles->add_forces(x, moments(e), g);
    return value_at(e);
  }

  void add_stiffness_product(Stiffness kind, ConstVectors x, ConstVectors p, Vectors y) const override {
    const HingeAngles& angles = *sheet_->angles;
    const std::vector<Vec2> e = extensions(x);
    std::vector<Vec2> changes = sheet_->curvatures.of_all(angles.changes(x, p));
    const std::vector<Vec2> stiffness = stiffnesses(e);
    for (std::size_t t = 0; t < changes.size(); ++t) changes[t] = changes[t].cwiseProduct(stiffness[t]);
    if (kind == Stiffness::exact) {
      angles.add_force_changes(x, sheet_->curvatures.transposed(changes), moments(e), p, y);
    } else {
      angles.add_forces(x, sheet_->curvatures.transposed(changes), y);
    }
  }
  void add_stiffness_blocks(Stiffness, ConstVectors x, std::span<Mat3> blocks) const override {
    sheet_->angles->add_blocks(x, lumped(x), blocks);
  }
  void add_stiffness_matrix(Stiffness, ConstVectors x, double scale, std::span<const double>,
                            PairBlocks blocks) const override {
    sheet_->angles->assemble(x, lumped(x), scale, blocks, nullptr);
  }

  double dissipated(ConstVectors x) const override {
    return sum(extensions(x), [](const Slider& slider, double e) { return slider.lost(e); });
  }
  /// Writes κ_s after a step that ends at x: two numbers per triangle.
  void write_slid(ConstVectors x, std::span<double> numbers) const {
    const std::vector<Vec2> e = extensions(x);
    for (std::size_t t = 0; t < e.size(); ++t) {
      numbers[2 * t] = slid_[t][0] + std::copysign(sheet_->warp.slip(e[t][0]), e[t][0]);
      numbers[2 * t + 1] = slid_[t][1] + std::copysign(sheet_->weft.slip(e[t][1]), e[t][1]);
    }
  }

 private:
  /// κ − κ_s of every triangle.
  std::vector<Vec2> extensions(ConstVectors x) const {
    std::vector<Vec2> result = sheet_->curvatures.of_all(sheet_->angles->deviations(x));
    for (std::size_t t = 0; t < result.size(); ++t) result[t] -= slid_[t];
    return result;
  }

  /// Returns ∫ f dA, f of both sliders.
  template <class Function>
  double sum(const std::vector<Vec2>& e, const Function& f) const {
    return parallel_sum(e.size(), friction_block, 0.0, [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t t = begin; t < end; ++t)
        sum += sheet_->areas[t] * (f(sheet_->warp, e[t][0]) + f(sheet_->weft, e[t][1]));
      return sum;
    });
  }
  double value_at(const std::vector<Vec2>& e) const {
    return sum(e, [](const Slider& slider, double x) { return slider.stored(x) + slider.lost(x); });
  }

  /// Returns area times f of every triangle.
  template <class Function>
  std::vector<Vec2> by_triangle(const std::vector<Vec2>& e, const Function& f) const {
    std::vector<Vec2> result(e.size());
    parallel_for(e.size(), friction_block, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t)
        result[t] = sheet_->areas[t] * Vec2(f(sheet_->warp, e[t][0]), f(sheet_->weft, e[t][1]));
    });
    return result;
  }
  std::vector<Vec2> stiffnesses(const std::vector<Vec2>& e) const {
    return by_triangle(e, [](const Slider& slider, double x) { return slider.stiffness(x); });
  }
  std::vector<double> lumped(ConstVectors x) const {
    return sheet_->curvatures.lumped(stiffnesses(extensions(x)));
  }

  std::vector<double> moments(const std::vector<Vec2>& e) const {
    return sheet_->curvatures.transposed(
        by_triangle(e, [](const Slider& slider, double x) { return slider.moment(x); }));
  }

  std::shared_ptr<const Sheet> sheet_;
  std::vector<Vec2> slid_;
};

BendingFriction::BendingFriction(const std::string& name, const Shell& shell,
                                 std::shared_ptr<const HingeAngles> angles,
                                 const BendingFrictionLimits& limits, std::span<const std::uint8_t> held)
    : name_(name + ".slid_curvature") {
  require(limits.warp >= 0 && limits.weft >= 0, "a moment of internal friction is negative",
          "give 0 or more");
  require(limits.curvature > 0, "the curvature over which internal friction builds up is not positive",
          "give more than 0");
  // Constant curvatures are exact with any moduli.
  const BendingModuli even{1, 1, 1, 0};
  sheet_ = std::make_shared<const Sheet>(Sheet{std::move(angles), plate_curvatures(shell, even, held),
                                               shell.areas, Slider{limits.warp, limits.curvature},
                                               Slider{limits.weft, limits.curvature}});
}

std::unique_ptr<Potential> BendingFriction::potential(const StepContext& step) const {
  const std::size_t count = sheet_->areas.size();
  const std::span<const double> numbers =
      step.history != nullptr ? step.history->find(name_, 2 * count) : std::span<const double>();
  std::vector<Vec2> slid;
  if (numbers.empty()) {
    slid = sheet_->curvatures.of_all(sheet_->angles->deviations(step.positions));
  } else {
    slid.resize(count);
    for (std::size_t t = 0; t < count; ++t) slid[t] = Vec2(numbers[2 * t], numbers[2 * t + 1]);
  }
  return std::make_unique<Energy>(sheet_, std::move(slid));
}

void BendingFriction::end_step(const Potential& potential, ConstVectors x, History& history) const {
  static_cast<const Energy&>(potential).write_slid(x, history.get(name_, 2 * sheet_->areas.size()));
}

}  // namespace muslin
