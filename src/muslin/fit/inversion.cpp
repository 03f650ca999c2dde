#include "muslin/fit/inversion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "muslin/energy/sheet_stress.hpp"
#include "muslin/fit/kes.hpp"
#include "muslin/fit/rigidity.hpp"
#include "muslin/fit/rising_curve.hpp"

namespace muslin {
namespace {

// Medians of 618 fabrics on a cantilever tester (docs/materials.md): rigidities at 0.197 kg/m².
constexpr double usual_warp = 13.6e-6, usual_weft = 8.7e-6, usual_density = 0.197;
constexpr double usual_modulus = 2000;  // N/m
constexpr double usual_shear = 56.2;    // N/m, 1 gf/(cm·deg)
constexpr double usual_poisson = 0.25;

const char* word_of(Thread thread) {
  return thread == Thread::warp ? "warp" : thread == Thread::weft ? "weft" : "bias";
}

/// Green's strain and the second Piola-Kirchhoff stress of a strip, and back.
Vec2 stress_point(const Vec2& test) { return {test[0] * (1 + 0.5 * test[0]), test[1] / (1 + test[0])}; }
Vec2 tensile_point_of(const Vec2& stress) {
  const double stretch = std::sqrt(1 + 2 * stress[0]);
  return {stretch - 1, stress[1] * stretch};
}

class Inverter {
 public:
  explicit Inverter(const Measurements& m) : m_(m) {}

  Inversion run() {
    add({"areal_density", m_.areal_density->value, {}, "kg/m²", "measured"});
    const auto warp = tensile(Thread::warp), weft = tensile(Thread::weft);
    add_membrane("membrane_warp", "warp_curve", warp, weft);
    add_membrane("membrane_weft", "weft_curve", weft, warp);
    add_poisson();
    add_shear();
    const auto bends = bending(Thread::warp), bends_weft = bending(Thread::weft);
    add_bending("bending_warp", bends, bends_weft, usual_warp);
    add_bending("bending_weft", bends_weft, bends, usual_weft);
    add_bias();
    add({"stiffness_damping", 0.001, {}, "s", "a usual value", true});
    add({"bending_damping", 0.002, {}, "s", "a usual value", true});
    note_unused();
    return std::move(result_);
  }

 private:
  void add(FittedValue value) { result_.values.push_back(std::move(value)); }

  /// All tests of a direction with those of the KES sheet, in terms of stress: a curve or a straight line.
  std::optional<FittedValue> tensile(Thread direction) const {
    std::vector<Vec2> data;
    std::vector<double> held;  // Green's strain times the share
    int strips = 0;
    const auto take = [&](const TensileTest& test) {
      if (test.direction != direction) return;
      ++strips;
      for (const Vec2& point : test.points) {
        data.push_back(stress_point({point[0], point[1] * test.factor.value}));
        held.push_back(test.held * data.back()[0]);
      }
    };
    for (const TensileTest& test : m_.tensile) take(test);
    std::string from = strips == 1 ? "strip test" : fmt::format("{} strip tests", strips);
    if (const KesSide* side = kes(direction)) {
      if (const auto test = kes_strip(*side, direction)) {
        take(*test);
        from = strips == 1 ? "KES tension" : from + " and KES";
      }
    }
    if (data.empty()) return std::nullopt;
    FittedValue value;
    value.from = from;
    release(data, held);
    fit(value, data, tensile_point_of, "N/m");
    return value;
  }

  /// Takes the stress by which clamps hold the strips across (fit/strip_clamps.hpp) from the data.
  void release(std::vector<Vec2>& data, const std::vector<double>& held) const {
    const double square = std::pow(m_.poisson ? m_.poisson->value : usual_poisson, 2);
    const std::vector<Vec2> measured = data;
    if (std::all_of(held.begin(), held.end(), [](double strain) { return strain == 0; })) return;
    for (int round = 0; round < 4; ++round) {
      const double slope = StressCurve(fit_rising_curve(data).points).slope(0);
      for (std::size_t i = 0; i < data.size(); ++i)
        data[i][1] = std::max(0.0, measured[i][1] - square / (1 - square) * slope * held[i]);
    }
  }

  /// A curve through the data, or a modulus if it is straight: at one point only.
  static void fit(FittedValue& value, const std::vector<Vec2>& data, Vec2 (*as_measured)(const Vec2&),
                  const char* unit) {
    const RisingCurve fitted = fit_rising_curve(data);
    value.residual = fitted.residual < 1e-9 ? 0 : fitted.residual;  // rounding
    value.unit = unit;
    if (fitted.points.size() == 1) {
      value.value = fitted.points[0][1] / fitted.points[0][0];
      return;
    }
    value.curve.emplace();
    for (const Vec2& point : fitted.points) value.curve->push_back(as_measured(point));
  }

  /// The value of the other thread, or else a usual one.
  static FittedValue guess_from(const std::optional<FittedValue>& other, FittedValue usual) {
    FittedValue value = other.value_or(std::move(usual));
    if (other) value.from = "as the other thread";
    value.residual.reset();
    value.guess = true;
    return value;
  }

