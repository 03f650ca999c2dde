#include "muslin/render/stroke_font.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>

namespace muslin {
namespace {

// A glyph is strokes separated by blanks; a stroke is points "xy" in base 36. The baseline is y = 4, small
// letters reach 12 (c), capitals 16 (g), tails 0. '~' before a stroke makes its points the control points
// of a curve (a quadratic B-spline through both ends), 'o' those of a closed curve (as in the letter o).
const std::map<std::uint32_t, const char*> glyphs = {
    {'A', "044g84 1777"},
    {'B', "040g ~0g7g7a0a ~0a8a8404"},
    {'C', "~8d8g0g048487"},
    {'D', "040g ~0g3g9g943404"},
    {'E', "7g0g0474 0a6a"},
    {'F', "7g0g04 0a6a"},
    {'G', "~8d8g0g04848a 8a5a"},
    {'H', "040g 848g 0a8a"},
    {'I', "141g"},
    {'J', "~6g640407"},
    {'K', "040g 8g09 3b84"},
    {'L', "0g0474"},
    {'M', "040g57aga4"},
    {'N', "040g848g"},
    {'O', "o0g9g9404"},
    {'P', "040g ~0g8g8909"},
    {'Q', "o0g9g9404 5893"},
    {'R', "040g ~0g8g8909 4984"},
    {'S', "~8d8g0g0a8a840407"},
    {'T', "0g8g 4g44"},
    {'U', "~0g04848g"},
    {'V', "0g448g"},
    {'W', "0g345e74ag"},
    {'X', "048g 0g84"},
    {'Y', "0g498g 4944"},
    {'Z', "0g8g0484"},
    {'a', "o0c7c7404 7c74"},
    {'b', "0g04 o0c7c7404"},
    {'c', "~7a7c0c047476"},
    {'d', "7g74 o0c7c7404"},
    {'e', "0878 ~787c0c047476"},
    {'f', "~5g2g24 0c5c"},
    {'g', "o0c7c7404 ~7c700002"},
    {'h', "0g04 ~080c7c74"},
    {'i', "141c 1f1g"},
    {'j', "~3c3000 3f3g"},
    {'k', "0g04 7c08 2974"},
    {'l', "1g14"},
    {'m', "040c ~080c5c54 ~585caca4"},
    {'n', "040c ~080c7c74"},
    {'o', "o0c7c7404"},
    {'p', "000c o0c7c7404"},
    {'q', "7c70 o0c7c7404"},
    {'r', "040c ~080c5c"},
    {'s', "~6a6c0c0868640406"},
    {'t', "~2g2454 0c5c"},
    {'u', "~0c047478 7c74"},
    {'v', "0c448c"},
    {'w', "0c345b74ac"},
    {'x', "047c 0c74"},
    {'y', "0c44 8c20"},
    {'z', "0c7c0474"},
    {'0', "o0g8g8404"},
    {'1', "0d3g34"},
    {'2', "~0d0g7g7a04 0474"},
    {'3', "~0e0g7g7a3a ~3a8a840406"},
    {'4', "645g0787"},
    {'5', "7g1g0a ~0a2c8c840406"},
    {'6', "o0b8b8404 ~6g0g07"},
    {'7', "0g7g24"},
    {'8', "o1g7g7a1a o0a8a8404"},
    {'9', "o0g8g8909 ~8d8424"},
    {'.', "1415"},
    {',', "2501"},
    {':', "1415 1a1b"},
    {';', "2501 2a2b"},
    {'!', "1g18 1415"},
    {'?', "~0d0g7g7b3a37 3435"},
    {'-', "0a5a"},
    {'+', "0a8a 4e46"},
    {'=', "0c8c 0888"},
    {'/', "026g"},
    {'\\', "0g62"},
    {'(', "~3h0d0633"},
    {')', "~0h3d3603"},
    {'[', "3g0g0232"},
    {']', "0g3g3202"},
    {'|', "1g12"},
    {'_', "0383"},
    {'*', "4e48 1d79 7d19"},
    {'%', "o0g4g4b0b o69a9a464 9g14"},
    {'\'', "1g1d"},
    {'"', "1g1d 4g4d"},
    {'<', "7e0a76"},
    {'>', "0e7a06"},
    {'#', "143g 547g 0b8b 0888"},
    {0xb0, "o0g4g4c0c"},
    {0xb2, "~0e0g4g4d0a 0a4a"},
    {0xb3, "~0f0g4g4d2d ~2d4d4a0a0b"},
    {0xb5, "000c ~0c047478 7c74"},
    {0xb7, "1a1b"},
    {0xd7, "177d 1d77"},
    {0x2013, "0a7a"},
    {0x2212, "0a8a"},
};

constexpr double unit = 0.06;  // of the font size; twelve units are a capital
constexpr double gap = 3.2;    // between glyphs, in units
constexpr double blank = 4.5;

double digit(char c) { return c <= '9' ? c - '0' : c - 'a' + 10; }

std::uint32_t next_character(std::string_view text, std::size_t& at) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t first = byte(at++);
  int more = 0;
  std::uint32_t code = first;
  if (first >= 0xf0) {
    more = 3;
    code = first & 0x07u;
  } else if (first >= 0xe0) {
    more = 2;
    code = first & 0x0fu;
  } else if (first >= 0xc0) {
    more = 1;
    code = first & 0x1fu;
  }
  for (; more > 0 && at < text.size() && (byte(at) & 0xc0u) == 0x80u; --more)
    code = (code << 6) | (byte(at++) & 0x3fu);
  return code;
}

/// Corner cutting (Chaikin 1974): three rounds are smooth at any size in use here.
std::vector<Vec2> round_off(std::vector<Vec2> points, bool closed) {
  for (int round = 0; round < 3; ++round) {
    std::vector<Vec2> cut;
    const std::size_t count = points.size();
    if (!closed) cut.push_back(points.front());
    for (std::size_t i = 0; i + (closed ? 0 : 1) < count; ++i) {
      const Vec2& a = points[i];
      const Vec2& b = points[(i + 1) % count];
      const bool first = !closed && i == 0;
      const bool last = !closed && i + 2 == count;
      if (!first) cut.push_back(0.75 * a + 0.25 * b);
      if (!last) cut.push_back(0.25 * a + 0.75 * b);
      if (first && last) cut.push_back(0.5 * (a + b));
    }
    if (!closed) cut.push_back(points.back());
    points = std::move(cut);
  }
  if (closed) points.push_back(points.front());
  return points;
}

/// Appends the glyph's strokes at x (in units) and returns its width.
double append_glyph(std::uint32_t code, double x, std::vector<std::vector<Vec2>>* strokes) {
  const auto found = glyphs.find(code);
  const std::string_view glyph = found != glyphs.end() ? found->second : glyphs.at('?');
  double width = 0;
  std::size_t at = 0;
  while (at < glyph.size()) {
    const std::size_t end = std::min(glyph.find(' ', at), glyph.size());
    std::string_view stroke = glyph.substr(at, end - at);
    const char kind = stroke.front();
    if (kind == '~' || kind == 'o') stroke.remove_prefix(1);
    std::vector<Vec2> points;
    for (std::size_t i = 0; i + 1 < stroke.size(); i += 2) {
      width = std::max(width, digit(stroke[i]));
      points.emplace_back(x + digit(stroke[i]), digit(stroke[i + 1]) - 4);
    }
    if (kind == '~' || kind == 'o') points = round_off(std::move(points), kind == 'o');
    if (strokes) {
      for (Vec2& point : points) point *= unit;
      strokes->push_back(std::move(points));
    }
    at = end + 1;
  }
  return width;
}

double lay_out(std::string_view text, std::vector<std::vector<Vec2>>* strokes) {
  double x = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::uint32_t code = next_character(text, at);
    x += code == ' ' || code == 0xa0 ? blank : append_glyph(code, x, strokes) + gap;
  }
  return std::max(0.0, x - gap) * unit;
}

}  // namespace

std::vector<std::vector<Vec2>> text_strokes(std::string_view text) {
  std::vector<std::vector<Vec2>> strokes;
  lay_out(text, &strokes);
  return strokes;
}

double text_width(std::string_view text) { return lay_out(text, nullptr); }

}  // namespace muslin
