// Words and numbers of a text file, with the place of each for error messages. Any line ends: LF, CRLF, CR.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "muslin/core/error.hpp"

namespace muslin {

class TextScanner {
 public:
  enum class Syntax {
    plain,  ///< words between blanks
    obj,    ///< also: # starts a comment, a backslash at the end joins two lines
  };
  /// `text` must outlive the scanner; `file` is for messages.
  TextScanner(std::string_view text, std::string file, Syntax syntax);

  /// The next word of this line; empty at its end.
  std::string_view word();
  /// The next word of this or a later line; empty at the end of the text.
  std::string_view next_word();
  /// Goes to the line after this one; false at the end of the text.
  bool next_line();
  /// All that is left of this line, without blanks around it.
  std::string_view rest_of_line();

  /// The word as a finite number. Errors: input, telling what it was meant to be.
  double number(std::string_view word, const char* what) const;
  /// A number that can be a position: at most largest_coordinate.
  double coordinate(std::string_view word) const;
  /// A number that a texture coordinate may have: any that a float can hold.
  double texture_coordinate(std::string_view word) const;
  std::int64_t integer(std::string_view word, const char* what) const;

  int line() const { return line_; }
  /// The first byte not yet read.
  std::size_t offset() const { return static_cast<std::size_t>(at_ - begin_); }
  /// Throws Error(input) at a word of this line, or at the line if the word is empty.
  [[noreturn]] void fail(std::string_view word, std::string problem, std::string remedy) const;
  /// The same for a line read earlier.
  [[noreturn]] void fail_at(int line, std::string problem, std::string remedy) const;

 private:
  void skip_blanks();
  bool joined_line() const;
  void step_over_line_end();

  const char *begin_, *at_, *end_, *line_begin_;
  int line_ = 1;
  std::string file_;
  Syntax syntax_;
};

}  // namespace muslin
