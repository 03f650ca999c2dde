#include "muslin/simulation/step_control.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace muslin {
namespace {

/// Largest a dt² as a share of the size of a part, independent of its resolution.
constexpr double acceleration_share = 3.5e-4, draft_longer = 4;
/// Edges by which a part may move in a step relative to another.
constexpr double edges_past = 4;
/// A step is hard with at least this many iterations, and easy with at most this many.
constexpr int hard = 24, easy = 12;
constexpr int max_harder = 2;
/// Bodies squeezed by prescribed motion would otherwise require ever shorter steps.
constexpr int finest = 6;

}  // namespace

int StepControl::choose(const ModelParts& parts, std::span<const double> accelerations,
                        std::span<const double> masses, const State& state, double frame_time,
                        Effort effort) const {
  struct Motion {
    double mass = 0, square = 0;
    Vec3 momentum = Vec3::Zero();
  };
  std::vector<Motion> motions(parts.count());
  const bool moving = state.previous_velocities.size() == state.velocities.size() && state.previous_dt > 0;
  for (std::size_t v = 0; v < state.velocities.size(); ++v) {
    Motion& motion = motions[static_cast<std::size_t>(parts.of_vertex[v])];
    motion.mass += masses[v];
    motion.momentum += masses[v] * state.velocities[v];
    if (moving)
      motion.square += masses[v] * (state.velocities[v] - state.previous_velocities[v]).squaredNorm();
  }
  Vec3 slowest = Vec3::Constant(1e300), fastest = Vec3::Constant(-1e300);
  for (const Motion& motion : motions) {
    slowest = slowest.cwiseMin(motion.momentum / motion.mass);
    fastest = fastest.cwiseMax(motion.momentum / motion.mass);
  }
  const double relative = motions.size() > 1 ? (fastest - slowest).norm() : 0;
  const double share = acceleration_share * (effort == Effort::draft ? draft_longer : 1);
  double shortest = frame_time;
  for (std::size_t p = 0; p < motions.size(); ++p) {
    const double loads = p < accelerations.size() ? accelerations[p] : 0;
    const double a = moving ? std::sqrt(motions[p].square / motions[p].mass) / state.previous_dt : loads;
    const double size = parts.sizes[p] > 0 ? parts.sizes[p] : parts.edges[p];
    shortest = std::min(shortest, parts.longest_steps[p]);
    if (a > 0) shortest = std::min(shortest, std::sqrt(share * size / a));
    if (relative > 0) shortest = std::min(shortest, edges_past * parts.edges[p] / relative);
  }
  int wanted = static_cast<int>(std::ceil(std::log2(frame_time / shortest) - 1e-9));
  wanted = std::max(wanted, 0) + harder;
  // The step at most doubles.
  if (moving) wanted = std::max(wanted, level - 1);
  wanted = std::min(wanted, finest);
  while (ticks % length(wanted) != 0) ++wanted;
  return wanted;
}

void StepControl::note(int chosen, const StepReport& report) {
  level = chosen;
  if (!report.converged || report.newton_iterations >= hard) {
    harder = std::min(harder + 1, max_harder);
  } else if (report.newton_iterations <= easy) {
    harder = std::max(harder - 1, 0);
  }
}

}  // namespace muslin
