#include "muslin/fit/points_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "muslin/core/error.hpp"
#include "muslin/core/toml_value.hpp"

namespace muslin {
namespace {

constexpr std::string_view separators = ",; \t\r";

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  while (true) {
    const std::size_t begin = line.find_first_not_of(separators);
    if (begin == std::string_view::npos) return words;
    line.remove_prefix(begin);
    const std::size_t length = std::min(line.find_first_of(separators), line.size());
    words.push_back(line.substr(0, length));
    line.remove_prefix(length);
  }
}

/// Spreadsheets quote numbers at times, and write a plus.
std::optional<double> number_of(std::string_view word) {
  double x = 0;
  if (word.size() > 1 && word.starts_with('"') && word.ends_with('"')) word = word.substr(1, word.size() - 2);
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), x);
  if (status != std::errc() || end != word.data() + word.size() || !(std::abs(x) <= largest_measured))
    return std::nullopt;
  return x;
}

}  // namespace

std::vector<PointRow> read_points(const std::filesystem::path& file) {
  const std::string text = read_text(file);
  std::vector<PointRow> points;
  int number = 0;
  constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
  for (std::size_t at = text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = std::string_view(text).substr(at, end - at);
    at = end + 1;
    ++number;
    const std::vector<std::string_view> words = words_of(line);
    if (words.empty() || words.front().starts_with('#')) continue;
    const auto is_number = [](std::string_view word) { return number_of(word).has_value(); };
    if (points.empty() && std::none_of(words.begin(), words.end(), is_number)) continue;  // titles of columns
    const auto x = number_of(words[0]);
    const auto y = words.size() == 2 ? number_of(words[1]) : std::nullopt;
    if (!x || !y)
      throw Error(ErrorKind::input, Place{file.string(), number, 0}, "the line is not two numbers",
                  "write two numbers with decimal points, separated by a comma, a semicolon or a tab");
    points.push_back({Vec2(*x, *y), number});
  }
  if (points.empty())
    throw Error(ErrorKind::input, Place{file.string(), 0, 0}, "the file has no line of two numbers",
                "write a point per line: 0.01, 12.5");
  return points;
}

}  // namespace muslin
