#include "muslin/render/overlay.hpp"

#include <algorithm>
#include <cmath>

#include "muslin/render/canvas.hpp"
#include "muslin/render/stroke_font.hpp"
#include "muslin/render/ticks.hpp"

namespace muslin {
namespace {

const Ink dark = {Vec3(0.13, 0.16, 0.20), 0.85};

double font_size(const Image& image) { return std::clamp(image.height / 36.0, 9.0, 48.0); }

}  // namespace

void draw_label(Image& image, std::string_view label) {
  const double size = font_size(image);
  Canvas(image).text(Vec2(size, image.height - size), label, size, dark);
}

void draw_legend(Image& image, const ColourScale& scale) {
  Canvas canvas(image);
  const double size = font_size(image);
  const Ticks ticks = round_ticks(scale.low, scale.high, 5);
  double widest = 0;
  for (const std::string& label : ticks.labels) widest = std::max(widest, text_width(label) * size);
  const double top = std::round(0.28 * image.height);
  const double bottom = std::round(0.78 * image.height);
  const double right = std::round(image.width - size - widest - 0.7 * size);
  const double left = std::round(right - 0.8 * size);
  for (double y = top; y < bottom; ++y)
    canvas.rectangle(Vec2(left, y), Vec2(right, y + 1),
                     {map_colour(scale.map, (bottom - y - 0.5) / (bottom - top)), 1});
  for (std::size_t i = 0; i < ticks.values.size(); ++i) {
    const double t = scale.fraction(ticks.values[i]);
    if (t < -1e-9 || t > 1 + 1e-9) continue;
    const double y = bottom - t * (bottom - top);
    const std::vector<Vec2> tick = {Vec2(right, y), Vec2(right + 0.3 * size, y)};
    canvas.polyline(tick, std::max(1.0, 0.08 * size), dark);
    canvas.text(Vec2(right + 0.6 * size, y + 0.36 * size), ticks.labels[i], size, dark);
  }
  canvas.text(Vec2(image.width - size, top - size), scale.label, size, dark, Align::right);
}

}  // namespace muslin
