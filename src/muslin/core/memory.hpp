// How much memory there is.
#pragma once

#include <cstdint>

namespace muslin {

/// Bytes that this process may still take without swapping: what the system calls available, or less if the
/// process's control group has a lower limit. The largest number where the system does not tell.
std::uint64_t available_memory();

}  // namespace muslin
