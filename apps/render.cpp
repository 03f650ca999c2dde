// muslin render RUN
#include <filesystem>
#include <memory>

#include "command.hpp"
#include "progress_line.hpp"
#include <fmt/format.h>

#include "muslin/hosts.hpp"

namespace muslin::app {
namespace {

struct RenderArguments {
  std::string run, output, surface = "skin", size = "960x540";
  int frame = -1;
  int threads = 0;
  bool quiet = false, no_ground = false;
  double stretch_max = 0;
  PictureOptions picture;
};

void parse_size(const std::string& text, RenderOptions& options) {
  int used = 0;
  if (std::sscanf(text.c_str(), "%dx%d%n", &options.width, &options.height, &used) != 2 ||
      used != static_cast<int>(text.size()))
    throw Error(ErrorKind::usage, "--size: '" + text + "' is not WIDTHxHEIGHT", "write for example 1280x720");
}

void render(RenderArguments arguments) {
  namespace fs = std::filesystem;
  listen_for_interrupts();
  set_thread_count(arguments.threads);
  parse_size(arguments.size, arguments.picture.render);
  arguments.picture.surface = arguments.surface == "contour" ? SurfaceKind::contour : SurfaceKind::skin;
  arguments.picture.ground = !arguments.no_ground;
  if (arguments.stretch_max > 0) {
    arguments.picture.stretch = true;
    arguments.picture.stretch_max = arguments.stretch_max;
  }
  const fs::path output =
      arguments.output.empty() ? fs::path(arguments.run) / "movie.mp4" : fs::path(arguments.output);
  const std::string suffix = output.extension().string();
  if (!suffix.empty() && suffix != ".mp4" && suffix != ".png")
    throw Error(ErrorKind::usage, "cannot write '" + suffix + "' pictures",
                "name a .mp4, a .png or a folder");
  RunReader reader(arguments.run);
  const int count = reader.frame_count();
  if (count == 0)
    throw Error(ErrorKind::input, {arguments.run}, "the run has no finished frame", "run the scene first");
  const bool one = suffix == ".png";
  if (arguments.frame >= count)
    throw Error(ErrorKind::usage, fmt::format("the run has no frame {}", arguments.frame),
                fmt::format("choose from 0 to {}", count - 1));
  ProgressLine line(arguments.quiet);
  const Progress progress = line.progress();
  RunPictures pictures(std::move(reader), arguments.picture, progress);
  const auto draw = [&](int frame) { return pictures.draw(frame); };
  if (output.has_parent_path()) fs::create_directories(output.parent_path());
  if (one) {
    write_png(output, draw(arguments.frame >= 0 ? arguments.frame : count - 1));
  } else if (suffix == ".mp4") {
    MovieOptions movie;
    movie.frame_rate = pictures.frame_rate();
    write_movie(output, count, draw, movie, progress);
  } else {
    write_frames(output, count, draw, progress);
  }
  line.finish();
  if (!arguments.quiet) print(output.string() + "\n");
}

}  // namespace

void add_render(CLI::App& program) {
  auto* command = program.add_subcommand("render", "draw a run: a movie, frames, or one picture");
  auto a = std::make_shared<RenderArguments>();
  command->add_option("RUN", a->run, "run directory")->required();
  command->add_option("-o,--output", a->output,
                      "FILE.mp4, FILE.png or a folder of frames (default: RUN/movie.mp4)");
  command->add_option("--frame", a->frame, "the frame of a .png (default: the last)")
      ->check(non_negative_integer());
  command->add_option("--body", a->picture.body, "only this body");
  command->add_option("--surface", a->surface, "skin (default) or contour")
      ->check(CLI::IsMember({"skin", "contour"}));
  command->add_flag("--stretch", a->picture.stretch, "show stretch as colours");
  command->add_option("--stretch-max", a->stretch_max, "upper end of the stretch colours [%]")
      ->check(positive_number());
  command->add_option("--size", a->size, "WIDTHxHEIGHT in pixels (default: 960x540)");
  command->add_option("--samples", a->picture.render.samples, "rays per pixel (default: 4)")
      ->check(positive_integer());
  command->add_option("--azimuth", a->picture.camera.azimuth,
                      "camera, degrees from +z towards +x (default: 30)");
  command->add_option("--elevation", a->picture.camera.elevation,
                      "camera, degrees above the horizon (default: 15)");
  command->add_flag("--no-ground", a->no_ground, "do not draw the ground");
  command->add_option("--threads", a->threads, "threads (default: one per core)")
      ->check(non_negative_integer());
  command->add_flag("--quiet", a->quiet, "no progress");
  command->callback([a] { render(*a); });
}

}  // namespace muslin::app
