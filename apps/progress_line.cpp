#include "progress_line.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "command.hpp"
#include <fmt/format.h>
#include <unistd.h>

namespace muslin::app {
namespace {

std::string duration(double seconds) {
  const long s = std::lround(seconds);
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{}:{:02} min", s / 60, s % 60);
  return fmt::format("{}:{:02} h", s / 3600, s / 60 % 60);
}

}  // namespace

ProgressLine::ProgressLine(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

ProgressLine::~ProgressLine() { finish(); }

void ProgressLine::finish() {
  if (drawn_) std::fputc('\n', stderr);
  drawn_ = false;
}

void ProgressLine::show(double fraction, std::string_view text) {
  if (quiet_) return;
  const auto now = Clock::now();
  fraction = std::clamp(fraction, 0.0, 1.0);
  if (begin_fraction_ < 0 || fraction < begin_fraction_) {
    begin_ = now;
    begin_fraction_ = fraction;
  }
  const int tenth = static_cast<int>(fraction * 10);
  if (terminal_) {
    if (fraction < 1 && drawn_ && now - last_ < std::chrono::milliseconds(100)) return;
  } else {
    if (tenth == last_tenth_) return;
  }
  last_ = now;
  last_tenth_ = tenth;
  const double elapsed = std::chrono::duration<double>(now - begin_).count();
  const double done = fraction - begin_fraction_;
  std::string left;
  if (fraction >= 1)
    left = duration(elapsed);
  else if (done > 0 && elapsed > 0.5)
    left = duration(elapsed / done * (1 - fraction)) + " left";
  const std::string line =
      fmt::format("{:3.0f} %  {}{}{}", 100 * fraction, text, left.empty() ? "" : "  ", left);
  if (terminal_) {
    std::fprintf(stderr, "\r\033[K%s", line.c_str());
    drawn_ = true;
  } else {
    std::fprintf(stderr, "%s\n", line.c_str());
  }
  std::fflush(stderr);
}

Progress ProgressLine::progress() {
  return {[this](double fraction, std::string_view stage) { show(fraction, stage); },
          [] { return interrupted(); }};
}

}  // namespace muslin::app
