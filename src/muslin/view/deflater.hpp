// Deflater compresses a stream of bytes in the format that browsers call "deflate" (RFC 1950).
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace muslin {

class Deflater {
 public:
  Deflater();
  ~Deflater();
  void append(std::string_view bytes);
  /// Returns the size of the output so far; some input may still be buffered.
  std::size_t size() const;
  /// Ends the stream and returns it.
  std::string finish();

 private:
  struct Stream;
  std::unique_ptr<Stream> stream_;
};

/// Encodes bytes in base64 (RFC 4648), with padding, without line breaks.
std::string base64(std::string_view bytes);

}  // namespace muslin
