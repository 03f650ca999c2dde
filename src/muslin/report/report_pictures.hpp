// Draws the pictures of a report.
#pragma once

#include <string>
#include <vector>

#include "muslin/cache/run_reader.hpp"
#include "muslin/core/progress.hpp"
#include "muslin/report/run_report.hpp"

namespace muslin {

struct ReportPicture {
  std::string caption;
  std::string png;  ///< the bytes of the file
};

/// Draws the first, the middle and the last frame, the frame of the largest stretch in colours, and the first
/// frame with crossings, with balls where these are. Errors: file; interrupted.
std::vector<ReportPicture> draw_report_pictures(const RunReader& run, const RunReport& report,
                                                const Progress& progress);

}  // namespace muslin
