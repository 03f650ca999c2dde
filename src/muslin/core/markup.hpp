// Escapes text for HTML and XML.
#pragma once

#include <string>
#include <string_view>

namespace muslin {

/// Returns the text with &, <, > and " as entities, for elements and quoted attributes. Control characters
/// other than tab and line end are left out: XML 1.0 has none.
std::string escaped_markup(std::string_view text);

}  // namespace muslin
