// Figure is a drawing as a list of lines, boxes and texts, output as SVG or pixels.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "muslin/core/vectors.hpp"
#include "muslin/render/canvas.hpp"

namespace muslin {

/// Coordinates are points: x right, y down.
struct FigureLine {
  std::vector<std::vector<Vec2>> pieces;
  double width = 1;
  Ink ink;
  double dash = 0;  ///< length of dashes and of gaps; 0 = unbroken
};
struct FigureBox {
  Vec2 low, high;
  Ink ink;
};
struct FigureText {
  Vec2 at;
  std::string text;
  double size = 12;
  Ink ink;
  Align align = Align::left;
  bool turned = false;  ///< runs upwards
  bool bold = false;
};

struct Figure {
  double width = 0;
  double height = 0;
  std::string title;  ///< alternative text
  std::vector<std::variant<FigureLine, FigureBox, FigureText>> items;
};

/// Returns a complete SVG document, text escaped, control characters left out.
std::string svg(const Figure& figure);
Image raster(const Figure& figure, double pixels_per_point);

/// Returns the pieces cut into dashes of this length with gaps as long.
std::vector<std::vector<Vec2>> dashed(const std::vector<std::vector<Vec2>>& pieces, double length);

}  // namespace muslin
