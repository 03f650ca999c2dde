// One HTML page that plays a run in a browser, with everything it needs inside.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "muslin/cache/run_reader.hpp"
#include "muslin/core/progress.hpp"

namespace muslin {

struct ViewOptions {
  /// The page is kept below this. Too large a run first leaves contours and lattices out, then frames.
  std::uint64_t largest_bytes = 16'000'000;
};

struct ViewReport {
  std::uint64_t bytes = 0;         ///< of the page
  int frames = 0;                  ///< shown
  std::vector<std::string> notes;  ///< sentences about what was left out; the page says the same
};

/// Writes the page; it appears when it is complete. docs/guide/viewer.md says what it shows and
/// docs/adr/viewer-page.md what is in the file. Errors: input, if the run has no frame or a position in it is
/// not finite; usage, if not even two frames fit into largest_bytes; file.
ViewReport write_view(const RunReader& run, const std::filesystem::path& file,
                      const ViewOptions& options = {}, const Progress& progress = {});

}  // namespace muslin
