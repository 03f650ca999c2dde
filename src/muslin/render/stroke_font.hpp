// Provides a small font of pen strokes: no font file, any size, smooth edges.
#pragma once

#include <string_view>
#include <vector>

#include "muslin/core/vectors.hpp"

namespace muslin {

/// Returns the strokes of a line of text; x runs right and y up from the baseline, in units of the font size
/// (a capital is 0.72 high). UTF-8; characters the font lacks show as a question mark.
std::vector<std::vector<Vec2>> text_strokes(std::string_view text);

/// Returns the width of the text in units of the font size.
double text_width(std::string_view text);

/// Width of the pen in units of the font size.
inline constexpr double pen_width = 0.085;

}  // namespace muslin
