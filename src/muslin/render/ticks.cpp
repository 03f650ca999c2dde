#include "muslin/render/ticks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

namespace muslin {
namespace {

std::string label(double value, double step, double largest) {
  if (value == 0) return "0";
  if (largest >= 1e5 || step < 1e-4) {
    // Exponent form with only the digits that distinguish neighbours.
    const int digits = std::clamp(static_cast<int>(std::floor(std::log10(std::abs(value)) + 1e-9) -
                                                   std::floor(std::log10(step) + 1e-9)),
                                  0, 12);
    const std::string text = fmt::format("{:.{}e}", value, digits);
    const std::size_t e = text.find('e');
    return fmt::format("{}e{}", text.substr(0, e), std::atoi(text.c_str() + e + 1));
  }
  const int digits = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  return fmt::format("{:.{}f}", value, digits);
}

}  // namespace

Ticks round_ticks(double low, double high, int wanted) {
  if (!(high - low > 1e-12 * std::max(std::abs(low), std::abs(high)))) {
    const double pad = low == 0 ? 1 : 0.5 * std::abs(low);
    low -= pad;
    high += pad;
  }
  Ticks ticks;
  const double raw = (high - low) / std::max(1, wanted);
  const double power = std::pow(10, std::floor(std::log10(raw)));
  ticks.step = power * (raw <= 1.5 * power ? 1 : raw <= 3.2 * power ? 2 : raw <= 7 * power ? 5 : 10);
  const double slack = 1e-9 * ticks.step;
  const double first = std::ceil((low - slack) / ticks.step);
  const double last = std::floor((high + slack) / ticks.step);
  const double largest = std::max(std::abs(low), std::abs(high));
  for (double i = first; i <= last; ++i) {
    ticks.values.push_back(i * ticks.step);
    ticks.labels.push_back(label(i == 0 ? 0 : i * ticks.step, ticks.step, largest));
  }
  return ticks;
}

}  // namespace muslin
