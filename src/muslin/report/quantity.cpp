#include "muslin/report/quantity.hpp"

#include <array>
#include <cmath>

#include <fmt/format.h>

namespace muslin {

std::string quantity(double value, const std::string& unit) {
  struct Prefix {
    double size;
    const char* name;
  };
  constexpr std::array prefixes = {Prefix{1e9, "G"},  Prefix{1e6, "M"},  Prefix{1e3, "k"},
                                   Prefix{1, ""},     Prefix{1e-3, "m"}, Prefix{1e-6, "µ"},
                                   Prefix{1e-9, "n"}, Prefix{1e-12, "p"}};
  if (value == 0 || !std::isfinite(value)) return fmt::format("{:g} {}", value, unit);
  // Three digits of 0.9996 are 1.00.
  for (const Prefix& prefix : prefixes)
    if (std::abs(value) >= 0.9995 * prefix.size)
      return fmt::format("{:.3g} {}{}", value / prefix.size, prefix.name, unit);
  return fmt::format("{:.2g} {}", value, unit);
}

std::string position_text(const Vec3& at) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g}) m", at.x(), at.y(), at.z());
}

}  // namespace muslin
