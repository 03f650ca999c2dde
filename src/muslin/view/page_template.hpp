// page_template() returns the viewer without a run: viewer/dist/page.html, compiled in by cmake/viewer.cmake.
#pragma once

#include <string_view>

namespace muslin {

/// HTML with the placeholders `%TITLE%` for the title and `%RUN%` for the run, each once.
std::string_view page_template();

}  // namespace muslin
