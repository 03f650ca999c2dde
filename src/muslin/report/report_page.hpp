// Writes a report as one HTML page that needs nothing else: no script, no other file, no network.
#pragma once

#include <string>
#include <vector>

#include "muslin/cache/run_reader.hpp"
#include "muslin/report/report_pictures.hpp"
#include "muslin/report/run_report.hpp"

namespace muslin {

/// Returns the page.
std::string report_page(const RunReader& run, const RunReport& report,
                        const std::vector<ReportPicture>& pictures);

}  // namespace muslin
