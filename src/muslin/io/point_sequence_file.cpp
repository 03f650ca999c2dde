#include "muslin/io/point_sequence_file.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "muslin/core/error.hpp"
#include "muslin/core/input_file.hpp"
#include "muslin/geometry/inspect.hpp"
#include "muslin/io/binary_reader.hpp"
#include "muslin/io/mesh_file.hpp"

namespace muslin {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& file, const std::string& problem, const std::string& remedy) {
  throw Error(ErrorKind::input, Place{file}, problem, remedy);
}

void check(const PointSequence& sequence, const std::string& file) {
  for (std::size_t s = 0; s < sequence.times.size(); ++s) {
    if (!std::isfinite(sequence.times[s]) || (s > 0 && sequence.times[s] <= sequence.times[s - 1]))
      refuse(file, fmt::format("the time of sample {} is not after the previous one", s),
             "the cache is damaged: export it again");
  }
  for (std::size_t i = 0; i < sequence.positions.size(); ++i) {
    const Eigen::Vector3f& x = sequence.positions[i];
    if (!x.allFinite() || x.cwiseAbs().maxCoeff() > static_cast<float>(largest_coordinate))
      refuse(file,
             fmt::format("point {} of sample {} has a coordinate that is not a number or is beyond 1e9 m",
                         i % sequence.points, i / sequence.points),
             "the cache is damaged: export it again");
  }
}

void read_positions(PointSequence& sequence, std::string_view bytes, bool big_endian) {
  sequence.positions.resize(sequence.times.size() * sequence.points);
  const char* at = bytes.data();
  for (Eigen::Vector3f& x : sequence.positions) {
    for (int axis = 0; axis < 3; ++axis, at += 4) x[axis] = load<float>(at, big_endian);
  }
}

/// Returns the number of samples after the header, which must match the header.
void require_samples(std::size_t bytes, std::int64_t points, std::int64_t samples, const std::string& file) {
  if (points <= 0 || samples <= 0)
    refuse(file, "the cache has no points or no samples", "export the animation again");
  const std::uint64_t per_sample = 12 * static_cast<std::uint64_t>(points);
  if (bytes / per_sample < static_cast<std::uint64_t>(samples))
    refuse(file,
           fmt::format("the cache promises {} samples of {} points and holds {}", samples, points,
                       bytes / per_sample),
           "it is cut off: export it again");
}

PointSequence read_pc2(std::string_view bytes, const std::string& file, double frame_rate) {
  constexpr std::size_t header = 32;
  if (bytes.size() < header || bytes.substr(0, 12) != std::string_view("POINTCACHE2\0", 12))
    refuse(file, "this is not a PC2 point cache", "give the file the suffix of its real format");
  const auto points = load<std::int32_t>(bytes.data() + 16, false);
  const auto start = static_cast<double>(load<float>(bytes.data() + 20, false));
  const auto rate = static_cast<double>(load<float>(bytes.data() + 24, false));
  const auto samples = load<std::int32_t>(bytes.data() + 28, false);
  require_samples(bytes.size() - header, points, samples, file);
  PointSequence sequence;
  sequence.points = static_cast<std::size_t>(points);
  for (std::int32_t s = 0; s < samples; ++s) sequence.times.push_back((start + s * rate) / frame_rate);
  read_positions(sequence, bytes.substr(header), false);
  return sequence;
}

PointSequence read_mdd(std::string_view bytes, const std::string& file) {
  constexpr std::size_t header = 8;
  if (bytes.size() < header) refuse(file, "this is not an MDD point cache", "export the animation again");
  const auto samples = load<std::int32_t>(bytes.data(), true);
  const auto points = load<std::int32_t>(bytes.data() + 4, true);
  const std::size_t times = samples > 0 ? 4 * static_cast<std::size_t>(samples) : 0;
  require_samples(bytes.size() < header + times ? 0 : bytes.size() - header - times, points, samples, file);
  PointSequence sequence;
  sequence.points = static_cast<std::size_t>(points);
  for (std::int32_t s = 0; s < samples; ++s)
    sequence.times.push_back(
        static_cast<double>(load<float>(bytes.data() + header + 4 * static_cast<std::size_t>(s), true)));
  read_positions(sequence, bytes.substr(header + times), true);
  return sequence;
}

