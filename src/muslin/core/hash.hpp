// Hashes bytes, to tell whether data are the same across runs and machines.
#pragma once

#include <cstddef>
#include <cstdint>

namespace muslin {

/// Returns a 64-bit hash of the bytes (not cryptographic), the same on every machine. A seed that is the hash
/// of other bytes chains the two.
std::uint64_t hash_bytes(const void* data, std::size_t size, std::uint64_t seed = 0);

}  // namespace muslin
