// Image is a picture in 8-bit sRGB; write_png saves it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace muslin {

/// Row by row from the top, three bytes (red, green, blue; sRGB) a pixel.
struct Image {
  Image() = default;
  /// Makes an image filled with one colour. Throws Error(usage) unless both sides are 1…16384.
  Image(int width, int height, std::array<std::uint8_t, 3> colour = {255, 255, 255});

  std::uint8_t* pixel(int x, int y) { return pixels.data() + offset(x, y); }
  const std::uint8_t* pixel(int x, int y) const { return pixels.data() + offset(x, y); }

  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;  ///< height × width × 3

 private:
  std::size_t offset(int x, int y) const {
    return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  }
};

/// Returns the bytes of a PNG file. Throws Error(file) if libpng refuses the picture.
std::string encode_png(const Image& image);

/// Replaces `path` completely or not at all: the file is written beside it under another name, then renamed.
/// Throws Error(file) if the disk is full or `path` cannot be written.
void write_png(const std::filesystem::path& path, const Image& image);

}  // namespace muslin
