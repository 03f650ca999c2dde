#include "muslin/render/plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "muslin/core/error.hpp"
#include "muslin/core/output_file.hpp"
#include "muslin/render/figure.hpp"
#include "muslin/render/stroke_font.hpp"
#include "muslin/render/ticks.hpp"

namespace muslin {
namespace {

// Okabe and Ito's colours (Color Universal Design, 2008), without yellow, which is invisible on white.
const std::array<Vec3, 7> palette = {Vec3(0.00, 0.45, 0.70), Vec3(0.84, 0.37, 0.00), Vec3(0.00, 0.62, 0.45),
                                     Vec3(0.80, 0.47, 0.65), Vec3(0.90, 0.62, 0.00), Vec3(0.20, 0.20, 0.20),
                                     Vec3(0.34, 0.71, 0.91)};
const Ink text_ink = {Vec3(0.16, 0.18, 0.21), 1};
const Ink faint_text = {Vec3(0.36, 0.39, 0.43), 1};
const Ink grid_ink = {Vec3(0.90, 0.91, 0.92), 1};
const Ink axis_ink = {Vec3(0.55, 0.58, 0.62), 1};
constexpr double font = 13;
constexpr double title_font = 17;

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void add(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  /// Returns a valid range: never empty or without extent.
  void settle() {
    if (!(low <= high)) low = 0, high = 1;
    if (high - low <= 1e-12 * std::max(std::abs(low), std::abs(high))) {
      const double pad = low == 0 ? 1 : 0.5 * std::abs(low);
      low -= pad;
      high += pad;
    }
  }
  double fraction(double value) const { return (value - low) / (high - low); }
};

void check(const Plot& plot) {
  for (const Series& series : plot.series)
    if (series.values.size() != plot.x.size())
      throw Error(ErrorKind::usage,
                  fmt::format("plot '{}': {} has {} values for {} places", plot.title, series.name,
                              series.values.size(), plot.x.size()),
                  "give one value for each place on the axis");
  if (plot.width < 200 || plot.height < 200 || plot.width > 8000 || plot.height > 8000)
    throw Error(ErrorKind::usage, fmt::format("a plot of {}×{} points", plot.width, plot.height),
                "give sides from 200 to 8000 points");
}

/// Draws rows of names with a piece of their line, from the left; returns the height used.
double add_legend(Figure& figure, const Plot& plot, double left, double right, double top) {
  double x = left;
  double y = top;
  for (std::size_t s = 0; s < plot.series.size(); ++s) {
    const double width = 34 + 1.08 * font * text_width(plot.series[s].name);
    if (x > left && x + width > right) {
      x = left;
      y += 1.6 * font;
    }
    figure.items.push_back(FigureLine{{{Vec2(x, y - 0.35 * font), Vec2(x + 24, y - 0.35 * font)}},
                                      2.4,
                                      {palette[s % palette.size()], 1},
                                      plot.series[s].dashed ? 4.0 : 0.0});
    figure.items.push_back(FigureText{Vec2(x + 31, y), plot.series[s].name, font, text_ink});
    x += width + 20;
  }
  return y - top + 2 * font;
}

std::vector<std::vector<Vec2>> curve(const Plot& plot, const Series& series, const Range& xs, const Range& ys,
                                     const Vec2& low, const Vec2& high) {
  std::vector<std::vector<Vec2>> pieces;
  bool open = false;
  for (std::size_t i = 0; i < plot.x.size(); ++i) {
    if (!std::isfinite(plot.x[i]) || !std::isfinite(series.values[i])) {
      open = false;
      continue;
    }
    if (!open) pieces.emplace_back();
    open = true;
    pieces.back().emplace_back(low.x() + xs.fraction(plot.x[i]) * (high.x() - low.x()),
                               high.y() - ys.fraction(series.values[i]) * (high.y() - low.y()));
  }
  return pieces;
}

Figure lay_out(const Plot& plot) {
  check(plot);
  Range xs, ys;
  for (const double x : plot.x) xs.add(x);
  for (const Series& series : plot.series)
    for (const double y : series.values) ys.add(y);
  if (plot.from_zero) ys.add(0);
  xs.settle();
  ys.settle();

  Figure figure;
  figure.width = plot.width;
  figure.height = plot.height;
  figure.title = plot.title;
  figure.items.push_back(FigureBox{Vec2(0, 0), Vec2(plot.width, plot.height), {Vec3::Ones(), 1}});

  // The y axis ends on ticks; the x axis ends with the data.
  const double room = plot.height - 150;
  const Ticks rough = round_ticks(ys.low, ys.high, std::max(2, static_cast<int>(room / 55)));
  ys.low = rough.step * std::floor(ys.low / rough.step + 1e-9);
  ys.high = rough.step * std::ceil(ys.high / rough.step - 1e-9);
  const Ticks y_ticks =
      round_ticks(ys.low, ys.high, static_cast<int>(std::lround((ys.high - ys.low) / rough.step)));
  double widest = 0;
  for (const std::string& label : y_ticks.labels) widest = std::max(widest, font * text_width(label));

  const double left = std::round(20 + 2.2 * font + widest);
  const double right = plot.width - 26;
  figure.items.push_back(
      FigureText{Vec2(left, 32), plot.title, title_font, text_ink, Align::left, false, true});
  const double legend = plot.series.size() > 1 ? add_legend(figure, plot, left, right, 58) : 0;
  const Vec2 low(left, std::round(48 + legend));
  const Vec2 high(right, plot.height - std::round(4.4 * font));
  const Ticks x_ticks = round_ticks(xs.low, xs.high, std::max(2, static_cast<int>((right - left) / 95)));

  for (std::size_t i = 0; i < y_ticks.values.size(); ++i) {
    const double y = high.y() - ys.fraction(y_ticks.values[i]) * (high.y() - low.y());
    figure.items.push_back(
        FigureLine{{{Vec2(low.x(), y), Vec2(high.x(), y)}}, 1, y_ticks.values[i] == 0 ? axis_ink : grid_ink});
    figure.items.push_back(
        FigureText{Vec2(low.x() - 9, y + 0.36 * font), y_ticks.labels[i], font, faint_text, Align::right});
  }
  for (std::size_t i = 0; i < x_ticks.values.size(); ++i) {
    const double x = low.x() + xs.fraction(x_ticks.values[i]) * (high.x() - low.x());
    figure.items.push_back(FigureLine{{{Vec2(x, high.y()), Vec2(x, high.y() + 5)}}, 1, axis_ink});
    figure.items.push_back(
        FigureText{Vec2(x, high.y() + 8 + font), x_ticks.labels[i], font, faint_text, Align::centre});
  }
  figure.items.push_back(FigureLine{{{Vec2(low.x(), high.y()), Vec2(high.x(), high.y())}}, 1, axis_ink});
  figure.items.push_back(FigureText{Vec2((low.x() + high.x()) / 2, plot.height - 14.0), plot.x_label, font,
                                    text_ink, Align::centre});
  figure.items.push_back(FigureText{Vec2(12 + font, (low.y() + high.y()) / 2), plot.y_label, font, text_ink,
                                    Align::centre, true});
  for (std::size_t s = 0; s < plot.series.size(); ++s)
    figure.items.push_back(FigureLine{curve(plot, plot.series[s], xs, ys, low, high),
                                      2,
                                      {palette[s % palette.size()], 1},
                                      plot.series[s].dashed ? 5.0 : 0.0});
  return figure;
}

}  // namespace

Plot energy_plot(std::span<const double> time, std::span<const double> kinetic,
                 std::span<const double> elastic, std::span<const double> potential,
                 std::span<const double> work, std::span<const double> dissipated) {
  const std::size_t rows = time.size();
  for (const auto column : {kinetic, elastic, potential, work, dissipated})
    if (column.size() != rows)
      throw Error(ErrorKind::usage, "the columns of an energy plot differ in length",
                  "give one value for each time");
  Plot plot;
  plot.title = "Energy";
  plot.x_label = "time [s]";
  plot.x.assign(time.begin(), time.end());
  double largest = 0;
  const auto add = [&](const char* name, const auto& value, bool dashed = false) {
    Series series{name, {}, dashed};
    for (std::size_t i = 0; i < rows; ++i) {
      series.values.push_back(value(i) - value(0));
      if (std::isfinite(series.values.back())) largest = std::max(largest, std::abs(series.values.back()));
    }
    plot.series.push_back(std::move(series));
  };
  add("kinetic", [&](std::size_t i) { return kinetic[i]; });
  add("elastic", [&](std::size_t i) { return elastic[i]; });
  add("potential", [&](std::size_t i) { return potential[i]; });
  add("work", [&](std::size_t i) { return work[i]; });
  add("dissipated", [&](std::size_t i) { return dissipated[i]; });
  add(
      "balance",
      [&](std::size_t i) { return kinetic[i] + elastic[i] + potential[i] + dissipated[i] - work[i]; }, true);

  struct Prefix {
    double size;
    const char* unit;
  };
  Prefix chosen = {1e-6, "µJ"};
  for (const Prefix& prefix : {Prefix{1e-3, "mJ"}, Prefix{1, "J"}, Prefix{1e3, "kJ"}, Prefix{1e6, "MJ"}})
    if (largest >= prefix.size) chosen = prefix;
  if (largest == 0) chosen = {1, "J"};
  for (Series& series : plot.series)
    for (double& value : series.values) value /= chosen.size;
  plot.y_label = fmt::format("energy since the start [{}]", chosen.unit);
  return plot;
}

Plot stretch_plot(std::span<const double> time, std::span<const double> ratio) {
  Plot plot;
  plot.title = "Greatest stretch";
  plot.x_label = "time [s]";
  plot.y_label = "stretch [%]";
  plot.from_zero = true;
  plot.x.assign(time.begin(), time.end());
  Series series{"stretch", {}, false};
  for (const double value : ratio) series.values.push_back(100 * (value - 1));
  plot.series.push_back(std::move(series));
  return plot;
}

std::string plot_svg(const Plot& plot) { return svg(lay_out(plot)); }

Image plot_image(const Plot& plot, double pixels_per_point) {
  return raster(lay_out(plot), pixels_per_point);
}

void write_plot(const std::filesystem::path& path, const Plot& plot) {
  if (path.extension() == ".png") return write_png(path, plot_image(plot));
  if (path.extension() != ".svg")
    throw Error(ErrorKind::usage, {path.string()}, "a plot has the suffix .svg or .png",
                "give a name with one of them");
  const std::string text = plot_svg(plot);
  write_atomically(path, text, false);
}

}  // namespace muslin
