// Makes an Error from an operating-system error on a file.
#pragma once

#include <filesystem>
#include <string>

#include "muslin/core/error.hpp"

namespace muslin {

/// Returns Error(file) "PATH: cannot ACTION: REASON; remedy"; `code` is an errno.
Error system_error(const std::filesystem::path& path, const std::string& action, int code);

}  // namespace muslin
