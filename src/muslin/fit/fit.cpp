#include "muslin/fit/fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "muslin/fit/contradictions.hpp"
#include "muslin/fit/material_file.hpp"
#include "muslin/fit/specimens.hpp"
#include "muslin/fit/strip_clamps.hpp"

namespace muslin {
namespace {

const double step = std::log(4);        // of the search at first, in the logarithm of bending
constexpr double close_enough = 0.003;  // of the drape coefficient
// Bending lengths between which a drape is searched [m]; the edge of a Cusick disc overhangs 60 mm.
constexpr double shortest = 0.004, longest = 0.12;

bool is_bending(const FittedValue& value) {
  return value.key.starts_with("bending_") && value.key != "bending_damping";
}

/// Sums the squares of what the shift of every measured number by its uncertainty changes: of a curve, its
/// forces at the same strains.
void propagate(const Measurements& measurements, std::vector<FittedValue>& values) {
  std::vector<double> squares(values.size(), 0);
  std::vector<bool> known(values.size(), false);
  int count = 0;
  Measurements m = measurements;
  for_each_measured(m, [&](Measured&) { ++count; });
  for (int i = 0; i < count; ++i) {
    Measurements shifted = measurements;
    int index = 0;
    bool has = false;
    for_each_measured(shifted, [&](Measured& number) {
      if (index++ != i || !number.plus_minus) return;
      number.value += *number.plus_minus;
      has = true;
    });
    if (!has) continue;
    const Inversion inversion = invert(shifted);
    for (std::size_t v = 0; v < values.size(); ++v) {
      const FittedValue* other = find_value(inversion, values[v].key);
      if (other == nullptr) continue;
      const double change =
          values[v].curve ? relative_change(*values[v].curve, *other->curve) : other->value - values[v].value;
      if (change == 0) continue;
      squares[v] += change * change;
      known[v] = true;
    }
  }
  for (std::size_t v = 0; v < values.size(); ++v) {
    FittedValue& value = values[v];
    if (value.guess || !known[v]) continue;
    value.plus_minus = std::sqrt(squares[v]);
  }
}

Material material_with(const Fit& fit, const std::vector<FittedValue>& values) {
  return parse_material(material_text({"drape", "", "", values, {}, {}, {}}), fit.material.name);
}

/// Bending, scaled by a factor, that drapes as measured.
class DrapeFit {
 public:
  DrapeFit(Fit& fit, const DrapeTest& test, const DrapeOptions& options, const Progress& progress)
      : fit_(fit), test_(test), options_(options), progress_(progress) {}

  void run() {
    const double target = test_.coefficient->value;
    const FittedValue& warp = *std::find_if(fit_.values.begin(), fit_.values.end(), is_bending);
    const double weight = fit_.values.front().value * 9.80665;
    const double least = std::log(weight * std::pow(shortest, 3) / warp.value);
    const double most = std::log(weight * std::pow(longest, 3) / warp.value);
    // Brackets the target from the usual rigidity on by factors of 4, then cuts the bracket by the straight
    // line through its ends, but by at least a fifth.
    Try low = at(0), high = low;
    while (low.coefficient > target && low.logarithm > least) {
      high = low;
      low = at(std::max(least, low.logarithm - step));
    }
    while (high.coefficient < target && high.logarithm < most) {
      low = high;
      high = at(std::min(most, high.logarithm + step));
    }
    if (low.coefficient > target || high.coefficient < target) refuse();
    Try best = std::abs(low.coefficient - target) < std::abs(high.coefficient - target) ? low : high;
    while (tries_ < options_.most && std::abs(best.coefficient - target) > close_enough) {
      const double share =
          std::clamp((target - low.coefficient) / (high.coefficient - low.coefficient), 0.2, 0.8);
      const Try next = at(low.logarithm + share * (high.logarithm - low.logarithm));
      if (std::abs(next.coefficient - target) < std::abs(best.coefficient - target)) best = next;
      (next.coefficient < target ? low : high) = next;
    }
    take(best);
  }

 private:
  struct Try {
    double logarithm = 0, coefficient = 0;
  };

  std::vector<FittedValue> scaled(double logarithm) const {
    std::vector<FittedValue> values = fit_.values;
    for (FittedValue& value : values)
      if (is_bending(value)) value.value *= std::exp(logarithm);
    return values;
  }

  Try at(double logarithm) {
    Progress part;
    part.cancelled = progress_.cancelled;
    if (progress_.report)
      part.report = [this](double fraction, std::string_view) {
        progress_.report((tries_ + fraction) / options_.most, "drape");
      };
    const double coefficient =
        drape_coefficient(material_with(fit_, scaled(logarithm)), test_, options_, part);
    ++tries_;
    reached_.push_back({logarithm, coefficient});
    return reached_.back();
  }

  [[noreturn]] void refuse() const {
    const auto [least, most] =
        std::minmax_element(reached_.begin(), reached_.end(),
                            [](const Try& a, const Try& b) { return a.coefficient < b.coefficient; });
    throw Error(
        ErrorKind::input, test_.place,
        fmt::format("no bending gives a drape coefficient of {:.3g} %: bending lengths from {:.3g} to {:.3g} "
                    "mm give {:.3g} to {:.3g} %",
                    100 * test_.coefficient->value, 1e3 * shortest, 1e3 * longest, 100 * least->coefficient,
                    100 * most->coefficient),
        "check the coefficient, the diameters and the areal density");
  }

