// Reads numbers from bytes in either byte order.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>

namespace muslin {

enum class Scalar { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

constexpr std::size_t size_of(Scalar type) {
  switch (type) {
    case Scalar::int8:
    case Scalar::uint8:
      return 1;
    case Scalar::int16:
    case Scalar::uint16:
      return 2;
    case Scalar::int32:
    case Scalar::uint32:
    case Scalar::float32:
      return 4;
    case Scalar::float64:
      return 8;
  }
  return 8;
}

/// Returns the value of this type and byte order at `bytes`, which has at least size_of(type) bytes.
template <class Value>
Value load(const char* bytes, bool big_endian) {
  unsigned char raw[sizeof(Value)];
  std::memcpy(raw, bytes, sizeof(Value));
  if (big_endian != (std::endian::native == std::endian::big))
    for (std::size_t i = 0; i < sizeof(Value) / 2; ++i) std::swap(raw[i], raw[sizeof(Value) - 1 - i]);
  Value value;
  std::memcpy(&value, raw, sizeof(Value));
  return value;
}

/// Returns a value of a type known at run time. The conversion to double is lossless for every type.
inline double load_number(const char* bytes, Scalar type, bool big_endian) {
  switch (type) {
    case Scalar::int8:
      return load<std::int8_t>(bytes, big_endian);
    case Scalar::uint8:
      return load<std::uint8_t>(bytes, big_endian);
    case Scalar::int16:
      return load<std::int16_t>(bytes, big_endian);
    case Scalar::uint16:
      return load<std::uint16_t>(bytes, big_endian);
    case Scalar::int32:
      return load<std::int32_t>(bytes, big_endian);
    case Scalar::uint32:
      return load<std::uint32_t>(bytes, big_endian);
    case Scalar::float32:
      return static_cast<double>(load<float>(bytes, big_endian));
    case Scalar::float64:
      return load<double>(bytes, big_endian);
  }
  return 0;
}

}  // namespace muslin
