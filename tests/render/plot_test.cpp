// Plots put curves where the numbers say, in well-formed SVG and in pixels; axes carry round numbers.
#include "muslin/render/plot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "render/scenes.hpp"
#include "support/markup.hpp"
#include <gmock/gmock.h>

#include "muslin/core/error.hpp"
#include "muslin/render/figure.hpp"
#include "muslin/render/stroke_font.hpp"
#include "muslin/render/ticks.hpp"

namespace muslin {
namespace {

using ::testing::ElementsAre;

Plot line(std::vector<double> x, std::vector<double> y) {
  Plot plot;
  plot.title = "Height";
  plot.x_label = "time [s]";
  plot.y_label = "height [m]";
  plot.x = std::move(x);
  plot.series.push_back({"height", std::move(y), false});
  return plot;
}

TEST(Ticks, StepsAreOneTwoOrFive) {
  EXPECT_THAT(round_ticks(0, 10, 5).labels, ElementsAre("0", "2", "4", "6", "8", "10"));
  EXPECT_THAT(round_ticks(-0.3, 0.31, 6).labels,
              ElementsAre("-0.3", "-0.2", "-0.1", "0", "0.1", "0.2", "0.3"));
  EXPECT_THAT(round_ticks(0, 1.1, 4).labels, ElementsAre("0", "0.2", "0.4", "0.6", "0.8", "1.0"));
  EXPECT_THAT(round_ticks(0, 2e7, 4).labels, ElementsAre("0", "5e6", "1.0e7", "1.5e7", "2.0e7"));
  EXPECT_EQ(round_ticks(0, 0.002, 4).step, 0.0005);
  EXPECT_GE(round_ticks(7, 7, 4).values.size(), 2u);
  EXPECT_GE(round_ticks(0, 0, 4).values.size(), 2u);
}

TEST(Plot, SvgIsWellFormedAndEscapesText) {
  Plot plot = line({0, 1, 2}, {1, 4, 9});
  plot.title = "a < b & \"c\"\n";
  const std::string text = plot_svg(plot);
  EXPECT_TRUE(test::is_well_formed(text)) << text;
  EXPECT_NE(text.find("a &lt; b &amp; &quot;c&quot;"), std::string::npos);
  EXPECT_NE(text.find("time [s]"), std::string::npos);
  EXPECT_FALSE(test::is_well_formed("<?xml?><a><b></a>"));
}

TEST(Plot, GapsWhereNumbersAreMissing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string text = plot_svg(line({0, 1, 2, 3, 4}, {1, 2, nan, 3, INFINITY}));
  EXPECT_EQ(text.find("nan"), std::string::npos);
  EXPECT_EQ(text.find("inf"), std::string::npos);
  EXPECT_TRUE(test::is_well_formed(plot_svg(line({}, {}))));
  EXPECT_TRUE(test::is_well_formed(plot_svg(line({1}, {nan}))));
}

TEST(Plot, PixelsRiseWithTheCurve) {
  const Image image = plot_image(line({0, 1, 2, 3}, {0, 1, 2, 3}), 1);
  EXPECT_EQ(image.width, 900);
  EXPECT_EQ(image.height, 480);
  const auto height_at = [&](int x) {  // of the blue line
    for (int y = 0; y < image.height; ++y)
      if (image.pixel(x, y)[2] > image.pixel(x, y)[0] + 120) return y;
    return -1;
  };
  const int a = height_at(200), b = height_at(450), c = height_at(700);
  ASSERT_GT(c, 0);
  EXPECT_NEAR(a - b, b - c, 2);
  EXPECT_GT(a, b + 50);
}

TEST(Plot, EnergyCountsFromTheStartAndBalances) {
  const std::vector<double> time = {0, 1, 2};
  const std::vector<double> kinetic = {0, 3000, 1000}, elastic = {0, 0, 500};
  const std::vector<double> potential = {9000, 6000, 5000}, work = {0, 100, 100}, lost = {0, 100, 2600};
  const Plot plot = energy_plot(time, kinetic, elastic, potential, work, lost);
  ASSERT_EQ(plot.series.size(), 6u);
  EXPECT_THAT(plot.series[2].values, ElementsAre(0, -3, -4));  // kilojoule
  EXPECT_THAT(plot.series[5].values, ElementsAre(0, 0, 0));
  EXPECT_NE(plot.y_label.find("[kJ]"), std::string::npos);
  EXPECT_THROW(energy_plot(time, kinetic, elastic, potential, work, {lost.data(), 2}), Error);
  const Plot stretch = stretch_plot(time, std::vector<double>{1, 1.5, 1.25});
  EXPECT_THAT(stretch.series[0].values, ElementsAre(0, 50, 25));
}

TEST(Plot, FilesBySuffix) {
  const testing::Folder folder;
  const Plot plot = line({0, 1}, {0, 1});
  write_plot(folder / "a.svg", plot);
  write_plot(folder / "a.png", plot);
  EXPECT_EQ(testing::read_text(folder / "a.svg"), plot_svg(plot));
  EXPECT_EQ(testing::read_text(folder / "a.png").substr(1, 3), "PNG");
  EXPECT_THROW(write_plot(folder / "a.gif", plot), Error);
  EXPECT_THROW(write_plot(folder / "b.svg", line({0, 1}, {0})), Error);
}

TEST(Figure, DashesCoverHalfTheLine) {
  const auto dashes = dashed({{Vec2(0, 0), Vec2(30, 0), Vec2(30, 70)}}, 5);
  double drawn = 0;
  for (const auto& dash : dashes)
    for (std::size_t i = 0; i + 1 < dash.size(); ++i) drawn += (dash[i + 1] - dash[i]).norm();
  EXPECT_NEAR(drawn, 50, 5);
}

TEST(StrokeFont, EveryPrintableCharacterHasInkAndWidth) {
  for (const char c :
       std::string("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789.,:;!?-+=/()[]%")) {
    const auto strokes = text_strokes(std::string(1, c));
    ASSERT_FALSE(strokes.empty()) << c;
    for (const auto& stroke : strokes)
      for (const Vec2& point : stroke) {
        EXPECT_GE(point.y(), -0.25) << c;
        EXPECT_LE(point.y(), 0.8) << c;
      }
  }
  EXPECT_GT(text_width("mm"), text_width("ii"));
  EXPECT_EQ(text_width("\xc2\xb2"), text_width("²"));
  EXPECT_EQ(text_width("\xf0\x9f\x98\x80"), text_width("?"));
  EXPECT_EQ(text_width(""), 0);
  EXPECT_GT(text_width("\xff\xc2"), 0);  // broken UTF-8 is no reason to stop
}

}  // namespace
}  // namespace muslin
