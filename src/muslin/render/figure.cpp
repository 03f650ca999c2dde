#include "muslin/render/figure.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "muslin/core/markup.hpp"
#include "muslin/render/colour.hpp"

namespace muslin {
namespace {

std::string paint(const char* attribute, const Ink& ink) {
  const auto c = bytes_of_srgb(ink.colour);
  std::string text = fmt::format("{}=\"#{:02x}{:02x}{:02x}\"", attribute, c[0], c[1], c[2]);
  if (ink.opacity < 1) text += fmt::format(" {}-opacity=\"{:.2f}\"", attribute, ink.opacity);
  return text;
}

struct SvgWriter {
  std::string out;
  void operator()(const FigureLine& line) {
    std::string path;
    for (const auto& piece : line.pieces)
      for (std::size_t i = 0; i < piece.size(); ++i)
        fmt::format_to(std::back_inserter(path), "{}{:.2f} {:.2f}", i == 0 ? 'M' : 'L', piece[i].x(),
                       piece[i].y());
    if (path.empty()) return;
    out += fmt::format("<path d=\"{}\" fill=\"none\" {} stroke-width=\"{:.2f}\"", path,
                       paint("stroke", line.ink), line.width);
    if (line.dash > 0) out += fmt::format(" stroke-dasharray=\"{0:.1f} {0:.1f}\"", line.dash);
    out += " stroke-linejoin=\"round\" stroke-linecap=\"round\"/>\n";
  }
  void operator()(const FigureBox& box) {
    out += fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" {}/>\n",
                       box.low.x(), box.low.y(), box.high.x() - box.low.x(), box.high.y() - box.low.y(),
                       paint("fill", box.ink));
  }
  void operator()(const FigureText& text) {
    const char* anchor = text.align == Align::left ? "start" : text.align == Align::centre ? "middle" : "end";
    out += fmt::format("<text x=\"{0:.2f}\" y=\"{1:.2f}\" font-size=\"{2:.1f}\" text-anchor=\"{3}\" {4}",
                       text.at.x(), text.at.y(), text.size, anchor, paint("fill", text.ink));
    if (text.bold) out += " font-weight=\"600\"";
    if (text.turned) out += fmt::format(" transform=\"rotate(-90 {:.2f} {:.2f})\"", text.at.x(), text.at.y());
    out += fmt::format(">{}</text>\n", escaped_markup(text.text));
  }
};

struct Rasteriser {
  Canvas canvas;
  double scale;
  void operator()(const FigureLine& line) {
    auto pieces = line.dash > 0 ? dashed(line.pieces, line.dash) : line.pieces;
    for (auto& piece : pieces)
      for (Vec2& point : piece) point *= scale;
    canvas.polylines(pieces, line.width * scale, line.ink);
  }
  void operator()(const FigureBox& box) { canvas.rectangle(box.low * scale, box.high * scale, box.ink); }
  void operator()(const FigureText& text) {
    canvas.text(text.at * scale, text.text, text.size * scale, text.ink, text.align, text.turned);
    if (text.bold)  // the pen once more, a little to the side
      canvas.text(text.at * scale + Vec2(0.04 * text.size * scale, 0), text.text, text.size * scale, text.ink,
                  text.align, text.turned);
  }
};

}  // namespace

std::string svg(const Figure& figure) {
  SvgWriter writer;
  writer.out = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\" "
      "role=\"img\">\n<title>{2}</title>\n",
      figure.width, figure.height, escaped_markup(figure.title));
  for (const auto& item : figure.items) std::visit(writer, item);
  return writer.out + "</svg>\n";
}

Image raster(const Figure& figure, double pixels_per_point) {
  Image image(static_cast<int>(std::lround(figure.width * pixels_per_point)),
              static_cast<int>(std::lround(figure.height * pixels_per_point)));
  Rasteriser rasteriser{Canvas(image), pixels_per_point};
  for (const auto& item : figure.items) std::visit(rasteriser, item);
  return image;
}

std::vector<std::vector<Vec2>> dashed(const std::vector<std::vector<Vec2>>& pieces, double length) {
  std::vector<std::vector<Vec2>> dashes;
  for (const auto& piece : pieces) {
    double left = length;  // of the dash or gap in work
    bool drawn = true;
    if (!piece.empty()) dashes.push_back({piece.front()});
    for (std::size_t i = 0; i + 1 < piece.size(); ++i) {
      Vec2 from = piece[i];
      double rest = (piece[i + 1] - from).norm();
      while (rest > left) {
        from += left / rest * (piece[i + 1] - from);
        rest -= left;
        left = length;
        if (drawn)
          dashes.back().push_back(from);
        else
          dashes.push_back({from});
        drawn = !drawn;
      }
      left -= rest;
      if (drawn) dashes.back().push_back(piece[i + 1]);
    }
  }
  return dashes;
}

}  // namespace muslin
