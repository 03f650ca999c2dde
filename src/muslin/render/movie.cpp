#include "muslin/render/movie.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "muslin/core/error.hpp"
#include "muslin/render/child_process.hpp"

namespace muslin {
namespace fs = std::filesystem;
namespace {

int even(int side) { return side + side % 2; }

fs::path part_of(const fs::path& path) {
  return path.parent_path() / fmt::format(".{}.part", path.filename().string());
}

std::vector<std::string> command(const fs::path& part, int width, int height, const MovieOptions& options) {
  if (!(options.frame_rate > 0 && options.frame_rate <= 1000))
    throw Error(ErrorKind::usage, fmt::format("a frame rate of {}", options.frame_rate),
                "give frames per second, such as 24");
  if (options.quality < 0 || options.quality > 51)
    throw Error(ErrorKind::usage, fmt::format("a movie quality of {}", options.quality),
                "give a number from 0 (lossless) to 51");
  // A fixed number of threads, since x264's choice of bits depends on it.
  return {options.program, "-hide_banner", "-loglevel", "error", "-nostdin", "-y",
          // input: raw pictures from standard input
          "-f", "rawvideo", "-pixel_format", "rgb24", "-video_size",
          fmt::format("{}x{}", even(width), even(height)), "-framerate",
          fmt::format("{:.6g}", options.frame_rate), "-i", "pipe:0",
          // output: playable everywhere, with colour tags
          "-vf", "scale=out_color_matrix=bt709:out_range=tv", "-c:v", "libx264", "-preset", "medium", "-crf",
          std::to_string(options.quality), "-threads", "4", "-pix_fmt", "yuv420p", "-color_primaries",
          "bt709", "-color_trc", "bt709", "-colorspace", "bt709", "-color_range", "tv", "-fflags",
          "+bitexact", "-movflags", "+faststart", "-f", "mp4", "file:" + part.string()};
}

/// The rows with both sides made even.
std::vector<std::uint8_t> even_pixels(const Image& image) {
  std::vector<std::uint8_t> pixels;
  pixels.reserve(3 * static_cast<std::size_t>(even(image.width)) *
                 static_cast<std::size_t>(even(image.height)));
  for (int y = 0; y < even(image.height); ++y) {
    const int row = std::min(y, image.height - 1);
    const auto* first = image.pixel(0, row);
    pixels.insert(pixels.end(), first, first + 3 * image.width);
    const auto* last = image.pixel(image.width - 1, row);
    if (image.width % 2 == 1) pixels.insert(pixels.end(), last, last + 3);
  }
  return pixels;
}

}  // namespace

struct Movie::Process {
  Process(const fs::path& path, int width, int height, const MovieOptions& options)
      : path(path),
        part(part_of(path)),
        width(width),
        height(height),
        ffmpeg(command(part, width, height, options),
               "install it (apt install ffmpeg), or write the frames as PNG files by giving a folder") {}
  ~Process() {
    if (finished) return;
    ffmpeg.kill();  // first, so that it cannot write the file again
    std::error_code ignored;
    fs::remove(part, ignored);
  }

  [[noreturn]] void fail() {
    ffmpeg.wait();
    const std::string errors = ffmpeg.errors();
    throw Error(ErrorKind::file, {path.string()},
                "ffmpeg stopped: " + (errors.empty() ? "it gave no reason" : errors),
                "check the folder, the space left and that ffmpeg has libx264");
  }

  fs::path path, part;
  int width, height;
  int frames = 0;
  bool finished = false;
  ChildProcess ffmpeg;
};

Movie::Movie(const fs::path& path, int width, int height, const MovieOptions& options) {
  const Image probe(width, height);  // checks the size
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (access(folder.c_str(), W_OK) != 0)
    throw Error(ErrorKind::file, {path.string()}, std::string("cannot write here: ") + std::strerror(errno),
                "choose a folder that exists and can be written");
  process_ = std::make_unique<Process>(path, probe.width, probe.height, options);
}

Movie::~Movie() = default;

void Movie::add(const Image& image) {
  Process& process = *process_;
  if (image.width != process.width || image.height != process.height)
    throw Error(ErrorKind::usage,
                fmt::format("a frame of {}×{} in a movie of {}×{}", image.width, image.height, process.width,
                            process.height),
                "draw all frames in one size");
  if (!process.ffmpeg.send(even_pixels(image))) process.fail();
  ++process.frames;
}

void Movie::finish() {
  Process& process = *process_;
  if (process.frames == 0)
    throw Error(ErrorKind::usage, {process.path.string()}, "a movie without frames", "draw at least one");
  if (!process.ffmpeg.wait()) process.fail();
  std::error_code code;
  fs::rename(process.part, process.path, code);
  if (code)
    throw Error(ErrorKind::file, {process.path.string()}, "cannot write: " + code.message(),
                "choose a place that can be written");
  process.finished = true;
}

void write_movie(const fs::path& path, int count, const std::function<Image(int)>& draw,
                 const MovieOptions& options, const Progress& progress) {
  std::unique_ptr<Movie> movie;
  for (int frame = 0; frame < count; ++frame) {
    progress.at(static_cast<double>(frame) / count, "drawing the movie");
    const Image image = draw(frame);
    if (!movie) movie = std::make_unique<Movie>(path, image.width, image.height, options);
    movie->add(image);
  }
  if (!movie) throw Error(ErrorKind::usage, {path.string()}, "a movie without frames", "draw at least one");
  movie->finish();
  progress.at(1, "drawing the movie");
}

void write_frames(const fs::path& folder, int count, const std::function<Image(int)>& draw,
                  const Progress& progress) {
  std::error_code code;
  fs::create_directories(folder, code);
  if (code)
    throw Error(ErrorKind::file, {folder.string()}, "cannot make this folder: " + code.message(),
                "choose another place");
  for (int frame = 0; frame < count; ++frame) {
    progress.at(static_cast<double>(frame) / count, "drawing frames");
    write_png(folder / fmt::format("frame_{:04}.png", frame), draw(frame));
  }
  progress.at(1, "drawing frames");
}

}  // namespace muslin
