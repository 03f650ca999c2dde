#include "muslin/report/write_report.hpp"

#include "muslin/core/output_file.hpp"
#include "muslin/core/progress_part.hpp"
#include "muslin/report/report_page.hpp"
#include "muslin/report/report_pictures.hpp"

namespace muslin {
namespace {

void write_text(const std::filesystem::path& file, const std::string& text) {
  if (file.has_parent_path()) make_directory(file.parent_path());
  write_atomically(file, text, false);
}

}  // namespace

RunReport write_report(const RunReader& run, const ReportFiles& files, const Progress& progress) {
  const bool draws = files.pictures && !files.page.empty();
  RunReport report = make_report(run, progress_part(progress, 0, draws ? 0.5 : 1));
  if (!files.page.empty()) {
    std::vector<ReportPicture> pictures;
    if (draws) pictures = draw_report_pictures(run, report, progress_part(progress, 0.5, 1));
    write_text(files.page, report_page(run, report, pictures));
  }
  if (!files.json.empty()) write_text(files.json, report_json(run, report).dump(2) + "\n");
  if (!files.junit.empty()) write_text(files.junit, report_junit(report));
  return report;
}

}  // namespace muslin
