// Bytes made smaller as they come, in the format that browsers call "deflate" (RFC 1950).
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
  /// What came out so far; some of what went in may still be inside.
  std::size_t size() const;
  /// Ends the stream and hands it over.
  std::string finish();

 private:
  struct Stream;
  std::unique_ptr<Stream> stream_;
};

/// RFC 4648, with padding, without line ends.
std::string base64(std::string_view bytes);

}  // namespace muslin
