// GreyImage is a picture painted as a map of numbers over texture coordinates.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "muslin/core/vectors.hpp"

namespace muslin {

struct GreyImage {
  int width = 0, height = 0;
  std::vector<double> pixels;  ///< height × width, row by row from the top, 0 (black) to 1 (white)

  /// Returns the value at texture coordinates in the unit square, whose origin is the lower left corner of
  /// the picture: bilinear between the centres of pixels, constant beyond them.
  double at(const Vec2& uv) const;
};

/// True if the name of a file ends as that of one which read_grey_image reads.
bool is_image_file(std::string_view name);

/// Reads a PNG file as 8-bit grey, the stored bytes over 255; colours give their luminance. Errors: file, if
/// it cannot be read; input, if it is no PNG file or larger than 16384 pixels.
GreyImage read_grey_image(const std::filesystem::path& path);

/// Reads it from memory; `file` is for messages.
GreyImage read_grey_image_from(std::string_view bytes, const std::string& file);

}  // namespace muslin
