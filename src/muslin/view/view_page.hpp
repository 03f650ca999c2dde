// Writes one self-contained HTML page that plays a run in a browser.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "muslin/cache/run_reader.hpp"
#include "muslin/core/progress.hpp"

namespace muslin {

struct ViewOptions {
  /// Size limit of the page. For a large run, contours and lattices are left out first, then frames.
  std::uint64_t largest_bytes = 16'000'000;
};

struct ViewReport {
  std::uint64_t bytes = 0;         ///< of the page
  int frames = 0;                  ///< shown
  std::vector<std::string> notes;  ///< sentences on omitted data, also shown on the page
};

/// Writes the page; it appears when it is complete. docs/guide/viewer.md describes the page and
/// docs/adr/viewer-page.md the file. Errors: input, if the run has no frame or a position in it is not
/// finite; usage, if not even two frames fit into largest_bytes; file.
ViewReport write_view(const RunReader& run, const std::filesystem::path& file,
                      const ViewOptions& options = {}, const Progress& progress = {});

}  // namespace muslin
