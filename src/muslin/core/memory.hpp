// Provides the amount of available memory.
#pragma once

#include <cstdint>

namespace muslin {

/// Returns the bytes that this process may still allocate without swapping: the system's available memory, or
/// less if the process's control group has a lower limit. The largest number if the system does not report
/// it.
std::uint64_t available_memory();

}  // namespace muslin
