#include "muslin/energy/plastic_bending.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/energy/element_energy.hpp"
#include "muslin/energy/hinge_coupling.hpp"

namespace muslin {
namespace {

constexpr std::size_t plastic_block = 1024;
// A triangle that has just slipped counts as elastic until it slips further, whatever its rounding.
constexpr double yielding = 1 + 1e-9;

/// The response of a triangle to its curvature y and elastic curvature e = y − y_p.
struct YieldingPlate {
  double radius, hardening;  // r, h

  /// The share of e that slips.
  double slip(const Vec3& e) const {
    const double length = e.norm();
    return length > radius ? 1 - radius / length : 0;
  }
  double lost(const Vec3& e) const { return (1 - hardening) * radius * slip(e) * e.norm(); }
  double stored(const Vec3& y, const Vec3& e) const {
    return 0.5 * hardening * y.squaredNorm() + 0.5 * (1 - hardening) * ((1 - slip(e)) * e).squaredNorm();
  }
  Vec3 moment(const Vec3& y, const Vec3& e) const {
    return hardening * y + (1 - hardening) * (1 - slip(e)) * e;
  }
  bool yields(const Vec3& e) const { return e.norm() > yielding * radius; }
  /// P, PᵀP the stiffness.
  Mat3 root(const Vec3& e) const {
    if (!yields(e)) return Mat3::Identity();
    const Mat3 along = e * e.transpose() / e.squaredNorm();
    const double across = hardening + (1 - hardening) * (1 - slip(e));
    return std::sqrt(hardening) * along + std::sqrt(across) * (Mat3::Identity() - along);
  }
};

/// The pattern of the coupling between all hinges that a triangle's curvatures depend on, without values.
FormCoupling pattern_of(const Shell& shell, const CurvatureRows<Vec3>& rows) {
  FormCoupling forms;
  forms.vertices = hinge_vertices(shell);
  forms.first.push_back(0);
  for (std::size_t h = 0; h < rows.hinge_count; ++h) {
    const auto begin = static_cast<std::ptrdiff_t>(forms.columns.size());
    for (int u = rows.first_use[h]; u < rows.first_use[h + 1]; ++u) {
      const std::size_t t = at(rows.uses[at(u)].triangle);
      for (int k = rows.first[t]; k < rows.first[t + 1]; ++k) forms.columns.push_back(rows.hinges[at(k)]);
    }
    std::sort(forms.columns.begin() + begin, forms.columns.end());
    forms.columns.erase(std::unique(forms.columns.begin() + begin, forms.columns.end()), forms.columns.end());
    forms.first.push_back(static_cast<int>(forms.columns.size()));
  }
  forms.values.resize(forms.columns.size());
  forms.find_shares(shell.vertex_count());
  return forms;
}

}  // namespace

struct PlasticBending::Sheet {
  EvenCurvatures curvatures;
  std::vector<double> areas;
  YieldingPlate plate;
  double recovery;
  std::shared_ptr<const ShellBending> elastic;
  FormCoupling forms;  // with a pattern

