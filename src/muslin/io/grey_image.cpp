#include "muslin/io/grey_image.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>
#include <png.h>

#include "muslin/core/error.hpp"
#include "muslin/core/input_file.hpp"

namespace muslin {

double GreyImage::at(const Vec2& uv) const {
  const auto pixel = [&](int x, int y) {
    x = std::clamp(x, 0, width - 1);
    y = std::clamp(y, 0, height - 1);
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  };
  const double x = uv.x() * width - 0.5, y = (1 - uv.y()) * height - 0.5;
  const double left = std::floor(x), top = std::floor(y);
  const int i = static_cast<int>(left), j = static_cast<int>(top);
  const auto row = [&](int of) { return std::lerp(pixel(i, of), pixel(i + 1, of), x - left); };
  return std::lerp(row(j), row(j + 1), y - top);
}

bool is_image_file(std::string_view name) { return name.ends_with(".png"); }

GreyImage read_grey_image_from(std::string_view bytes, const std::string& file) {
  constexpr png_uint_32 largest = 16384;
  const auto refuse = [&](const std::string& problem) {
    throw Error(ErrorKind::input, Place{file}, problem,
                "save the picture as PNG with at most 16384 pixels a side");
  };
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()))
    refuse(fmt::format("it is no PNG picture: {}", png.message));
  if (png.width > largest || png.height > largest) {
    png_image_free(&png);
    refuse(fmt::format("the picture has {} by {} pixels", png.width, png.height));
  }
  png.format = PNG_FORMAT_GRAY;
  std::vector<std::uint8_t> grey(PNG_IMAGE_SIZE(png));
  const png_color black{};
  if (!png_image_finish_read(&png, &black, grey.data(), 0, nullptr))
    refuse(fmt::format("the picture is damaged: {}", png.message));
  GreyImage image{static_cast<int>(png.width), static_cast<int>(png.height), {}};
  image.pixels.reserve(grey.size());
  for (const std::uint8_t value : grey) image.pixels.push_back(value / 255.0);
  return image;
}

GreyImage read_grey_image(const std::filesystem::path& path) {
  constexpr std::uint64_t most_bytes = std::uint64_t{1} << 31;
  return read_grey_image_from(read_file(path, most_bytes), path.string());
}

}  // namespace muslin