  void add_membrane(const char* modulus, const char* curve, std::optional<FittedValue> value,
                    const std::optional<FittedValue>& other) {
    if (!value) value = guess_from(other, {modulus, usual_modulus, {}, "N/m", "a usual modulus"});
    value->key = value->curve ? curve : modulus;
    add(*value);
  }

  /// The stress curve of a thread as it will be written, so that a Poisson's ratio that is stable stays so.
  StressCurve stress_curve_of(const char* modulus, const char* curve) const {
    const auto written = [](double x) { return std::stod(written_number(x)); };
    if (const FittedValue* value = find_value(result_, modulus)) return StressCurve(written(value->value));
    std::vector<Vec2> points;
    for (const Vec2& point : *find_value(result_, curve)->curve)
      points.push_back(stress_point({written(point[0]), written(point[1])}));
    return StressCurve(points);
  }

  /// Points of the shear stress over γ from a strip that is pulled along the bias. Its stress is s m⊗m, with
  /// m = (1, 1)/√2 and s = F/λ, so S_uu = S_vv = S_uv = s/2; the threads stretch as these stresses make them,
  /// and γ = 2 E_mm − E_uu − E_vv.
  void add_bias_points(const TensileTest& test, std::vector<Vec2>& data) const {
    StressCurve warp = stress_curve_of("membrane_warp", "warp_curve");
    StressCurve weft = stress_curve_of("membrane_weft", "weft_curve");
    // As energy/measured_membrane couples them.
    const double poisson = find_value(result_, "poisson")->value, rest = 1 - poisson * poisson;
    const double coupling = poisson * std::sqrt(warp.slope(0) * weft.slope(0)) / rest;
    warp = warp.plus(poisson * poisson / rest * warp.slope(0));
    weft = weft.plus(poisson * poisson / rest * weft.slope(0));
    for (const Vec2& point : test.points) {
      const Vec2 stress = stress_point({point[0], point[1] * test.factor.value});
      const double half = stress[1] / 2;
      double along_warp = 0, along_weft = 0;
      for (int i = 0; i < 40; ++i) {
        along_warp = strain_at(warp, half - coupling * along_weft);
        along_weft = strain_at(weft, half - coupling * along_warp);
      }
      const double shear = 2 * stress[0] - along_warp - along_weft;
      if (point[0] > 0 && (shear <= 0 || shear >= 1))
        throw Error(
            ErrorKind::input, test.place,
            fmt::format("at a strain of {:.4g} along the bias the threads alone would give way more, or "
                        "shear beyond a right angle",
                        point[0]),
            "check the tests along warp, weft and bias, and leave out strains where threads lock");
      if (shear > 0) data.emplace_back(shear, half);
    }
  }

  static double strain_at(const StressCurve& curve, double stress) {
    double low = -0.4, high = 4;
    for (int i = 0; i < 60; ++i) {
      const double middle = (low + high) / 2;
      (curve.stress(middle) < stress ? low : high) = middle;
    }
    return low;
  }

  void add_shear() {
    std::vector<Vec2> data;
    int frames = 0, strips = 0;
    std::vector<double> moduli;
    for (const ShearTest& test : m_.shear) {
      if (test.modulus) moduli.push_back(test.modulus->value);
      if (!test.points.empty()) ++frames;
      for (const Vec2& point : test.points) {
        const double angle = point[0] * std::numbers::pi / 180;
        data.emplace_back(std::sin(angle), point[1] * test.factor.value / std::cos(angle));
      }
    }
    for (const TensileTest& test : m_.tensile) {
      if (test.direction != Thread::bias) continue;
      ++strips;
      add_bias_points(test, data);
    }
    for (const Thread thread : {Thread::warp, Thread::weft})
      if (const KesSide* side = kes(thread); side != nullptr && side->shear)
        moduli.push_back(side->shear->value);
    if (!data.empty()) {
      FittedValue value;
      value.from = frames > 0 ? fmt::format("{} shear test{}", frames, frames > 1 ? "s" : "") : "";
      if (strips > 0)
        value.from +=
            fmt::format("{}{} bias strip{}", frames > 0 ? " and " : "", strips, strips > 1 ? "s" : "");
      fit(
          value, data,
          [](const Vec2& stress) {
            const double angle = std::asin(std::min(stress[0], 1.0));
            return Vec2(angle * 180 / std::numbers::pi, stress[1] * std::cos(angle));
          },
          "N/m");
      value.key = value.curve ? "shear_curve" : "membrane_shear";
      add(value);
      if (!moduli.empty())
        result_.notes.emplace_back("the moduli of shear are not used, because there are curves of shear");
    } else if (!moduli.empty()) {
      add({"membrane_shear", mean(moduli), {}, "N/m", "slope of shear"});
    } else {
      add({"membrane_shear", usual_shear, {}, "N/m", "a usual value, 1 gf/(cm·deg)", true});
    }
  }

