// Reads and writes the bytes of a checkpoint: a header that can be read without the model, named arrays
// (name, layout of an element, size of an element, number of elements, elements) in little-endian byte order,
// and a checksum over everything before it. The structs of the state name their arrays
// (potential/state_arrays.hpp).
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

/// The header of a checkpoint.
struct CheckpointHeader {
  std::uint64_t fingerprint = 0;     ///< of the model it belongs to
  std::int64_t frame = 0;            ///< the last finished frame
  std::int64_t steps = 0;            ///< steps done since then
  std::int64_t steps_per_frame = 0;  ///< of the run that wrote it, 0 if the step is adaptive
};

/// Throws Error(input) if the bytes are not a checkpoint, or are of another version, truncated or damaged.
CheckpointHeader read_checkpoint_header(std::span<const std::uint8_t> bytes);

/// Writes arrays to a checkpoint, each under a unique name.
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
  /// Returns the finished checkpoint.
  std::vector<std::uint8_t> finish() &&;

 private:
  void append(const void* data, std::size_t size);
  void append(std::string_view text);
  void append(std::string_view name, std::string_view layout, std::uint64_t element_size, const void* data,
              std::uint64_t count);
  std::vector<std::uint8_t> bytes_;
};

/// Reads arrays by their names; the bytes must outlive it.
class CheckpointReader {
 public:
  /// Errors: as read_checkpoint_header; input, if the arrays are damaged.
  explicit CheckpointReader(std::span<const std::uint8_t> bytes);

  const CheckpointHeader& header() const { return header_; }

  /// Fills `array` with the elements written under `name`; leaves it unchanged if there are none. Errors:
  /// input, if the elements have another layout, or if a single value is read and not exactly one was
  /// written.
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
  /// Throws Error(input) if there are arrays that were never read: state of a later version of muslin,
  /// without which the run would continue differently.
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
