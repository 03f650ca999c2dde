// Error reports failures due to input, files or numbers, with a remedy for the user. Bugs in muslin are
// asserts, not Errors.
#pragma once

#include <stdexcept>
#include <string>

#include "muslin/api.hpp"

namespace muslin {

/// The value is the exit code of the program.
enum class ErrorKind {
  usage = 2,          ///< the command line or an API call is wrong
  input = 3,          ///< a scene or mesh is wrong
  solver = 4,         ///< the solver failed
  file = 5,           ///< a file cannot be read or written (missing, permissions, disk full)
  interrupted = 130,  ///< stopped by the user; the run can be resumed
};

/// A position in a file; line and column count from 1, 0 means unknown.
struct Place {
  std::string file;
  int line = 0;
  int column = 0;
};

/// what() reads `FILE:LINE:COLUMN: problem; remedy`, without unknown parts.
class MUSLIN_API Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, Place place, std::string problem, std::string remedy);
  Error(ErrorKind kind, std::string problem, std::string remedy);

  ErrorKind kind() const { return kind_; }
  const Place& place() const { return place_; }
  const std::string& problem() const { return problem_; }
  const std::string& remedy() const { return remedy_; }

 private:
  ErrorKind kind_;
  Place place_;
  std::string problem_;
  std::string remedy_;
};

/// Throws Error(usage) unless `condition`: for arguments that a program must get right.
inline void require(bool condition, const char* problem, const char* remedy) {
  if (!condition) throw Error(ErrorKind::usage, problem, remedy);
}

}  // namespace muslin
