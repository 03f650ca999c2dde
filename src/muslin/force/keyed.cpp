#include "muslin/force/keyed.hpp"

#include <algorithm>
#include <cassert>

namespace muslin {

Vec3 Keyed::at(double time) const { return value_at(keys, time); }

Vec3 Keyed::integral(double time) const { return integral_over(keys, 0, time); }

double Window::share(double begin, double end) const {
  const double length = end - begin;
  assert(length >= 0);
  if (length == 0) return begin >= from && begin <= until ? 1 : 0;
  const double share = (std::min(end, until) - std::max(begin, from)) / length;
  if (share < 1e-6) return 0;
  return share > 1 - 1e-6 ? 1 : share;
}

double Window::sample(double end) const { return std::min(end, until); }

}  // namespace muslin
