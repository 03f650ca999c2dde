// Reads whole files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>

namespace muslin {

/// Returns all bytes of a regular file of at most `max_bytes`. Never waits for a pipe or reads a device.
/// Errors: file, with the system's message.
std::string read_file(const std::filesystem::path& path,
                      std::uint64_t max_bytes = std::numeric_limits<std::uint64_t>::max());

}  // namespace muslin
