#include "muslin/core/error.hpp"

#include <utility>

#include <fmt/format.h>

namespace muslin {
namespace {

std::string sentence(const Place& place, const std::string& problem, const std::string& remedy) {
  std::string text = place.file;
  if (place.line > 0) text += fmt::format(":{}", place.line);
  if (place.line > 0 && place.column > 0) text += fmt::format(":{}", place.column);
  if (!text.empty()) text += ": ";
  text += problem;
  if (!remedy.empty()) text += "; " + remedy;
  return text;
}

}  // namespace

Error::Error(ErrorKind kind, Place place, std::string problem, std::string remedy)
    : std::runtime_error(sentence(place, problem, remedy)),
      kind_(kind),
      place_(std::move(place)),
      problem_(std::move(problem)),
      remedy_(std::move(remedy)) {}

Error::Error(ErrorKind kind, std::string problem, std::string remedy)
    : Error(kind, Place{}, std::move(problem), std::move(remedy)) {}

}  // namespace muslin
