#include <cmath>
#include <cstdlib>
#include <limits>

#include "command.hpp"

namespace muslin::app {
namespace {

CLI::Validator number(bool integer, bool zero, const char* what) {
  return CLI::Validator(
      [=](const std::string& text) {
        char* end = nullptr;
        const double value = std::strtod(text.c_str(), &end);
        const bool good =
            end != text.c_str() && *end == 0 && std::isfinite(value) && (zero ? value >= 0 : value > 0) &&
            (!integer || (value == std::floor(value) && value <= std::numeric_limits<int>::max()));
        return good ? std::string() : "'" + text + "' is not " + what;
      },
      "");
}

}  // namespace

CLI::Validator positive_number() { return number(false, false, "a number above 0"); }
CLI::Validator non_negative_number() { return number(false, true, "a number of at least 0"); }
CLI::Validator positive_integer() { return number(true, false, "a whole number above 0"); }
CLI::Validator non_negative_integer() { return number(true, true, "a whole number of at least 0"); }

}  // namespace muslin::app