  /// A straight line of the coefficient over the logarithm through the tries around this one, and their
  /// deviation from it: folds that come and go make the coefficient uneven in small.
  struct Line {
    double slope = 0, deviation = 0;
  };
  Line line_at(const Try& middle) const {
    std::vector<Try> near;
    for (const Try& t : reached_)
      if (std::abs(t.logarithm - middle.logarithm) <= step)
        near.push_back({t.logarithm - middle.logarithm, t.coefficient - middle.coefficient});
    double x = 0, y = 0, xx = 0, xy = 0, yy = 0;
    const double n = static_cast<double>(near.size());
    for (const Try& t : near) {
      x += t.logarithm / n, y += t.coefficient / n;
      xx += t.logarithm * t.logarithm / n, xy += t.logarithm * t.coefficient / n;
      yy += t.coefficient * t.coefficient / n;
    }
    if (!(xx - x * x > 0)) return {};
    const double slope = (xy - x * y) / (xx - x * x);
    const double left = std::max(0.0, yy - y * y - slope * (xy - x * y));
    return {slope, n > 2 ? std::sqrt(left * n / (n - 2)) : 0};
  }

  void take(const Try& best) {
    const Line line = line_at(best);
    // The drape depends on rigidity over weight, so that an error of the areal density carries over.
    const FittedValue& density = fit_.values.front();
    std::optional<double> share;
    if (test_.coefficient->plus_minus && line.slope > 0) {
      const double by_drape = std::hypot(*test_.coefficient->plus_minus, line.deviation) / line.slope;
      const double by_weight = density.plus_minus.value_or(0) / density.value;
      share = std::hypot(by_drape, by_weight);
    }
    fit_.values = scaled(best.logarithm);
    for (FittedValue& value : fit_.values) {
      if (!is_bending(value)) continue;
      value.from = value.key == "bending_weft" ? "drape, with the ratio of weft to warp of the median fabric"
                                               : "drape";
      value.guess = value.key == "bending_weft";
      if (share) value.plus_minus = *share * value.value;
    }
    fit_.simulated_drape = best.coefficient;
  }

  Fit& fit_;
  const DrapeTest& test_;
  const DrapeOptions& options_;
  const Progress& progress_;
  int tries_ = 0;
  std::vector<Try> reached_;
};

void finish(Fit& fit, const Measurements& m) {
  MaterialFile file{
      m.name, m.description, m.source, fit.values, {}, fit.warnings, m.file.filename().string()};
  const auto reference = [&](const std::string& key, const std::optional<Measured>& x) {
    if (x) file.reference.emplace_back(key, x->value);
  };
  reference("thickness", m.thickness);
  reference("drape_coefficient", fit.measured_drape);
  if (fit.simulated_drape) file.reference.emplace_back("drape_coefficient_simulated", *fit.simulated_drape);
  if (m.kes) {
    for (const auto& [side, name] : {std::pair{&m.kes->warp, "_warp"}, std::pair{&m.kes->weft, "_weft"}}) {
      if (!*side) continue;
      reference(fmt::format("tensile_resilience{}", name), (*side)->resilience);
      reference(fmt::format("shear_hysteresis{}", name), (*side)->shear_hysteresis);
      reference(fmt::format("shear_hysteresis_5{}", name), (*side)->shear_hysteresis_5);
      reference(fmt::format("bending_hysteresis{}", name), (*side)->bending_hysteresis);
    }
  }
  fit.text = material_text(file);
  fit.material = parse_material(fit.text, m.name + ".toml");
}

}  // namespace

Fit fit_fabric(const Measurements& measurements, const DrapeOptions& options, const Progress& progress) {
  Measurements m = measurements;
  std::vector<std::string> warnings = contradictions(m);
  estimate_scatter(m);
  hold_strips(m, invert(m));
  Inversion inversion = invert(m);
  Fit fit{std::move(inversion.values), std::move(inversion.notes), std::move(warnings), {}, {}, {}, {}};
  propagate(m, fit.values);
  fit.material.name = m.name;
  if (m.drape) {
    fit.measured_drape = m.drape->coefficient;
    const bool bending_is_measured =
        std::any_of(fit.values.begin(), fit.values.end(),
                    [](const FittedValue& value) { return is_bending(value) && !value.guess; });
    if (bending_is_measured) {
      fit.simulated_drape = drape_coefficient(material_with(fit, fit.values), *m.drape, options, progress);
    } else {
      DrapeFit(fit, *m.drape, options, progress).run();
    }
  }
  finish(fit, m);
  return fit;
}

std::string fit_table(const Fit& fit) {
  std::string text =
      fmt::format("{:<20} {:>12} {:<6} {:>10} {:>9}  {}\n", "key", "value", "unit", "+-", "residual", "from");
  const auto plain_unit = [](const std::string& unit) {
    return unit == "N·m" ? "N m" : unit == "kg/m²" ? "kg/m2" : unit;
  };
  for (const FittedValue& v : fit.values) {
    const std::string value =
        v.curve ? fmt::format("{} points", v.curve->size()) : fmt::format("{:.4g}", v.value);
    std::string uncertainty = "-";
    if (v.plus_minus)
      uncertainty =
          v.curve ? fmt::format("{:.2g} %", 100 * *v.plus_minus) : fmt::format("{:.2g}", *v.plus_minus);
    const std::string residual = v.residual ? fmt::format("{:.2g} %", 100 * *v.residual) : "-";
    text += fmt::format("{:<20} {:>12} {:<6} {:>10} {:>9}  {}{}\n", v.key, value, plain_unit(v.unit),
                        uncertainty, residual, v.guess ? "guess: " : "", v.from);
  }
  if (fit.measured_drape)
    text += fmt::format("drape coefficient: {:.1f} % measured, {:.1f} % simulated\n",
                        100 * fit.measured_drape->value, 100 * *fit.simulated_drape);
  for (const std::string& note : fit.notes) text += fmt::format("note: {}\n", note);
  return text;
}

}  // namespace muslin