  void add_poisson() {
    const double highest = highest_poisson({stress_curve_of("membrane_warp", "warp_curve"),
                                            stress_curve_of("membrane_weft", "weft_curve"), StressCurve(1)});
    const double wanted = m_.poisson ? m_.poisson->value : usual_poisson;
    FittedValue value{"poisson", wanted, {}, "", m_.poisson ? "measured" : "a usual value", !m_.poisson};
    if (wanted > highest) {
      value.value = 0.99 * highest;
      value.from += ", lowered to what is stable where the curves soften";
      value.guess = true;
    }
    add(value);
  }

  /// Rigidities or curves of all tests of a direction.
  std::optional<FittedValue> bending(Thread direction) {
    std::vector<Vec2> data;
    std::vector<double> rigidities;
    std::vector<std::string> tests;
    const auto state = [&](const std::string& test) {
      if (std::find(tests.begin(), tests.end(), test) == tests.end()) tests.push_back(test);
    };
    for (const BendingTest& test : m_.bending) {
      if (test.direction != direction) continue;
      for (const Vec2& point : test.points) data.emplace_back(point[0], point[1] * test.factor.value);
      if (!test.points.empty()) state("bending test");
      const auto rigidity = rigidity_by(test, m_.areal_density->value);
      if (!rigidity) continue;
      rigidities.push_back(*rigidity);
      state(test.bending_length ? "cantilever" : test.loop_height ? "hanging loop" : "bending test");
    }
    if (const KesSide* side = kes(direction); side != nullptr && side->bending) {
      rigidities.push_back(side->bending->value);
      state("KES bending");
    }
    if (data.empty() && rigidities.empty()) return std::nullopt;
    FittedValue value;
    for (const std::string& test : tests) value.from += (value.from.empty() ? "" : " and ") + test;
    if (data.empty()) {
      value.value = mean(rigidities);
      value.unit = "N·m";
      return value;
    }
    if (!rigidities.empty())
      result_.notes.push_back(fmt::format(
          "rigidities of {} are not used, because there is a curve of moments", word_of(direction)));
    value.from = "bending test";
    fit(value, data, [](const Vec2& point) { return point; }, "N");
    if (!value.curve) value.unit = "N·m";
    return value;
  }

  void add_bending(const std::string& key, std::optional<FittedValue> value,
                   const std::optional<FittedValue>& other, double usual) {
    if (!value) {
      const double rigidity = usual * m_.areal_density->value / usual_density;
      value =
          guess_from(other, {key, rigidity, {}, "N·m", "the median of 618 fabrics, times the areal density"});
    }
    value->key = value->curve ? key + "_curve" : key;
    add(*value);
  }

  /// The slope at rest of the moment of a thread.
  double rigidity_of(const std::string& key) const {
    if (const FittedValue* value = find_value(result_, key)) return value->value;
    const std::vector<Vec2>& points = *find_value(result_, key + "_curve")->curve;
    return StressCurve(points).slope(0);
  }

  /// Along the bias, at least what resists twisting; unless measured, the material's table completes it.
  void add_bias() {
    const auto measured_bias = bending(Thread::bias);
    if (!measured_bias) return;
    FittedValue value = *measured_bias;
    value.key = "bending_bias";
    const double warp = rigidity_of("bending_warp"), weft = rigidity_of("bending_weft");
    const double poisson = find_value(result_, "poisson")->value;
    const double lowest = (warp + weft + 2 * poisson * std::sqrt(warp * weft)) / 4;
    if (value.value < lowest) {
      result_.notes.push_back(
          fmt::format("bending_bias was measured as {:.3g} N·m and raised to the least with which the sheet "
                      "resists twisting",
                      value.value));
      value.value = 1.01 * lowest;
      value.from += ", raised to what resists twisting";
      value.guess = true;
    }
    add(value);
  }

  void note_unused() {
    if (!m_.kes) return;
    for (const Thread thread : {Thread::warp, Thread::weft}) {
      const KesSide* side = kes(thread);
      if (side == nullptr) continue;
      if (side->shear_hysteresis || side->shear_hysteresis_5 || side->bending_hysteresis ||
          side->resilience) {
        result_.notes.emplace_back("hysteresis (RT, 2HG, 2HG5, 2HB) is kept in [reference] and not used");
        return;
      }
    }
  }

  const KesSide* kes(Thread direction) const {
    if (!m_.kes || direction == Thread::bias) return nullptr;
    const std::optional<KesSide>& side = direction == Thread::warp ? m_.kes->warp : m_.kes->weft;
    return side ? &*side : nullptr;
  }

  static double mean(const std::vector<double>& numbers) {
    double sum = 0;
    for (const double x : numbers) sum += x;
    return sum / static_cast<double>(numbers.size());
  }

  const Measurements& m_;
  Inversion result_;
};

}  // namespace

std::string written_number(double value) { return fmt::format("{:.6g}", value); }

const FittedValue* find_value(const Inversion& inversion, const std::string& key) {
  const auto at = std::find_if(inversion.values.begin(), inversion.values.end(),
                               [&](const FittedValue& value) { return value.key == key; });
  return at == inversion.values.end() ? nullptr : &*at;
}

Inversion invert(const Measurements& measurements) { return Inverter(measurements).run(); }

}  // namespace muslin
