// TextScanner splits a text file into words and numbers, with the place of each for error messages. Lines may
// end in LF, CRLF or CR.
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

  /// Returns the next word of this line; empty at its end.
  std::string_view word();
  /// Returns the next word of this or a later line; empty at the end of the text.
  std::string_view next_word();
  /// Advances to the next line; false at the end of the text.
  bool next_line();
  /// Returns the rest of this line, without blanks around it.
  std::string_view rest_of_line();

  /// Returns the word as a finite number. Errors: input, naming the expected quantity.
  double number(std::string_view word, const char* what) const;
  /// Returns a number valid as a position: at most largest_coordinate.
  double coordinate(std::string_view word) const;
  /// Returns a number valid as a texture coordinate: any that a float can hold.
  double texture_coordinate(std::string_view word) const;
  std::int64_t integer(std::string_view word, const char* what) const;

  int line() const { return line_; }
  /// The first byte not yet read.
  std::size_t offset() const { return static_cast<std::size_t>(at_ - begin_); }
  /// Throws Error(input) at a word of this line, or at the line if the word is empty.
  [[noreturn]] void fail(std::string_view word, std::string problem, std::string remedy) const;
  /// Throws Error(input) at a line read earlier.
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