  /// Returns the coupling of the stiffness PᵀP but for the diagonal matrix `lumped`.
  std::shared_ptr<const FormCoupling> coupled(std::span<const Mat3> roots,
                                              std::span<const double> lumped) const {
    const CurvatureRows<Vec3>& rows = curvatures.rows;
    auto result = std::make_shared<FormCoupling>(forms);
    parallel_for(rows.hinge_count, plastic_block, [&](std::size_t begin, std::size_t end) {
      std::vector<double> sums;
      for (std::size_t h = begin; h < end; ++h) {
        const auto first = static_cast<std::size_t>(forms.first[h]);
        const auto row = std::span(forms.columns).subspan(first, at(forms.first[h + 1]) - first);
        const auto place = [&](int hinge) {
          return static_cast<std::size_t>(std::lower_bound(row.begin(), row.end(), hinge) - row.begin());
        };
        sums.assign(row.size(), 0.0);
        for (int u = rows.first_use[h]; u < rows.first_use[h + 1]; ++u) {
          const auto& use = rows.uses[at(u)];
          const std::size_t t = at(use.triangle);
          const Vec3 moment = roots[t] * (roots[t] * rows.weights[at(use.entry)]);
          for (int k = rows.first[t]; k < rows.first[t + 1]; ++k)
            sums[place(rows.hinges[at(k)])] += moment.dot(rows.weights[at(k)]);
        }
        if (!row.empty()) sums[place(static_cast<int>(h))] -= lumped[h];
        for (std::size_t k = 0; k < row.size(); ++k) result->values[first + k] = static_cast<float>(sums[k]);
      }
    });
    return result;
  }
};

/// The energy of one step.
class PlasticBending::Energy : public ElementEnergy {
 public:
  Energy(std::shared_ptr<const Sheet> sheet, std::vector<Vec3> set, double length)
      : ElementEnergy(sheet->elastic->pattern()),
        sheet_(std::move(sheet)),
        set_(std::move(set)),
        kept_(std::exp(-length / sheet_->recovery)) {}

  double value(ConstVectors x) const override { return value_at(bent(x)); }
  void add_gradient(ConstVectors x, Vectors g) const override { angles().add_forces(x, moments(bent(x)), g); }
  double add_gradient_and_value(ConstVectors x, Vectors g) const override {
    const std::vector<Vec3> y = bent(x);
    angles().add_forces(x, moments(y), g);
    return value_at(y);
  }

  void add_stiffness_product(Stiffness kind, ConstVectors x, ConstVectors p, Vectors y) const override {
    const std::vector<Vec3> bent_to = bent(x);
    const std::vector<Mat3> roots = roots_of(bent_to);
    std::vector<Vec3> changes = rows().of_all(angles().changes(x, p));
    for (std::size_t t = 0; t < changes.size(); ++t) changes[t] = roots[t] * (roots[t] * changes[t]);
    if (kind == Stiffness::exact) {
      angles().add_force_changes(x, rows().transposed(changes), moments(bent_to), p, y);
    } else {
      angles().add_forces(x, rows().transposed(changes), y);
    }
  }
  void add_stiffness_blocks(Stiffness, ConstVectors x, std::span<Mat3> blocks) const override {
    angles().add_blocks(x, rows().lumped_by(roots_at(x)), blocks);
  }
  void add_stiffness_matrix(Stiffness, ConstVectors x, double scale, std::span<const double>,
                            PairBlocks blocks) const override {
    angles().assemble(x, rows().lumped_by(roots_at(x)), scale, blocks, nullptr);
  }
  void linearize_stiffness(Stiffness kind, ConstVectors x, double factor, HessianSink& into,
                           std::size_t first) const override {
    const std::vector<Vec3> y = bent(x);
    const auto yields = [&](std::size_t t) { return sheet_->plate.yields(y[t] - set_[t]); };
    bool any = false;
    for (std::size_t t = 0; t < y.size() && !any; ++t) any = yields(t);
    if (!any) return sheet_->elastic->linearize_stiffness(kind, x, factor, into, first);
    const double scale = into.scale() * factor;
    const std::vector<Mat3> roots = roots_of(y);
    const std::vector<double> lumped = rows().lumped_by(roots);
    const bool whole = sheet_->elastic->is_stiff(scale, into.masses().subspan(first, x.size()),
                                                 into.fixed().subspan(first, x.size()));
    angles().assemble(x, lumped, scale, into.pair_blocks(pattern(), first),
                      whole ? into.coupled_forms(sheet_->coupled(roots, lumped), first, scale) : nullptr);
  }

  double dissipated(ConstVectors x) const override {
    return integral(bent(x), [this](const Vec3&, const Vec3& e) { return sheet_->plate.lost(e); });
  }
  /// Writes κ_p after a step that ends at x.
  void write_set(ConstVectors x, std::span<double> numbers) const {
    const std::vector<Vec3> y = bent(x);
    const Mat3 from_even = sheet_->curvatures.root.inverse();
    for (std::size_t t = 0; t < y.size(); ++t) {
      const Vec3 e = y[t] - set_[t];
      Eigen::Map<Vec3>(numbers.data() + 3 * t) = kept_ * (from_even * (set_[t] + sheet_->plate.slip(e) * e));
    }
  }

