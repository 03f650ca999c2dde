// Whole files in and out.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace muslin {

/// All bytes of a regular file. Errors: file, with what the system says.
std::string read_bytes(const std::filesystem::path& path);

/// Writes the bytes to a temporary file beside `path`, flushes them to the disk and renames it to `path`, so
/// that `path` is always either what it was or complete. Errors: file; the temporary file is then removed.
void write_bytes(const std::filesystem::path& path, std::string_view bytes);

}  // namespace muslin
