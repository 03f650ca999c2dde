#include "muslin/core/memory.hpp"

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace muslin {
namespace {

constexpr std::uint64_t unknown = std::numeric_limits<std::uint64_t>::max();

std::uint64_t number_in(const char* file) {
  std::ifstream in(file);
  std::uint64_t number = 0;
  return in >> number ? number : unknown;  // "max" means no limit
}

std::uint64_t system_available() {
  std::ifstream in("/proc/meminfo");
  for (std::string key; in >> key;) {
    std::uint64_t kibibytes = 0;
    if (key == "MemAvailable:" && in >> kibibytes) return kibibytes << 10;
    std::getline(in, key);
  }
  return unknown;
}

}  // namespace

std::uint64_t available_memory() {
  const std::uint64_t limit = number_in("/sys/fs/cgroup/memory.max");
  const std::uint64_t used = number_in("/sys/fs/cgroup/memory.current");
  const std::uint64_t left = limit == unknown || used == unknown ? unknown : limit - std::min(limit, used);
  return std::min(system_available(), left);
}

}  // namespace muslin
