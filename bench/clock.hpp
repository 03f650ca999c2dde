// Time of a stretch of code.
#pragma once

#include <algorithm>
#include <chrono>
#include <ctime>

#include "muslin/core/parallel.hpp"

namespace muslin::bench {

class Clock {
 public:
  /// Time on the wall since the clock was made [s].
  double wall() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  /// Returns an estimate of the wall time on an idle machine [s]. On a shared machine the processor time of
  /// one thread is the better clock; its ticks are too coarse below 1 ms.
  double seconds() const {
    const double busy = static_cast<double>(std::clock() - used_) / CLOCKS_PER_SEC;
    const double passed = wall();
    return thread_count() == 1 && passed > 1e-3 ? std::min(busy, passed) : passed;
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::clock_t used_ = std::clock();
};

/// Runs `body` repeatedly and keeps the least time of each clock: at least three times, unless that
/// takes 3 s, and for half a second, but not more than 200 times.
struct Least {
  double seconds = 1e300, wall = 1e300;

  template <class Body>
  static Least of(const Body& body) {
    return of([] {}, body);
  }
  /// `prepare` goes before every run and is not counted.
  template <class Prepare, class Body>
  static Least of(const Prepare& prepare, const Body& body) {
    Least least;
    const Clock whole;
    for (int n = 0; n < 200 && whole.wall() < (n < 3 ? 3 : 0.5); ++n) {
      prepare();
      const Clock clock;
      body();
      least.seconds = std::min(least.seconds, clock.seconds());
      least.wall = std::min(least.wall, clock.wall());
    }
    return least;
  }
};

}  // namespace muslin::bench
