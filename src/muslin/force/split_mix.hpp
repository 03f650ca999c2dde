// split_mix computes random bits from integers: turbulence is decided by its seed on every machine.
#pragma once

#include <cstdint>

namespace muslin {

/// A bijection whose output bits are well mixed. Source: Steele, Lea, Flood, Fast Splittable Pseudorandom
/// Number Generators, 2014 (SplitMix64).
inline std::uint64_t split_mix(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

}  // namespace muslin
