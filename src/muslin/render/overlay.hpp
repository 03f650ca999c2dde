// Draws the label and the legend over a rendered frame.
#pragma once

#include <string_view>

#include "muslin/render/colour.hpp"
#include "muslin/render/image.hpp"

namespace muslin {

/// Draws the frame's label, bottom left.
void draw_label(Image& image, std::string_view label);

/// Draws a bar of the scale's colours with round numbers beside it and its label above, at the right.
void draw_legend(Image& image, const ColourScale& scale);

}  // namespace muslin
