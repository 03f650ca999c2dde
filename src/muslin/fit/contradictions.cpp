#include "muslin/fit/contradictions.hpp"

#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "muslin/fit/kes.hpp"
#include "muslin/fit/rigidity.hpp"
#include "muslin/fit/specimens.hpp"

namespace muslin {
namespace {

constexpr double assumed = 0.1;  // share, of an uncertainty that is not stated

/// A value of a quantity by one measurement.
struct Claim {
  std::string by;
  double value = 0;
  std::optional<double> share;  ///< its standard uncertainty over the value

  double uncertainty() const { return share.value_or(assumed) * std::abs(value); }
};

std::optional<double> share_of(const Measured& number) {
  if (!number.plus_minus) return std::nullopt;
  return *number.plus_minus / std::abs(number.value);
}

/// The value of χ² with this many degrees of freedom that chance exceeds once in 740 cases, three standard
/// deviations of a normal distribution (Wilson, Hilferty, The distribution of chi-square, 1931).
double highest_chi_squared(std::size_t freedom) {
  const double part = 2 / (9 * static_cast<double>(freedom));
  return static_cast<double>(freedom) * std::pow(1 - part + 3 * std::sqrt(part), 3);
}

/// Appends a warning if the claims contradict each other.
void compare(const std::string& quantity, const std::string& unit, const std::vector<Claim>& claims,
             std::vector<std::string>& warnings) {
  if (claims.size() < 2) return;
  double weight = 0, mean = 0, chi_squared = 0;
  for (const Claim& c : claims) {
    const double w = 1 / (c.uncertainty() * c.uncertainty());
    weight += w;
    mean += w * c.value;
  }
  mean /= weight;
  for (const Claim& c : claims) chi_squared += std::pow((c.value - mean) / c.uncertainty(), 2);
  const double highest = highest_chi_squared(claims.size() - 1);
  if (chi_squared <= highest) return;
  const Claim *a = nullptr, *b = nullptr;
  double most = 0;
  for (std::size_t i = 0; i < claims.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double apart = std::abs(claims[i].value - claims[j].value) /
                           std::hypot(claims[i].uncertainty(), claims[j].uncertainty());
      if (apart <= most) continue;
      most = apart;
      a = &claims[j], b = &claims[i];
    }
  const auto stated = [&](const Claim& c) {
    return fmt::format("{:.4g}{}{} ± {:.2g} %{} by {}", c.value, unit.empty() ? "" : " ", unit,
                       100 * c.share.value_or(assumed), c.share ? "" : " (assumed)", c.by);
  };
  warnings.push_back(
      fmt::format("measurements contradict each other: {} is {}, but {}; χ² is {:.3g}, and chance leaves it "
                  "below {:.3g}; leave out the one that is wrong, or state how uncertain they are",
                  quantity, stated(*a), stated(*b), chi_squared, highest));
}

std::string named(const char* table, std::size_t index, const std::string& name, const Place& place) {
  std::string text = fmt::format("{} {}", table, index);
  if (!name.empty()) text += fmt::format(" \"{}\"", name);
  if (!place.file.empty()) text += fmt::format(" ({}:{})", place.file, place.line);
  return text;
}

class Comparer {
 public:
  explicit Comparer(const Measurements& m) : m_(m) {}

  std::vector<std::string> run() {
    if (m_.kes) {
      beside("areal_density", "kg/m²", m_.areal_density, "W", m_.kes->weight);
      beside("thickness", "m", m_.thickness, "T", m_.kes->thickness);
    }
    for (const auto& [thread, word] :
         {std::pair{Thread::warp, "warp"}, {Thread::weft, "weft"}, {Thread::bias, "bias"}}) {
      compare_strips(thread, word);
      compare_bending(thread, word);
    }
    compare_shear();
    return std::move(warnings_);
  }

 private:
  void beside(const char* key, const char* unit, const std::optional<Measured>& number, const char* of_kes,
              const std::optional<Measured>& in_kes) {
    if (!number || !in_kes) return;
    compare(key, unit,
            {{fmt::format("`{}`", key), number->value, share_of(*number)},
             {fmt::format("`{}` of [kes]", of_kes), in_kes->value, share_of(*in_kes)}},
            warnings_);
  }

  const KesSide* kes(Thread thread) const {
    if (!m_.kes || thread == Thread::bias) return nullptr;
    const std::optional<KesSide>& side = thread == Thread::warp ? m_.kes->warp : m_.kes->weft;
    return side ? &*side : nullptr;
  }

  static std::string of_kes(const char* keys, const char* word) {
    return fmt::format("{} of `{}` of [kes]", keys, word);
  }

