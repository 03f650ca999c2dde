#include "muslin/render/canvas.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "muslin/render/stroke_font.hpp"

namespace muslin {
namespace {

void blend(std::uint8_t* pixel, const Vec3& colour, double coverage) {
  for (int i = 0; i < 3; ++i)
    pixel[i] = static_cast<std::uint8_t>(
        std::lround((1 - coverage) * pixel[i] + coverage * 255 * std::clamp(colour[i], 0.0, 1.0)));
}

double distance_to_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 edge = b - a;
  const double length2 = edge.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(edge) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * edge).norm();
}

/// Pixels whose centres lie in [low, high], within the picture.
struct PixelRange {
  int begin, end;
  PixelRange(double low, double high, int size)
      : begin(static_cast<int>(std::floor(std::clamp(low, 0.0, double(size))))),
        end(static_cast<int>(std::ceil(std::clamp(high, 0.0, double(size))))) {}
};

}  // namespace

void Canvas::polyline(std::span<const Vec2> points, double width, const Ink& ink) {
  const std::vector<std::vector<Vec2>> lines = {{points.begin(), points.end()}};
  polylines(lines, width, ink);
}

void Canvas::polylines(std::span<const std::vector<Vec2>> lines, double width, const Ink& ink) {
  Eigen::AlignedBox2d box;
  for (const auto& line : lines)
    for (const Vec2& point : line)
      if (point.allFinite()) box.extend(point);
  if (box.isEmpty()) return;
  const double reach = width / 2 + 0.5;
  const PixelRange xs(box.min().x() - reach, box.max().x() + reach, image_.width);
  const PixelRange ys(box.min().y() - reach, box.max().y() + reach, image_.height);
  if (xs.begin >= xs.end || ys.begin >= ys.end) return;
  const std::size_t columns = static_cast<std::size_t>(xs.end - xs.begin);
  std::vector<float> mask(columns * static_cast<std::size_t>(ys.end - ys.begin), 0.0f);
  for (const auto& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) {
      const Vec2& a = line[i];
      const Vec2& b = line[std::min(i + 1, line.size() - 1)];
      if (!a.allFinite() || !b.allFinite()) continue;
      const PixelRange sx(std::min(a.x(), b.x()) - reach, std::max(a.x(), b.x()) + reach, image_.width);
      const PixelRange sy(std::min(a.y(), b.y()) - reach, std::max(a.y(), b.y()) + reach, image_.height);
      for (int y = sy.begin; y < sy.end; ++y)
        for (int x = sx.begin; x < sx.end; ++x) {
          const double coverage = reach - distance_to_segment(Vec2(x + 0.5, y + 0.5), a, b);
          float& cell =
              mask[static_cast<std::size_t>(y - ys.begin) * columns + static_cast<std::size_t>(x - xs.begin)];
          cell = std::max(cell, static_cast<float>(std::clamp(coverage, 0.0, std::min(1.0, width))));
        }
    }
  }
  for (int y = ys.begin; y < ys.end; ++y)
    for (int x = xs.begin; x < xs.end; ++x) {
      const float coverage =
          mask[static_cast<std::size_t>(y - ys.begin) * columns + static_cast<std::size_t>(x - xs.begin)];
      if (coverage > 0) blend(image_.pixel(x, y), ink.colour, coverage * ink.opacity);
    }
}

void Canvas::rectangle(const Vec2& low, const Vec2& high, const Ink& ink) {
  const PixelRange xs(low.x(), high.x(), image_.width);
  const PixelRange ys(low.y(), high.y(), image_.height);
  for (int y = ys.begin; y < ys.end; ++y)
    for (int x = xs.begin; x < xs.end; ++x) {
      const double wide = std::min(x + 1.0, high.x()) - std::max(double(x), low.x());
      const double tall = std::min(y + 1.0, high.y()) - std::max(double(y), low.y());
      blend(image_.pixel(x, y), ink.colour, std::max(0.0, wide) * std::max(0.0, tall) * ink.opacity);
    }
}

void Canvas::text(const Vec2& at, std::string_view text, double size, const Ink& ink, Align align,
                  bool turned) {
  const double shift = align == Align::left ? 0 : text_width(text) * (align == Align::centre ? 0.5 : 1.0);
  std::vector<std::vector<Vec2>> strokes = text_strokes(text);
  for (auto& stroke : strokes)
    for (Vec2& point : stroke) {
      const double along = (point.x() - shift) * size;
      const double up = point.y() * size;
      point = turned ? Vec2(at.x() - up, at.y() - along) : Vec2(at.x() + along, at.y() - up);
    }
  polylines(strokes, std::max(1.0, pen_width * size), ink);
}

}  // namespace muslin
