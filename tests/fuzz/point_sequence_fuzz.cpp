// Any bytes as a point cache: the first decides the format. Either every sample is there, or an Error.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "muslin/core/error.hpp"
#include "muslin/io/point_sequence_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    const muslin::PointSequence sequence =
        muslin::read_point_sequence_from(bytes, data[0] % 2 ? ".pc2" : ".mdd", "fuzzed", 24);
    for (const double time : {-1.0, 0.0, 0.5, 1e9}) {
      if (!sequence.at(time, sequence.points - 1).allFinite()) __builtin_trap();
    }
  } catch (const muslin::Error&) {
  }
  return 0;
}
