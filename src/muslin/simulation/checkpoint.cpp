#include "muslin/simulation/checkpoint.hpp"

#include <array>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "muslin/core/error.hpp"
#include "muslin/core/hash.hpp"

namespace muslin {
namespace {

constexpr std::array<char, 8> magic = {'M', 'U', 'S', 'L', 'I', 'N', 'C', 'P'};
constexpr std::uint64_t version = 4;

struct Preamble {
  std::array<char, 8> magic;
  std::uint64_t version;
  CheckpointHeader header;
};

[[noreturn]] void damaged(const std::string& how) {
  throw Error(ErrorKind::input, "the checkpoint is damaged: " + how,
              "resume from an earlier checkpoint or restart the run");
}

/// Takes values off the front of `rest`.
std::span<const std::uint8_t> take(std::span<const std::uint8_t>& rest, std::uint64_t size) {
  if (size > rest.size()) damaged("it ends too early");
  const auto taken = rest.first(static_cast<std::size_t>(size));
  rest = rest.subspan(taken.size());
  return taken;
}

std::uint64_t take_number(std::span<const std::uint8_t>& rest) {
  std::uint64_t number = 0;
  std::memcpy(&number, take(rest, sizeof number).data(), sizeof number);
  return number;
}

std::string take_text(std::span<const std::uint8_t>& rest) {
  const auto bytes = take(rest, take_number(rest));
  return {bytes.begin(), bytes.end()};
}

}  // namespace

CheckpointHeader read_checkpoint_header(std::span<const std::uint8_t> bytes) {
  Preamble preamble{};
  if (bytes.size() < sizeof preamble + sizeof(std::uint64_t)) damaged("it is cut off");
  std::memcpy(&preamble, bytes.data(), sizeof preamble);
  if (preamble.magic != magic) {
    throw Error(ErrorKind::input, "this is not a muslin checkpoint", "name a checkpoint that muslin wrote");
  }
  if (preamble.version != version) {
    throw Error(ErrorKind::input,
                "the checkpoint has format " + std::to_string(preamble.version) + ", this muslin reads " +
                    std::to_string(version),
                "resume with the version that wrote it, or restart the run");
  }
  std::uint64_t checksum = 0;
  const std::size_t body = bytes.size() - sizeof checksum;
  std::memcpy(&checksum, bytes.data() + body, sizeof checksum);
  if (checksum != hash_bytes(bytes.data(), body)) damaged("its checksum is wrong");
  return preamble.header;
}

CheckpointWriter::CheckpointWriter(const CheckpointHeader& header) {
  const Preamble preamble{magic, version, header};
  append(&preamble, sizeof preamble);
}

void CheckpointWriter::append(const void* data, std::size_t size) {
  const std::size_t at = bytes_.size();
  bytes_.resize(at + size);
  if (size > 0) std::memcpy(bytes_.data() + at, data, size);
}

void CheckpointWriter::append(std::string_view text) {
  const std::uint64_t size = text.size();
  append(&size, sizeof size);
  append(text.data(), text.size());
}

void CheckpointWriter::append(std::string_view name, std::string_view layout, std::uint64_t element_size,
                              const void* data, std::uint64_t count) {
  append(name);
  append(layout);
  append(&element_size, sizeof element_size);
  append(&count, sizeof count);
  append(data, count * element_size);
}

std::vector<std::uint8_t> CheckpointWriter::finish() && {
  const std::uint64_t checksum = hash_bytes(bytes_.data(), bytes_.size());
  append(&checksum, sizeof checksum);
  return std::move(bytes_);
}

CheckpointReader::CheckpointReader(std::span<const std::uint8_t> bytes)
    : header_(read_checkpoint_header(bytes)) {
  auto rest = bytes.subspan(sizeof(Preamble), bytes.size() - sizeof(Preamble) - sizeof(std::uint64_t));
  while (!rest.empty()) {
    std::string name = take_text(rest);
    Record record;
    record.layout = take_text(rest);
    record.element_size = take_number(rest);
    record.count = take_number(rest);
    if (record.element_size == 0 || record.count > rest.size() / record.element_size)
      damaged("it ends too early");
    record.bytes = take(rest, record.count * record.element_size);
    if (!records_.emplace(name, std::move(record)).second) damaged(fmt::format("it has \"{}\" twice", name));
  }
}

const CheckpointReader::Record* CheckpointReader::find(std::string_view name, std::string_view layout,
                                                       std::size_t element_size) {
  const auto found = records_.find(name);
  if (found == records_.end()) return nullptr;
  Record& record = found->second;
  if (record.layout != layout || record.element_size != element_size)
    damaged(fmt::format("its \"{}\" is {} of {} bytes instead of {} of {}", name, record.layout,
                        record.element_size, layout, element_size));
  record.read = true;
  return &record;
}

void CheckpointReader::require_one(std::string_view name, const Record& record) {
  if (record.count != 1) damaged(fmt::format("its \"{}\" has {} values instead of one", name, record.count));
}

void CheckpointReader::copy(const Record& record, void* to) {
  if (!record.bytes.empty()) std::memcpy(to, record.bytes.data(), record.bytes.size());
}

void CheckpointReader::finish() const {
  for (const auto& [name, record] : records_) {
    if (record.read) continue;
    throw Error(ErrorKind::input,
                fmt::format("the checkpoint has \"{}\", which this muslin does not know", name),
                "resume with the version that wrote it, or restart the run");
  }
}

}  // namespace muslin
