#include "muslin/cache/point_cache.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <fstream>
#include <limits>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "caches are written in the order of memory");
static_assert(sizeof(Vec3f) == 12, "points are written as they lie in memory");

constexpr std::array<char, 12> magic = {'P', 'O', 'I', 'N', 'T', 'C', 'A', 'C', 'H', 'E', '2', '\0'};
struct Header {
  std::array<char, 12> name = magic;
  std::int32_t version = 1;
  std::int32_t points = 0;
  float start = 0;
  float rate = 1;
  std::int32_t samples = 0;
};
static_assert(sizeof(Header) == 32);

std::uint64_t sample_bytes(std::size_t points) { return points * sizeof(Vec3f); }

std::int32_t as_int32(std::size_t points, const fs::path& path) {
  if (points > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    throw Error(ErrorKind::input, {path.string()}, "a point cache holds at most 2147483647 points",
                "use a coarser mesh");
  return static_cast<std::int32_t>(points);
}

Header read_header(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error(ErrorKind::file, {path.string()}, "cannot open the point cache", "check the path");
  Header header;
  if (!in.read(reinterpret_cast<char*>(&header), sizeof header) || header.name != magic ||
      header.version != 1 || header.points < 0 || header.samples < 0) {
    throw Error(ErrorKind::input, {path.string()}, "this is not a PC2 point cache", "run the scene again");
  }
  return header;
}

std::vector<Vec3f> rounded(ConstVectors points) {
  std::vector<Vec3f> result(points.size());
  std::transform(points.begin(), points.end(), result.begin(), [](const Vec3& p) { return p.cast<float>(); });
  return result;
}

}  // namespace

Pc2Writer::Pc2Writer(const fs::path& path, std::size_t points, OutputFile::Mode mode, int samples)
    : points_(points) {
  Header header;
  header.points = as_int32(points, path);
  if (mode == OutputFile::Mode::replace) {
    file_ = OutputFile(path, mode);
    file_.append(&header, sizeof header);
    return;
  }
  const Pc2Reader existing(path);
  if (existing.points() != points || existing.samples() < samples) {
    throw Error(ErrorKind::input, {path.string()}, "the cache does not fit the checkpoint",
                "restart the run, without --resume");
  }
  file_ = OutputFile(path, mode);
  file_.truncate(sizeof header + static_cast<std::uint64_t>(samples) * sample_bytes(points));
  samples_ = samples;
  write_sample_count();
}

void Pc2Writer::write_sample_count() {
  const std::int32_t count = samples_;
  file_.write_at(offsetof(Header, samples), &count, sizeof count);
}

void Pc2Writer::append(ConstVectors points) { append(rounded(points)); }

void Pc2Writer::append(const std::vector<Vec3f>& points) {
  require(points.size() == points_, "a sample has another number of points than its file",
          "give one position for each");
  file_.append(points.data(), sample_bytes(points.size()));
  ++samples_;
  write_sample_count();
}

Pc2Reader::Pc2Reader(fs::path path) : path_(std::move(path)) {
  const Header header = read_header(path_);
  points_ = static_cast<std::size_t>(header.points);
  samples_ = header.samples;
  std::error_code code;
  const auto size = fs::file_size(path_, code);
  if (!code && points_ > 0) {
    const auto complete = (size - sizeof(Header)) / sample_bytes(points_);
    samples_ = static_cast<int>(std::min<std::uint64_t>(complete, static_cast<std::uint64_t>(samples_)));
  }
}

std::vector<Vec3f> Pc2Reader::read(int sample) const {
  require(sample >= 0 && sample < samples_, "the file has no sample of that number", "samples count from 0");
  std::vector<Vec3f> points(points_);
  std::ifstream in(path_, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(sizeof(Header) +
                                       static_cast<std::uint64_t>(sample) * sample_bytes(points_)));
  in.read(reinterpret_cast<char*>(points.data()), static_cast<std::streamsize>(sample_bytes(points_)));
  if (!in) {
    throw Error(ErrorKind::file, {path_.string()}, "cannot read sample " + std::to_string(sample),
                "run the scene again");
  }
  return points;
}

void write_pc2(const fs::path& path, int frames, std::size_t points, const FramePoints& at) {
  WholeFile out(path);
  Header header;
  header.points = as_int32(points, path);
  header.samples = frames;
  out.append(&header, sizeof header);
  for (int frame = 0; frame < frames; ++frame) {
    const std::vector<Vec3f> sample = at(frame);
    out.append(sample.data(), sample_bytes(sample.size()));
  }
  out.commit();
}

namespace {

void append_big_endian(WholeFile& out, const void* data, std::size_t count) {
  std::vector<std::uint32_t> words(count);
  std::memcpy(words.data(), data, count * 4);
  for (std::uint32_t& word : words) word = __builtin_bswap32(word);
  out.append(words.data(), count * 4);
}

}  // namespace

void write_mdd(const fs::path& path, int frames, std::size_t points, double frame_rate,
               const FramePoints& at) {
  WholeFile out(path);
  const std::array<std::int32_t, 2> counts = {frames, as_int32(points, path)};
  append_big_endian(out, counts.data(), 2);
  std::vector<float> times;
  for (int frame = 0; frame < frames; ++frame) times.push_back(static_cast<float>(frame / frame_rate));
  append_big_endian(out, times.data(), times.size());
  for (int frame = 0; frame < frames; ++frame) {
    const std::vector<Vec3f> sample = at(frame);
    append_big_endian(out, sample.data(), 3 * sample.size());
  }
  out.commit();
}

}  // namespace muslin
