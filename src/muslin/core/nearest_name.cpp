#include "muslin/core/nearest_name.hpp"

#include <algorithm>
#include <cctype>

namespace muslin {
namespace {

// Longer names are compared by their beginnings: enough for advice, and cheap for absurdly long input.
constexpr std::size_t compared_letters = 64;

char lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

}  // namespace

int edit_distance(std::string_view a, std::string_view b) {
  a = a.substr(0, compared_letters);
  b = b.substr(0, compared_letters);
  std::vector<int> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int replace = last[j - 1] + (lower(a[i - 1]) == lower(b[j - 1]) ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replace});
      if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1])) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

std::optional<std::string> nearest_name(std::string_view name, const std::vector<std::string>& names) {
  const std::string* best = nullptr;
  int best_distance = 0;
  for (const std::string& candidate : names) {
    const int distance = edit_distance(name, candidate);
    if (best == nullptr || distance < best_distance) {
      best = &candidate;
      best_distance = distance;
    }
  }
  if (best == nullptr) return std::nullopt;
  const auto letters = static_cast<int>(std::max(name.size(), best->size()));
  if (2 * best_distance > letters) return std::nullopt;
  return *best;
}

std::string name_list(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "`" : ", `") + name + "`";
  return text;
}

std::string name_advice(std::string_view name, const std::vector<std::string>& names) {
  if (const auto near = nearest_name(name, names)) return "did you mean `" + *near + "`?";
  return names.empty() ? "there is none" : "use one of " + name_list(names);
}

}  // namespace muslin
