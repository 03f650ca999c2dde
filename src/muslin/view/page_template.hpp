// The viewer without a run: viewer/dist/page.html, compiled in by cmake/viewer.cmake.
#pragma once

#include <string_view>

namespace muslin {

/// HTML with `%TITLE%` where the title goes and `%RUN%` where the run goes, each once.
std::string_view page_template();

}  // namespace muslin
