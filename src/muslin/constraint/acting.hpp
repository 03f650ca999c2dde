// acting tells whether a constraint with a window of time acts in a step.
#pragma once

namespace muslin {

/// True if a constraint from `from` until `until` acts in the step from time_begin to time_end: if it does so
/// at the end. Borders within 1e-6 of a step of `time_end` count as reached: a clock that adds up steps is
/// not exact.
inline bool acting(double from, double until, double time_begin, double time_end) {
  const double now = time_end + 1e-6 * (time_end - time_begin);
  return now >= from && now < until;
}

}  // namespace muslin
