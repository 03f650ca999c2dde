#include "muslin/render/image.hpp"

#include <string>

#include <png.h>

#include "muslin/core/error.hpp"
#include "muslin/core/output_file.hpp"

namespace muslin {

Image::Image(int width, int height, std::array<std::uint8_t, 3> colour) : width(width), height(height) {
  constexpr int largest = 16384;
  if (width < 1 || height < 1 || width > largest || height > largest)
    throw Error(ErrorKind::usage,
                "a picture of " + std::to_string(width) + "×" + std::to_string(height) + " pixels",
                "give a width and a height from 1 to " + std::to_string(largest));
  pixels.resize(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = colour[i % 3];
}

std::string encode_png(const Image& image) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(png), '\0');
  png_alloc_size_t size = bytes.size();
  if (!png_image_write_to_memory(&png, bytes.data(), &size, 0, image.pixels.data(), 0, nullptr)) {
    const std::string message = png.message;
    png_image_free(&png);
    throw Error(ErrorKind::file, "libpng cannot encode the picture: " + message, "try a smaller picture");
  }
  bytes.resize(size);
  return bytes;
}

void write_png(const std::filesystem::path& path, const Image& image) {
  write_atomically(path, encode_png(image), false);
}

}  // namespace muslin