  /// Curves against the one through all of them.
  struct Curves {
    std::vector<std::vector<Vec2>> points;
    std::vector<Claim> claims;

    void add(std::string by, const std::vector<Vec2>& curve, std::optional<double> share) {
      points.push_back(curve);
      claims.push_back({std::move(by), 1, share});
    }
  };

  void compare_curves(const std::string& quantity, Curves curves) {
    if (curves.points.size() < 2) return;
    const std::vector<double> factors = specimen_factors(curves.points);
    for (std::size_t i = 0; i < factors.size(); ++i) curves.claims[i].value = factors[i];
    compare(quantity + ", over the curve through all,", "", curves.claims, warnings_);
  }

  void compare_strips(Thread thread, const char* word) {
    Curves curves;
    for (std::size_t i = 0; i < m_.tensile.size(); ++i) {
      const TensileTest& test = m_.tensile[i];
      if (test.direction == thread)
        curves.add(named("[[tensile]]", i, test.name, test.place), test.points, test.factor.plus_minus);
    }
    if (const KesSide* side = kes(thread))
      if (const auto strip = kes_strip(*side, thread))
        curves.add(of_kes("EMT, LT or WT", word), strip->points, kes_share(*side, *strip));
    compare_curves(fmt::format("the force along {}", word), std::move(curves));
  }

  /// The uncertainty of the forces of a KES strip by that of its numbers.
  static std::optional<double> kes_share(const KesSide& side, const TensileTest& strip) {
    double squares = 0;
    for (std::optional<Measured> KesSide::* number :
         {&KesSide::extension, &KesSide::linearity, &KesSide::tensile_energy}) {
      KesSide shifted = side;
      std::optional<Measured>& x = shifted.*number;
      if (!x || !x->plus_minus) continue;
      x->value += *x->plus_minus;
      squares += std::pow(relative_change(strip.points, kes_strip(shifted, strip.direction)->points), 2);
    }
    if (squares > 0) return std::sqrt(squares);
    return std::nullopt;
  }

  void compare_bending(Thread thread, const char* word) {
    Curves curves;
    std::vector<Claim> rigidities;
    for (std::size_t i = 0; i < m_.bending.size(); ++i) {
      const BendingTest& test = m_.bending[i];
      if (test.direction != thread) continue;
      const std::string by = named("[[bending]]", i, test.name, test.place);
      if (const auto rigidity = rigidity_by(test, m_.areal_density->value)) {
        rigidities.push_back({by, *rigidity, share_of_rigidity(test)});
      } else {
        curves.add(by, test.points, test.factor.plus_minus);
      }
    }
    if (const KesSide* side = kes(thread); side != nullptr && side->bending)
      rigidities.push_back({of_kes("B", word), side->bending->value, share_of(*side->bending)});
    compare_curves(fmt::format("the moment along {}", word), std::move(curves));
    compare(fmt::format("the bending rigidity along {}", word), "N·m", rigidities, warnings_);
  }

  std::optional<double> share_of_rigidity(const BendingTest& test) const {
    if (test.rigidity) return share_of(*test.rigidity);
    BendingTest shifted = test;
    Measured& length = test.bending_length ? *shifted.bending_length : *shifted.loop_height;
    if (!length.plus_minus) return std::nullopt;
    length.value += *length.plus_minus;
    return std::abs(*rigidity_by(shifted, 1) / *rigidity_by(test, 1) - 1);
  }

  void compare_shear() {
    Curves curves;
    std::vector<Claim> moduli;
    for (std::size_t i = 0; i < m_.shear.size(); ++i) {
      const ShearTest& test = m_.shear[i];
      const std::string by = named("[[shear]]", i, test.name, test.place);
      if (test.modulus) moduli.push_back({by, test.modulus->value, share_of(*test.modulus)});
      if (!test.points.empty()) curves.add(by, test.points, test.factor.plus_minus);
    }
    for (const auto& [thread, word] : {std::pair{Thread::warp, "warp"}, {Thread::weft, "weft"}})
      if (const KesSide* side = kes(thread); side != nullptr && side->shear)
        moduli.push_back({of_kes("G", word), side->shear->value, share_of(*side->shear)});
    compare_curves("the force of shear", std::move(curves));
    compare("the modulus of shear", "N/m", moduli, warnings_);
  }

  const Measurements& m_;
  std::vector<std::string> warnings_;
};

}  // namespace

std::vector<std::string> contradictions(const Measurements& measurements) {
  return Comparer(measurements).run();
}

}  // namespace muslin