 private:
  const CurvatureRows<Vec3>& rows() const { return sheet_->curvatures.rows; }
  const HingeAngles& angles() const { return *sheet_->elastic->angles(); }
  /// y of every triangle.
  std::vector<Vec3> bent(ConstVectors x) const { return rows().of_all(angles().deviations(x)); }

  /// Returns ∫ f dA, f by y and e.
  template <class Function>
  double integral(const std::vector<Vec3>& y, const Function& f) const {
    return parallel_sum(y.size(), plastic_block, 0.0, [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t t = begin; t < end; ++t) sum += sheet_->areas[t] * f(y[t], Vec3(y[t] - set_[t]));
      return sum;
    });
  }
  double value_at(const std::vector<Vec3>& y) const {
    const YieldingPlate& plate = sheet_->plate;
    return integral(y, [&](const Vec3& of, const Vec3& e) { return plate.stored(of, e) + plate.lost(e); });
  }
  std::vector<double> moments(const std::vector<Vec3>& y) const {
    std::vector<Vec3> result(y.size());
    parallel_for(y.size(), plastic_block, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t)
        result[t] = sheet_->areas[t] * sheet_->plate.moment(y[t], y[t] - set_[t]);
    });
    return rows().transposed(result);
  }
  /// Returns P of every triangle, times the root of its area.
  std::vector<Mat3> roots_of(const std::vector<Vec3>& y) const {
    std::vector<Mat3> result(y.size());
    parallel_for(y.size(), plastic_block, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t)
        result[t] = std::sqrt(sheet_->areas[t]) * sheet_->plate.root(y[t] - set_[t]);
    });
    return result;
  }
  std::vector<Mat3> roots_at(ConstVectors x) const { return roots_of(bent(x)); }

  std::shared_ptr<const Sheet> sheet_;
  std::vector<Vec3> set_;  // y_p
  double kept_;            // the share of a set that recovery leaves at the end of the step
};

PlasticBending::PlasticBending(const std::string& name, const Shell& shell, const BendingModuli& moduli,
                               const BendingYield& yield, std::shared_ptr<const ShellBending> elastic,
                               std::span<const std::uint8_t> held)
    : name_(name + ".plastic_curvature") {
  require(yield.curvature > 0, "a yield curvature is not positive", "give more than 0");
  require(yield.hardening >= 0 && yield.hardening <= 1, "the hardening of a sheet is not between 0 and 1",
          "give 0 to 1");
  require(yield.recovery > 0, "the time in which creases fade is not positive", "give more than 0");
  EvenCurvatures curvatures = even_curvatures(shell, moduli, held);
  const YieldingPlate plate{yield.curvature * curvatures.root.col(0).norm(), yield.hardening};
  FormCoupling forms = elastic->pattern() ? pattern_of(shell, curvatures.rows) : FormCoupling();
  sheet_ = std::make_shared<const Sheet>(
      Sheet{std::move(curvatures), shell.areas, plate, yield.recovery, std::move(elastic), std::move(forms)});
}

std::unique_ptr<Potential> PlasticBending::potential(const StepContext& step) const {
  const std::size_t count = sheet_->areas.size();
  std::vector<Vec3> set(count, Vec3::Zero());
  if (step.history != nullptr) {
    const std::span<const double> numbers = step.history->find(name_, 3 * count);
    for (std::size_t t = 0; 3 * t < numbers.size(); ++t)
      set[t] = sheet_->curvatures.root * Eigen::Map<const Vec3>(numbers.data() + 3 * t);
  }
  return std::make_unique<Energy>(sheet_, std::move(set), step.length);
}

void PlasticBending::end_step(const Potential& potential, ConstVectors x, History& history) const {
  static_cast<const Energy&>(potential).write_set(x, history.get(name_, 3 * sheet_->areas.size()));
}

}  // namespace muslin
