// The bytes of a checkpoint: a header that can be read without the model, named arrays (name, layout of an
// element, its size, how many, the elements) in the machine's (little) byte order, and a checksum over
// everything before it. The structs of the state name their arrays (potential/state_arrays.hpp).
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "muslin/potential/state_arrays.hpp"

namespace muslin {

static_assert(std::endian::native == std::endian::little, "checkpoints are little-endian");

/// What a checkpoint says about itself.
struct CheckpointHeader {
  std::uint64_t fingerprint = 0;     ///< of the model it belongs to
  std::int64_t frame = 0;            ///< the last finished frame
  std::int64_t steps = 0;            ///< steps done since then
  std::int64_t steps_per_frame = 0;  ///< of the run that wrote it, 0 if it chose its steps
};

/// Throws Error(input) if the bytes are no checkpoint, of another version, cut off or damaged.
CheckpointHeader read_checkpoint_header(std::span<const std::uint8_t> bytes);

/// Writes arrays to a checkpoint, each under a name of its own.
class CheckpointWriter {
 public:
  explicit CheckpointWriter(const CheckpointHeader& header);
  template <class Element>
  void operator()(std::string_view name, const std::vector<Element>& array) {
    append(name, ArrayElement<Element>::layout, sizeof(Element), array.data(), array.size());
  }
  template <class Element>
  void operator()(std::string_view name, const Element& value) {
    append(name, ArrayElement<Element>::layout, sizeof(Element), &value, 1);
  }
  /// The finished checkpoint.
  std::vector<std::uint8_t> finish() &&;

 private:
  void append(const void* data, std::size_t size);
  void append(std::string_view text);
  void append(std::string_view name, std::string_view layout, std::uint64_t element_size, const void* data,
              std::uint64_t count);
  std::vector<std::uint8_t> bytes_;
};

/// Gives arrays back by their names; the bytes must outlive it.
class CheckpointReader {
 public:
  /// Errors: those of read_checkpoint_header; input, if the arrays are damaged.
  explicit CheckpointReader(std::span<const std::uint8_t> bytes);

  const CheckpointHeader& header() const { return header_; }

  /// Fills `array` with what was written under `name`; leaves it as it is if nothing was. Errors: input, if
  /// elements of another layout were written, or not one value where one is wanted.
  template <class Element>
  void operator()(std::string_view name, std::vector<Element>& array) {
    const Record* record = find(name, ArrayElement<Element>::layout, sizeof(Element));
    if (!record) return;
    array.resize(record->count);
    copy(*record, array.data());
  }
  template <class Element>
  void operator()(std::string_view name, Element& value) {
    const Record* record = find(name, ArrayElement<Element>::layout, sizeof(Element));
    if (!record) return;
    require_one(name, *record);
    copy(*record, &value);
  }
  /// Throws Error(input) if there are arrays that nobody asked for: what a later muslin remembers, without
  /// which the run would go on otherwise.
  void finish() const;

 private:
  struct Record {
    std::string layout;
    std::uint64_t element_size = 0, count = 0;
    std::span<const std::uint8_t> bytes;
    bool read = false;
  };
  const Record* find(std::string_view name, std::string_view layout, std::size_t element_size);
  static void require_one(std::string_view name, const Record& record);
  static void copy(const Record& record, void* to);

  CheckpointHeader header_;
  std::map<std::string, Record, std::less<>> records_;
};

}  // namespace muslin
