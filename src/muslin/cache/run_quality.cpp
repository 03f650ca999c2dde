#include "muslin/cache/run_quality.hpp"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

namespace muslin {
namespace {

constexpr double share_to_warn = 0.01;  // of the steps
constexpr std::size_t max_ranges = 8;
/// Excess over a stretch limit, as a share of the rest length, that is not reported: the limit is stiff, not
/// hard, and a fall that it stops may exceed it by this much.
constexpr double stretch_slack = 0.01;

bool ends_in(const std::vector<int>& frames, int last) { return !frames.empty() && frames.back() == last; }

std::string missed_text(const RunQuality& quality) {
  return fmt::format(
      "{} of {} steps missed their tolerance, in {}; the largest estimate of their error is {:.2g} m; look "
      "at what happens there, or give more steps by time.steps_per_frame",
      quality.steps - quality.converged_steps, quality.steps, describe_frames(quality.frames_missed),
      quality.worst_error);
}

std::string held_back_text(const RunQuality& quality) {
  return fmt::format(
      "pins or colliders that move could not follow their keyframes in {}: something held back up to {} of "
      "their vertices{}; {}",
      describe_frames(quality.frames_held_back), quality.max_held_back, behind_text(quality),
      ends_in(quality.frames_held_back, quality.last_frame) ? "they still are behind"
                                                            : "they have caught up");
}

std::string crossings_text(const RunQuality& quality) {
  const int pairs = quality.crossings_at_end;
  return fmt::format("{} of triangles still {} at the end; more frames may part them",
                     pairs == 1 ? "1 pair" : fmt::format("{} pairs", pairs),
                     pairs == 1 ? "crosses" : "cross");
}

std::string remedy_of_stretch(const RunQuality::Overstretched& shell) {
  if (!shell.frames.empty() && shell.frames.front() == 0)
    return "it starts beyond the limit: check `rest_mesh`, or raise `stretch_limit`";
  if (shell.fell)
    return "the limit fell, and cloth follows it by its length per second at most, or as far as pins and "
           "colliders let it: let `stretch_limit` fall more slowly, or less far";
  return "move pins and colliders that pull it less far apart or more slowly, or raise `stretch_limit`";
}

std::string overstretched_text(const RunQuality::Overstretched& shell) {
  return fmt::format(
      "body {}: a triangle was up to {:.4g} times as long as at rest, beyond its `stretch_limit` of {:.4g}, "
      "at the end of {}; {}",
      shell.body, shell.stretch, shell.limit, describe_frames(shell.frames), remedy_of_stretch(shell));
}

}  // namespace

std::string behind_text(const RunQuality& quality) {
  return quality.farthest_behind > 0 ? fmt::format(", by up to {:.3g} mm", 1000 * quality.farthest_behind)
                                     : "";
}

void RunQuality::add(const LimitedStretch& row) {
  auto last =
      std::find_if(limits.begin(), limits.end(), [&](const Limit& other) { return other.body == row.body; });
  if (last == limits.end()) last = limits.insert(last, {row.body, row.limit});
  last->fell = last->fell || row.limit < last->limit;
  last->limit = row.limit;
  if (!(row.stretch > row.limit + stretch_slack)) return;
  auto shell = std::find_if(overstretched.begin(), overstretched.end(),
                            [&](const Overstretched& other) { return other.body == row.body; });
  if (shell == overstretched.end()) shell = overstretched.insert(shell, {row.body, {}, 0, 0, last->fell});
  shell->frames.push_back(row.frame);
  if (row.stretch - row.limit > shell->stretch - shell->limit)
    shell->stretch = row.stretch, shell->limit = row.limit;
}

void RunQuality::add(const Diagnostics& row) {
  steps += row.steps;
  converged_steps += row.converged_steps;
  worst_error = std::max(worst_error, row.error);
  if (row.converged_steps < row.steps) frames_missed.push_back(row.frame);
  if (row.held_back > 0) frames_held_back.push_back(row.frame);
  max_held_back = std::max(max_held_back, row.held_back);
  farthest_behind = std::max(farthest_behind, row.behind);
  if (row.crossings > 0) frames_crossing.push_back(row.frame);
  crossings_at_end = row.crossings;
  last_frame = row.frame;
}

std::string describe_frames(const std::vector<int>& frames) {
  std::vector<std::string> ranges;
  std::size_t told = 0;
  while (told < frames.size() && ranges.size() < max_ranges) {
    std::size_t end = told + 1;
    while (end < frames.size() && frames[end] == frames[end - 1] + 1) ++end;
    ranges.push_back(end - told == 1 ? std::to_string(frames[told])
                                     : fmt::format("{} to {}", frames[told], frames[end - 1]));
    told = end;
  }
  if (told < frames.size()) ranges.push_back(fmt::format("{} more", frames.size() - told));
  std::string text = frames.size() == 1 ? "frame " : "frames ";
  for (std::size_t i = 0; i < ranges.size(); ++i)
    text += (i == 0 ? "" : i + 1 == ranges.size() ? " and " : ", ") + ranges[i];
  return text;
}

std::vector<std::string> warnings_of(const RunQuality& quality) {
  std::vector<std::string> warnings;
  const auto missed = static_cast<double>(quality.steps - quality.converged_steps);
  if (missed > share_to_warn * static_cast<double>(quality.steps) ||
      ends_in(quality.frames_missed, quality.last_frame))
    warnings.push_back(missed_text(quality));
  if (!quality.frames_held_back.empty()) warnings.push_back(held_back_text(quality));
  if (quality.crossings_at_end > 0) warnings.push_back(crossings_text(quality));
  for (const RunQuality::Overstretched& shell : quality.overstretched)
    warnings.push_back(overstretched_text(shell));
  return warnings;
}

}  // namespace muslin
