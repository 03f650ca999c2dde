// Memory of the process.
#pragma once

#include <fstream>
#include <string>

namespace muslin::bench {

/// Most memory that the process ever had [B].
inline double peak_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("VmHWM:", 0) == 0) return 1024 * std::stod(line.substr(6));
  return 0;
}

}  // namespace muslin::bench
