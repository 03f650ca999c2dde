// Movie writes movies with ffmpeg, which runs as a separate program and is not linked.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "muslin/core/progress.hpp"
#include "muslin/render/image.hpp"

namespace muslin {

struct MovieOptions {
  double frame_rate = 24;  ///< [1/s]
  int quality = 18;        ///< x264's constant rate factor: 0 is lossless, 18 looks lossless, 51 is worst
  std::string program = "ffmpeg";  ///< name or path; looked up in PATH
};

/// An H.264 file (yuv420p, index in front) written frame by frame. It appears under its name when finish()
/// returns; until then it is a hidden file beside it, which is removed if anything fails.
class Movie {
 public:
  /// Starts ffmpeg for pictures of this size (an odd side is widened by repeating the last pixel). Throws
  /// Error(file) if ffmpeg is missing or `path` cannot be written, Error(usage) on bad options.
  Movie(const std::filesystem::path& path, int width, int height, const MovieOptions& options = {});
  ~Movie();
  Movie(const Movie&) = delete;
  Movie& operator=(const Movie&) = delete;

  /// Throws Error(file) with ffmpeg's message if it stopped, Error(usage) on a picture of another size.
  void add(const Image& image);
  /// Waits for ffmpeg and gives the file its name. Throws as add; without any frame, Error(usage).
  void finish();

 private:
  struct Process;
  std::unique_ptr<Process> process_;
};

/// Draws frames 0 … count − 1 and writes them as a movie. Cancelling leaves no file behind.
void write_movie(const std::filesystem::path& path, int count, const std::function<Image(int)>& draw,
                 const MovieOptions& options = {}, const Progress& progress = {});

/// Draws frames 0 … count − 1 into folder/frame_0000.png, …; makes the folder. Frames finished before a
/// cancel stay.
void write_frames(const std::filesystem::path& folder, int count, const std::function<Image(int)>& draw,
                  const Progress& progress = {});

}  // namespace muslin
