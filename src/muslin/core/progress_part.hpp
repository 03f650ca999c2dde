// Gives a part of long work its share of the progress.
#pragma once

#include <string_view>

#include "muslin/core/progress.hpp"

namespace muslin {

/// Returns progress that reports 0…1 as `begin` … `end` of the whole.
inline Progress progress_part(const Progress& whole, double begin, double end) {
  Progress part;
  part.cancelled = whole.cancelled;
  if (whole.report)
    part.report = [report = whole.report, begin, end](double fraction, std::string_view stage) {
      report(begin + fraction * (end - begin), stage);
    };
  return part;
}

}  // namespace muslin
