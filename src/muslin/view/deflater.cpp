#include "muslin/view/deflater.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <limits>
#include <new>

#include <zlib.h>

namespace muslin {

struct Deflater::Stream {
  z_stream zlib{};
  std::string out;

  void run(std::string_view bytes, int flush) {
    std::array<unsigned char, 1 << 16> chunk;
    do {
      // zlib counts in 32 bits.
      const auto part = bytes.substr(0, std::numeric_limits<std::int32_t>::max());
      bytes.remove_prefix(part.size());
      const int mode = bytes.empty() ? flush : Z_NO_FLUSH;
      zlib.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(part.data()));
      zlib.avail_in = static_cast<uInt>(part.size());
      do {
        zlib.next_out = chunk.data();
        zlib.avail_out = static_cast<uInt>(chunk.size());
        [[maybe_unused]] const int state = ::deflate(&zlib, mode);
        assert(state != Z_STREAM_ERROR);
        out.append(reinterpret_cast<const char*>(chunk.data()), chunk.size() - zlib.avail_out);
      } while (zlib.avail_out == 0);
    } while (!bytes.empty());
  }
};

Deflater::Deflater() : stream_(std::make_unique<Stream>()) {
  if (::deflateInit(&stream_->zlib, Z_DEFAULT_COMPRESSION) != Z_OK) throw std::bad_alloc();
}

Deflater::~Deflater() { ::deflateEnd(&stream_->zlib); }

void Deflater::append(std::string_view bytes) { stream_->run(bytes, Z_NO_FLUSH); }

std::size_t Deflater::size() const { return stream_->out.size(); }

std::string Deflater::finish() {
  stream_->run({}, Z_FINISH);
  return std::move(stream_->out);
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? digits[word >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

}  // namespace muslin
