#include "muslin/energy/keyed_stretch_limit.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "muslin/core/parallel.hpp"
#include "muslin/potential/history.hpp"
#include "muslin/potential/state.hpp"

namespace muslin {
namespace {

constexpr double shrinking_rate = 1;  // r [1/s]
constexpr std::size_t limits_grain = 4096;

}  // namespace

/// The energy of one step.
class KeyedStretchLimit::Energy : public StretchLimitEnergy {
 public:
  Energy(const StretchLimitEnergy& other, std::vector<double> limits, const std::vector<double>& stiffnesses)
      : StretchLimitEnergy(other, limits, stiffnesses), limits_(std::move(limits)) {}

  const std::vector<double>& limits() const { return limits_; }

 private:
  std::vector<double> limits_;
};

KeyedStretchLimit::KeyedStretchLimit(const std::string& body, const Shell& shell, KeyedNumber limit,
                                     std::function<double(double)> stiffness,
                                     std::shared_ptr<const SymmetricPattern> pattern)
    : name_(fmt::format("stretch limit {}", body)),
      limit_(std::move(limit)),
      stiffness_(std::move(stiffness)),
      triangles_(shell.triangles),
      inverses_(shell.inverses) {
  const double least = limit_.least();
  first_ = std::make_unique<const StretchLimitEnergy>(shell, least, stiffness_(least), std::move(pattern));
}

std::unique_ptr<Potential> KeyedStretchLimit::potential(const StepContext& step) const {
  std::vector<double> now = limits(step);
  const std::vector<double> stiffness = stiffnesses(now);
  return std::make_unique<Energy>(*first_, std::move(now), stiffness);
}

void KeyedStretchLimit::end_step(const Potential& potential, ConstVectors /*x*/, History& history) const {
  const std::vector<double>& limits = static_cast<const Energy&>(potential).limits();
  std::copy(limits.begin(), limits.end(), history.get(name_, limits.size()).begin());
}

std::vector<double> KeyedStretchLimit::limits(const StepContext& step) const {
  const double keyed = limit_.at(step.time_end);
  const double way = shrinking_rate * (step.time_end - step.time_begin);
  std::vector<double> limits(triangles_.size(), keyed);
  const std::span<const double> before =
      step.history != nullptr ? step.history->find(name_, limits.size()) : std::span<const double>();
  if (before.empty()) return limits;
  parallel_for(limits.size(), limits_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      if (keyed >= before[t]) continue;
      const double idle = 2 * largest_stretch(triangles_[t], inverses_[t], step.positions) - 1;
      limits[t] = std::max(keyed, std::min(before[t], idle) - way);
    }
  });
  return limits;
}

std::vector<double> KeyedStretchLimit::stiffnesses(const std::vector<double>& limits) const {
  std::vector<double> stiffnesses;
  stiffnesses.reserve(limits.size());
  for (const double limit : limits) stiffnesses.push_back(stiffness_(limit));
  return stiffnesses;
}

}  // namespace muslin
