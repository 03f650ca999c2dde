// Finds the known name that a misspelt one most likely means.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace muslin {

/// Returns the number of insertions, deletions, replacements and swaps of neighbours that turn `a` into `b`,
/// ignoring case (optimal string alignment).
int edit_distance(std::string_view a, std::string_view b);

/// Returns the name with the smallest edit distance, the first one if several tie; nothing if `names` is
/// empty or if even the best differs in more than half of its letters.
std::optional<std::string> nearest_name(std::string_view name, const std::vector<std::string>& names);

/// Returns advice for a user who wrote `name` where one of `names` is needed: "did you mean `x`?", or, if
/// none is near, "use one of `a`, `b`, `c`".
std::string name_advice(std::string_view name, const std::vector<std::string>& names);

/// Returns the names as "`a`, `b`, `c`".
std::string name_list(const std::vector<std::string>& names);

}  // namespace muslin
