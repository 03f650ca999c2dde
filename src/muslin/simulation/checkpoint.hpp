// The bytes of a checkpoint: a header that can be read without the model, values in the machine's (little)
// byte order, and a checksum over everything before it.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "muslin/scene/model.hpp"

namespace muslin {

static_assert(std::endian::native == std::endian::little, "checkpoints are little-endian");

/// What a checkpoint says about itself.
struct CheckpointHeader {
  std::uint64_t fingerprint = 0;     ///< of the model it belongs to
  std::int64_t frame = 0;            ///< the last finished frame
  std::int64_t steps = 0;            ///< steps done since then
  std::int64_t steps_per_frame = 0;  ///< of the run that wrote it
};

/// Throws Error(input) if the bytes are no checkpoint, of another version, cut off or damaged.
CheckpointHeader read_checkpoint_header(std::span<const std::uint8_t> bytes);

/// A 64-bit hash of the bytes (not cryptographic), the same on every machine.
std::uint64_t hash_bytes(const void* data, std::size_t size, std::uint64_t seed = 0);

/// Hash of what a state must fit: the vertices at rest, their masses, and the bodies' lattices and
/// materials. Pins, loads, times and solver settings are not in it: a run may go on with others.
std::uint64_t model_fingerprint(const Model& model);

/// Appends values to a checkpoint.
class ByteWriter {
 public:
  explicit ByteWriter(const CheckpointHeader& header);
  template <class Value>
  void value(const Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    append(&value, sizeof value);
  }
  template <class Value>
  void values(const std::vector<Value>& values) {
    value(static_cast<std::uint64_t>(values.size()));
    append(values.data(), values.size() * sizeof(Value));
  }
  void text(const std::string& text);
  /// The finished checkpoint.
  std::vector<std::uint8_t> finish() &&;

 private:
  void append(const void* data, std::size_t size);
  std::vector<std::uint8_t> bytes_;
};

/// Takes values back in the same order; throws Error(input) if they run out.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes);
  template <class Value>
  Value value() {
    Value result;
    take(&result, sizeof result);
    return result;
  }
  template <class Value>
  std::vector<Value> values() {
    const auto count = value<std::uint64_t>();
    require(count, sizeof(Value));
    std::vector<Value> result(count);
    take(result.data(), count * sizeof(Value));
    return result;
  }
  std::string text();

 private:
  void require(std::uint64_t count, std::size_t size) const;
  void take(void* data, std::size_t size);
  std::span<const std::uint8_t> rest_;
};

}  // namespace muslin
