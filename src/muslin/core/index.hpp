// Turns signed indices into those of std containers.
#pragma once

#include <cstddef>
#include <cstdint>

namespace muslin {

constexpr std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

}  // namespace muslin
