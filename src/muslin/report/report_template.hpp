// report_template() returns the page of a report without its content: page.html, compiled in by
// cmake/report.cmake.
#pragma once

#include <string_view>

namespace muslin {

/// HTML with the placeholders `%TITLE%` for the title and `%BODY%` for the content, each once.
std::string_view report_template();

}  // namespace muslin
