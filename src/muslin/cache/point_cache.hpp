// Reads and writes point caches: one position per point and frame, for points of fixed number and order.
//
// PC2 (little-endian): "POINTCACHE2\0", int32 version 1, int32 points, float32 start, float32 rate, int32
// samples, then per sample float32 xyz of every point. start = 0, rate = 1: one sample per frame. MDD
// (big-endian): int32 frames, int32 points, float32 time of each frame [s], then float32 xyz.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/core/output_file.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

/// Single precision, as caches store it.
using Vec3f = Eigen::Vector3f;

/// Writes a PC2 file sample by sample; its header never counts a sample that is not yet written.
class MUSLIN_API Pc2Writer {
 public:
  Pc2Writer() = default;
  /// Opens a new file or, with Mode::resume, an existing one whose first `samples` samples are kept. Errors:
  /// file; input, if the existing file has another number of points or fewer samples.
  Pc2Writer(const std::filesystem::path& path, std::size_t points, OutputFile::Mode mode, int samples = 0);

  int samples() const { return samples_; }
  void append(ConstVectors points);  ///< [m]; rounded to float32
  void append(const std::vector<Vec3f>& points);
  void sync() { file_.sync(); }
  void close() { file_.close(); }

 private:
  void write_sample_count();
  OutputFile file_;
  std::size_t points_ = 0;
  int samples_ = 0;
};

/// Reads samples of a PC2 file in any order. A truncated file provides its complete samples.
class MUSLIN_API Pc2Reader {
 public:
  /// Errors: file; input, if it is not a PC2 file.
  explicit Pc2Reader(std::filesystem::path path);

  std::size_t points() const { return points_; }
  int samples() const { return samples_; }
  std::vector<Vec3f> read(int sample) const;  ///< [m]; Error(file) if it cannot be read

 private:
  std::filesystem::path path_;
  std::size_t points_ = 0;
  int samples_ = 0;
};

/// Points of one frame.
using FramePoints = std::function<std::vector<Vec3f>(int frame)>;

/// Writes `frames` frames at frame/frame_rate seconds; the file appears when it is complete. Errors: file.
MUSLIN_API void write_pc2(const std::filesystem::path& path, int frames, std::size_t points,
                          const FramePoints& at);
MUSLIN_API void write_mdd(const std::filesystem::path& path, int frames, std::size_t points,
                          double frame_rate, const FramePoints& at);

}  // namespace muslin
