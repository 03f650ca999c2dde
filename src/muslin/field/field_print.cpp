#include "muslin/field/field_print.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <vector>

#include <fmt/format.h>

#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/field/signed_distance.hpp"
#include "muslin/geometry/thicken.hpp"

namespace muslin {
namespace {

constexpr double max_samples = 1e7;
constexpr int widest_margin = 1000;

// A bounding box this close to a sample, in voxel widths, is taken to pass through it.
constexpr double on_sample = 1e-9;

template <class Number>
bool parse_number(std::string_view text, Number& value) {
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  return problem == std::errc() && end == text.data() + text.size();
}

// Samples first … first + count − 1, in multiples of the voxel width.
struct PrintedRange {
  double first = 0, count = 0;
};

PrintedRange sample_range(double low, double high, double width, int margin) {
  const double first = std::ceil(low / width - on_sample) - margin;
  const double last = std::floor(high / width + on_sample) + margin;
  return {first, std::max(0.0, last - first + 1)};
}

int thinnest_axis(const Box& bounds) {
  const Vec3 sizes = bounds.sizes();
  int axis = 2;
  for (const int other : {1, 0})
    if (sizes[other] < sizes[axis]) axis = other;
  return axis;
}

std::string table(const std::vector<double>& values, std::size_t columns) {
  std::vector<std::string> cells;
  cells.reserve(values.size());
  std::size_t widest = 0;
  for (const double value : values) {
    cells.push_back(fmt::format("{:.3f}", value));
    if (cells.back() == "-0.000") cells.back() = "0.000";
    widest = std::max(widest, cells.back().size());
  }
  std::string text;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i % columns != 0) text += "  ";
    text.append(widest - cells[i].size(), ' ');
    text += cells[i];
    if ((i + 1) % columns == 0) text += '\n';
  }
  return text;
}

}  // namespace

Slice parse_slice(std::string_view text) {
  const std::size_t axis = std::string_view("xyz").find(text.empty() ? '?' : text[0]);
  Slice slice;
  if (axis == std::string_view::npos || text.size() < 3 || text[1] != '=' ||
      !parse_number(text.substr(2), slice.value) || !std::isfinite(slice.value))
    throw Error(ErrorKind::usage, fmt::format("\"{}\" is not a slice", text),
                "write an axis and a coordinate in metres, such as z=0 or x=0.5");
  slice.axis = static_cast<int>(axis);
  return slice;
}

Vec3i parse_margin(std::string_view text) {
  Vec3i margin = Vec3i::Constant(-1);
  std::string_view rest = text;
  int given = 0;
  bool good = true;
  while (good && given < 3) {
    const std::size_t comma = rest.find(',');
    good = parse_number(rest.substr(0, comma), margin[given]) && margin[given] >= 0 &&
           margin[given] <= widest_margin;
    ++given;
    if (comma == std::string_view::npos) break;
    good = good && given < 3;
    rest.remove_prefix(comma + 1);
  }
  if (!good)
    throw Error(ErrorKind::usage, fmt::format("\"{}\" is not a margin", text),
                fmt::format("write a whole number of voxels from 0 to {}, or one per axis, such as 3,1",
                            widest_margin));
  for (int axis = given; axis < 3; ++axis) margin[axis] = margin[given - 1];
  return margin;
}

std::string print_field(const Mesh& mesh, const FieldPrintSettings& settings) {
  const double width = settings.voxel_width;
  if (!(width > 0) || !std::isfinite(width))
    throw Error(ErrorKind::usage, fmt::format("the voxel width {} m is invalid", width),
                "give a positive width in metres");
  if (settings.margin.minCoeff() < 0 || settings.margin.maxCoeff() > widest_margin)
    throw Error(ErrorKind::usage, "the margin is negative or too wide",
                fmt::format("give 0 to {} voxels", widest_margin));
  const double thickness = settings.thickness.value_or(width);
  const bool sheet = !is_closed(mesh) && thickness != 0;
  const SignedDistance distance(sheet ? thicken(mesh, thickness) : mesh);
  const Box& bounds = distance.bounds();

  Slice slice;
  if (settings.slice) {
    slice = *settings.slice;
  } else {
    slice.axis = thinnest_axis(bounds);
    slice.value = bounds.center()[slice.axis];
  }
  const int across = slice.axis == 0 ? 2 : 0;  // columns
  const int upward = slice.axis == 1 ? 2 : 1;  // rows
  const auto range = [&](int axis) {
    return sample_range(bounds.min()[axis], bounds.max()[axis], width, settings.margin[axis]);
  };
  const PrintedRange columns = range(across), rows = range(upward);
  if (columns.count * rows.count > max_samples)
    throw Error(ErrorKind::usage,
                fmt::format("a slice of this mesh has {:.0f} × {:.0f} samples at the voxel width {} m",
                            columns.count, rows.count, width),
                "choose a larger voxel width");

  const auto column_count = static_cast<std::size_t>(columns.count);
  const auto count = column_count * static_cast<std::size_t>(rows.count);
  const auto position = [&](std::size_t sample) {
    const std::size_t row = sample / column_count;
    Vec3 p;
    p[slice.axis] = slice.value;
    p[across] = width * (columns.first + static_cast<double>(sample % column_count));
    p[upward] = width * (rows.first + rows.count - 1 - static_cast<double>(row));
    return p;
  };
  std::vector<double> values(count);
  parallel_for(count, 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t sample = begin; sample < end; ++sample) values[sample] = distance(position(sample));
  });
  if (!settings.csv) return table(values, column_count);

  std::string text = "x,y,z,distance\n";
  for (std::size_t sample = 0; sample < count; ++sample) {
    const Vec3 p = position(sample) + Vec3::Zero();  // no negative zeros
    fmt::format_to(std::back_inserter(text), "{},{},{},{}\n", p.x(), p.y(), p.z(), values[sample] + 0.0);
  }
  return text;
}

}  // namespace muslin