/// The files whose name is that of the pattern with digits in place of its #, by number.
std::map<std::uint64_t, fs::path> numbered_files(const fs::path& pattern) {
  const std::string name = pattern.filename().string();
  const std::size_t first = name.find('#'), last = name.find_last_of('#');
  const std::string head = name.substr(0, first), tail = name.substr(last + 1);
  std::map<std::uint64_t, fs::path> files;
  std::error_code code;
  const fs::path folder = pattern.has_parent_path() ? pattern.parent_path() : fs::path(".");
  for (const auto& entry : fs::directory_iterator(folder, code)) {
    const std::string other = entry.path().filename().string();
    if (other.size() <= head.size() + tail.size() || !other.starts_with(head) || !other.ends_with(tail))
      continue;
    const std::string digits = other.substr(head.size(), other.size() - head.size() - tail.size());
    const bool number = digits.size() <= 18 && std::all_of(digits.begin(), digits.end(), [](unsigned char c) {
                          return std::isdigit(c) != 0;
                        });
    if (number) files.emplace(std::stoull(digits), entry.path());
  }
  return files;
}

/// Every second or tenth frame is a sequence too, but all steps are equal.
void require_no_gap(const std::map<std::uint64_t, fs::path>& files, const fs::path& pattern) {
  std::uint64_t stride = std::numeric_limits<std::uint64_t>::max();
  for (auto at = files.begin(), next = std::next(at); next != files.end(); at = next++)
    stride = std::min(stride, next->first - at->first);
  for (auto at = files.begin(), next = std::next(at); next != files.end(); at = next++) {
    if (next->first - at->first == stride) continue;
    refuse(pattern.string(),
           fmt::format("frame {} of the sequence is missing: {} is followed by {}", at->first + stride,
                       at->second.filename().string(), next->second.filename().string()),
           "export the missing frames");
  }
}

PointSequence read_numbered(const fs::path& pattern, double frame_rate) {
  const std::map<std::uint64_t, fs::path> files = numbered_files(pattern);
  if (files.empty())
    throw Error(ErrorKind::file, Place{pattern.string()}, "no file matches this pattern",
                "the # stand for the number, as in walk.0001.obj");
  require_no_gap(files, pattern);
  PointSequence sequence;
  for (const auto& [number, path] : files) {
    const Mesh mesh = read_mesh(path).mesh;
    if (sequence.times.empty()) sequence.points = mesh.vertex_count();
    if (mesh.vertex_count() != sequence.points)
      refuse(path.string(),
             fmt::format("it has {} vertices, the first of the sequence {}", mesh.vertex_count(),
                         sequence.points),
             "export all frames from the same mesh");
    sequence.times.push_back(static_cast<double>(number - files.begin()->first) / frame_rate);
    for (const Vec3& x : mesh.positions) sequence.positions.emplace_back(x.cast<float>());
  }
  return sequence;
}

}  // namespace

PointSequence read_point_sequence_from(std::string_view bytes, const std::string& suffix,
                                       const std::string& file, double frame_rate) {
  PointSequence sequence = suffix == ".mdd" ? read_mdd(bytes, file) : read_pc2(bytes, file, frame_rate);
  check(sequence, file);
  return sequence;
}

PointSequence read_point_sequence(const fs::path& path, double frame_rate) {
  std::string suffix = path.extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const std::string file = path.string();
  if (suffix == ".pc2" || suffix == ".mdd")
    return read_point_sequence_from(read_file(path), suffix, file, frame_rate);
  if (suffix != ".obj" || path.filename().string().find('#') == std::string::npos)
    refuse(file, "a sequence is a .pc2, a .mdd, or numbered files as in walk.####.obj",
           "export the animation in one of these");
  PointSequence sequence = read_numbered(path, frame_rate);
  check(sequence, file);
  return sequence;
}

}  // namespace muslin
