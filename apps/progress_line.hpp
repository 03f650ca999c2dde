// Shows the progress of long work and the time left on one line of standard error.
#pragma once

#include <chrono>
#include <string_view>

#include "muslin/core/progress.hpp"

namespace muslin::app {

/// On a terminal the line is redrawn in place, at most ten times a second; elsewhere a line is written for
/// every tenth of the work. Silent if quiet.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(double fraction, std::string_view text);
  void finish();

  /// Callbacks for the library; cancelled by Ctrl-C.
  Progress progress();

 private:
  using Clock = std::chrono::steady_clock;
  bool quiet_;
  bool terminal_;
  bool drawn_ = false;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point last_{};
  double begin_fraction_ = -1;
  int last_tenth_ = -1;
};

}  // namespace muslin::app
