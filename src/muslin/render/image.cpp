#include "muslin/render/image.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include <png.h>

#include "muslin/core/error.hpp"

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

void write_png(const std::filesystem::path& path, const Image& image) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> bytes(PNG_IMAGE_PNG_SIZE_MAX(png));
  png_alloc_size_t size = bytes.size();
  if (!png_image_write_to_memory(&png, bytes.data(), &size, 0, image.pixels.data(), 0, nullptr)) {
    const std::string message = png.message;
    png_image_free(&png);
    throw Error(ErrorKind::file, {path.string()}, "libpng cannot encode the picture: " + message,
                "try a smaller picture");
  }
  replace_file(path, {bytes.data(), size});
}

void replace_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
  const std::string part = path.string() + ".part";
  std::FILE* file = std::fopen(part.c_str(), "wb");
  if (!file)
    throw Error(ErrorKind::file, {path.string()}, std::string("cannot write: ") + std::strerror(errno),
                "choose a folder that exists and can be written");
  bool good = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  int code = good ? 0 : errno;
  if (std::fclose(file) != 0 && good) {
    good = false;
    code = errno;
  }
  if (good && std::rename(part.c_str(), path.c_str()) != 0) {
    good = false;
    code = errno;
  }
  if (!good) {
    std::remove(part.c_str());
    throw Error(ErrorKind::file, {path.string()}, std::string("cannot write: ") + std::strerror(code),
                "free some space or choose another place");
  }
}

}  // namespace muslin
