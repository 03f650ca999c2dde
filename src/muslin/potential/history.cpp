#include "muslin/potential/history.hpp"

#include <string>

#include <fmt/format.h>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

/// Returns the index at which the array of a name begins, −1 if there is none.
std::int64_t begin_of(const History& history, std::string_view name, std::size_t count) {
  std::string_view names(reinterpret_cast<const char*>(history.names.data()), history.names.size());
  std::int64_t begin = 0;
  for (const std::int64_t of_array : history.counts) {
    const std::size_t end = names.find('\0');
    const bool whole =
        end != std::string_view::npos && of_array >= 0 && begin + of_array <= std::ssize(history.values);
    if (!whole) throw Error(ErrorKind::input, "the history of the checkpoint is damaged", "restart the run");
    if (names.substr(0, end) == name) {
      if (of_array == static_cast<std::int64_t>(count)) return begin;
      throw Error(ErrorKind::input,
                  fmt::format("the history `{}` has {} numbers, and {} elements want one each", name,
                              of_array, count),
                  "restart the run");
    }
    names.remove_prefix(end + 1);
    begin += of_array;
  }
  return -1;
}

}  // namespace

std::span<const double> History::find(std::string_view name, std::size_t count) const {
  const std::int64_t begin = begin_of(*this, name, count);
  if (begin < 0) return {};
  return std::span(values).subspan(static_cast<std::size_t>(begin), count);
}

std::span<double> History::get(std::string_view name, std::size_t count) {
  std::int64_t begin = begin_of(*this, name, count);
  if (begin < 0) {
    begin = std::ssize(values);
    names.insert(names.end(), name.begin(), name.end());
    names.push_back(0);
    counts.push_back(static_cast<std::int64_t>(count));
    values.resize(values.size() + count, 0.0);
  }
  return std::span(values).subspan(static_cast<std::size_t>(begin), count);
}

}  // namespace muslin
