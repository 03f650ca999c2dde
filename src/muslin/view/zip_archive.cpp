#include "muslin/view/zip_archive.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <zlib.h>

#include "muslin/core/error.hpp"
#include "muslin/view/deflater.hpp"

namespace muslin {
namespace {

constexpr std::uint64_t utf8_names = 1 << 11, deflated = 8, first_date = (0 << 9) | (1 << 5) | 1;
constexpr std::uint64_t needs_version = 20, made_on_unix = (3 << 8) | 20;
constexpr std::uint64_t file_mode = 0100644, program_mode = 0100755;

void put(std::string& out, std::uint64_t value, int bytes) {
  for (int b = 0; b < bytes; ++b) out += static_cast<char>(value >> (8 * b) & 255);
}

/// Without header and checksum of RFC 1950, which zip does not have.
std::string raw_deflate(std::string_view bytes) {
  Deflater deflater;
  deflater.append(bytes);
  const std::string stream = deflater.finish();
  return stream.substr(2, stream.size() - 6);
}

/// zlib counts in 32 bits.
std::uint32_t crc(std::string_view bytes) {
  uLong sum = ::crc32(0, nullptr, 0);
  while (!bytes.empty()) {
    const std::string_view part = bytes.substr(0, std::numeric_limits<std::int32_t>::max());
    sum = ::crc32(sum, reinterpret_cast<const Bytef*>(part.data()), static_cast<uInt>(part.size()));
    bytes.remove_prefix(part.size());
  }
  return static_cast<std::uint32_t>(sum);
}

}  // namespace

void ZipArchive::add(std::string_view path, std::string_view bytes, bool executable) {
  const std::string packed = raw_deflate(bytes);
  const std::uint64_t offset = out_.size();
  if (std::max<std::uint64_t>(bytes.size(), offset + packed.size()) > 0xfff00000u || count_ >= 0xffff ||
      path.size() > 0xffff)
    throw Error(ErrorKind::usage, "a zip archive holds 4 GB and 65535 files", "pack less");
  std::string common;
  put(common, needs_version, 2);
  put(common, utf8_names, 2);
  put(common, deflated, 2);
  put(common, 0, 2);  // midnight
  put(common, first_date, 2);
  put(common, crc(bytes), 4);
  put(common, packed.size(), 4);
  put(common, bytes.size(), 4);
  put(common, path.size(), 2);
  put(common, 0, 2);  // no extra fields

  out_ += "PK\3\4";
  out_ += common;
  out_ += path;
  out_ += packed;

  directory_ += "PK\1\2";
  put(directory_, made_on_unix, 2);
  directory_ += common;
  put(directory_, 0, 2 + 2 + 2);  // no comment, first disk, no attributes of its own
  put(directory_, (executable ? program_mode : file_mode) << 16, 4);
  put(directory_, offset, 4);
  directory_ += path;
  ++count_;
}

std::string ZipArchive::finish() {
  const std::uint64_t at = out_.size();
  out_ += directory_;
  out_ += "PK\5\6";
  put(out_, 0, 2 + 2);  // one disk
  put(out_, count_, 2);
  put(out_, count_, 2);
  put(out_, directory_.size(), 4);
  put(out_, at, 4);
  put(out_, 0, 2);  // no comment
  return std::move(out_);
}

}  // namespace muslin
