#include "muslin/io/text_scanner.hpp"

#include <charconv>
#include <cmath>
#include <limits>

#include "muslin/geometry/inspect.hpp"

namespace muslin {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
bool is_line_end(char c) { return c == '\n' || c == '\r'; }

// Returns a word fit for display: short, and without control characters.
std::string quoted(std::string_view word) {
  std::string text = "'";
  for (const char c : word.substr(0, 40)) text += static_cast<unsigned char>(c) < 32 || c == 127 ? '?' : c;
  return text + (word.size() > 40 ? "…'" : "'");
}

}  // namespace

TextScanner::TextScanner(std::string_view text, std::string file, Syntax syntax)
    : begin_(text.data()),
      at_(text.data()),
      end_(text.data() + text.size()),
      line_begin_(text.data()),
      file_(std::move(file)),
      syntax_(syntax) {
  if (text.starts_with("\xEF\xBB\xBF")) at_ += 3;
}

bool TextScanner::joined_line() const {
  return syntax_ == Syntax::obj && *at_ == '\\' && at_ + 1 < end_ && is_line_end(at_[1]);
}

void TextScanner::step_over_line_end() {
  at_ += *at_ == '\r' && at_ + 1 < end_ && at_[1] == '\n' ? 2 : 1;
  line_begin_ = at_;
  ++line_;
}

void TextScanner::skip_blanks() {
  while (at_ < end_) {
    if (is_blank(*at_)) {
      ++at_;
    } else if (joined_line()) {
      ++at_;
      step_over_line_end();
    } else {
      return;
    }
  }
}

std::string_view TextScanner::word() {
  skip_blanks();
  if (at_ == end_ || (syntax_ == Syntax::obj && *at_ == '#')) return {};
  const char* const begin = at_;
  while (at_ < end_ && !is_blank(*at_) && !is_line_end(*at_) && !joined_line()) ++at_;
  return {begin, static_cast<std::size_t>(at_ - begin)};
}

std::string_view TextScanner::next_word() {
  for (;;) {
    const std::string_view found = word();
    if (!found.empty() || !next_line()) return found;
  }
}

bool TextScanner::next_line() {
  skip_blanks();
  const bool joins = syntax_ == Syntax::obj && at_ < end_ && *at_ != '#';  // comments often end in a path
  for (; at_ < end_; ++at_) {
    if (!is_line_end(*at_)) continue;
    const bool joined = joins && at_ > begin_ && at_[-1] == '\\';
    step_over_line_end();
    if (!joined) return at_ < end_;
    --at_;
  }
  return false;
}

std::string_view TextScanner::rest_of_line() {
  skip_blanks();
  const char* const begin = at_;
  while (at_ < end_ && !is_line_end(*at_)) ++at_;
  std::string_view rest(begin, static_cast<std::size_t>(at_ - begin));
  while (!rest.empty() && is_blank(rest.back())) rest.remove_suffix(1);
  return rest;
}

double TextScanner::number(std::string_view word, const char* what) const {
  if (word.empty())
    fail(word, std::string(what) + " is missing", "the file is damaged or cut off: export it again");
  const std::string_view digits = word.front() == '+' ? word.substr(1) : word;
  double value = 0;
  const auto [stop, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool whole = stop == digits.data() + digits.size();
  // Underflow gives 0; overflow is caught below.
  if (whole && code == std::errc::result_out_of_range)
    value = digits.find("e-") != digits.npos || digits.find("E-") != digits.npos ||
                    digits.starts_with("0.") || digits.starts_with("-0.")
                ? 0
                : std::numeric_limits<double>::infinity();
  else if (!whole || code != std::errc())
    fail(word, std::string(what) + " " + quoted(word) + " is not a number",
         "write it in decimals, with a point; or export the file again");
  if (!std::isfinite(value))
    fail(word, std::string(what) + " " + quoted(word) + " is not a finite number",
         "repair the mesh in the modeller and export it again");
  return value;
}

double TextScanner::coordinate(std::string_view word) const {
  const double value = number(word, "a coordinate");
  if (std::abs(value) > largest_coordinate)
    fail(word, "coordinate " + quoted(word) + " is beyond 1e9 m",
         "coordinates are metres: scale the mesh down or export it again");
  return value;
}

double TextScanner::texture_coordinate(std::string_view word) const {
  const double value = number(word, "a texture coordinate");
  if (std::abs(value) > std::numeric_limits<float>::max())
    fail(word, "texture coordinate " + quoted(word) + " is too large", "export the file again");
  return value;
}

std::int64_t TextScanner::integer(std::string_view word, const char* what) const {
  if (word.empty())
    fail(word, std::string(what) + " is missing", "the file is damaged or cut off: export it again");
  const std::string_view digits = word.front() == '+' ? word.substr(1) : word;
  std::int64_t value = 0;
  const auto [stop, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (stop != digits.data() + digits.size() || code != std::errc())
    fail(word, std::string(what) + " " + quoted(word) + " is not a whole number", "export the file again");
  return value;
}

void TextScanner::fail(std::string_view word, std::string problem, std::string remedy) const {
  const int column = word.data() != nullptr && word.data() >= line_begin_ && word.data() < end_
                         ? static_cast<int>(word.data() - line_begin_) + 1
                         : 0;
  throw Error(ErrorKind::input, Place{file_, line_, column}, std::move(problem), std::move(remedy));
}

void TextScanner::fail_at(int line, std::string problem, std::string remedy) const {
  throw Error(ErrorKind::input, Place{file_, line}, std::move(problem), std::move(remedy));
}

}  // namespace muslin
