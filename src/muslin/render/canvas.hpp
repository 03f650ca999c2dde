// Canvas draws antialiased lines, rectangles and text into a picture.
#pragma once

#include <span>
#include <string_view>

#include "muslin/core/vectors.hpp"
#include "muslin/render/image.hpp"

namespace muslin {

/// Ink: an sRGB colour 0…1 and its opacity.
struct Ink {
  Vec3 colour = Vec3::Zero();
  double opacity = 1;
};

enum class Align { left, centre, right };

/// Coordinates are pixels, x right, y down, (0, 0) the top left corner of the top left pixel.
class Canvas {
 public:
  explicit Canvas(Image& image) : image_(image) {}

  /// Draws joined segments with round joints and ends; overlaps within one call are inked once.
  void polyline(std::span<const Vec2> points, double width, const Ink& ink);
  /// Draws several polylines as one shape.
  void polylines(std::span<const std::vector<Vec2>> lines, double width, const Ink& ink);
  void rectangle(const Vec2& low, const Vec2& high, const Ink& ink);
  /// Draws text whose baseline starts, is centred or ends at `at`; with `turned` it runs upwards.
  void text(const Vec2& at, std::string_view text, double size, const Ink& ink, Align align = Align::left,
            bool turned = false);

 private:
  Image& image_;
};

}  // namespace muslin
