// Pictures, movies and plots of runs.
#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "callbacks.hpp"
#include "errors.hpp"
#include "paths.hpp"
#include <fmt/format.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "muslin/hosts.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muslin::python {
namespace {

namespace fs = std::filesystem;
using Pixels = Array<std::uint8_t, -1, -1, 3>;

Pixels to_pixels(Image image) {
  const auto height = static_cast<std::size_t>(image.height), width = static_cast<std::size_t>(image.width);
  const auto [kept, owner] = given_away(std::move(image.pixels));
  return Pixels(kept->data(), {height, width, 3}, owner);
}

PictureOptions options_of(const std::string& body, const std::string& surface, bool stretch,
                          std::optional<double> stretch_max, bool ground, std::pair<int, int> size,
                          int samples, double azimuth, double elevation) {
  PictureOptions options;
  options.body = body;
  options.surface = static_cast<SurfaceKind>(choice(surface, {"skin", "contour"}, "surface"));
  options.stretch = stretch || stretch_max;
  options.stretch_max = stretch_max;
  options.ground = ground;
  options.render.width = size.first;
  options.render.height = size.second;
  options.render.samples = samples;
  options.camera.azimuth = azimuth;
  options.camera.elevation = elevation;
  return options;
}

void render(RunPictures& pictures, const fs::path& path, std::optional<int> frame, const Progress& progress) {
  const auto draw = [&](int number) { return pictures.draw(number); };
  const std::string suffix = path.extension().string();
  if (path.has_parent_path()) fs::create_directories(path.parent_path());
  if (suffix == ".png") return write_png(path, draw(frame.value_or(pictures.frame_count() - 1)));
  if (suffix == ".mp4") {
    MovieOptions movie;
    movie.frame_rate = pictures.frame_rate();
    return write_movie(path, pictures.frame_count(), draw, movie, progress);
  }
  if (!suffix.empty()) {
    throw Error(ErrorKind::usage, "cannot write `" + suffix + "` pictures",
                "name a .mp4, a .png or a folder");
  }
  write_frames(path, pictures.frame_count(), draw, progress);
}

int frame_of(const RunPictures& pictures, int frame) {
  const int at = frame < 0 ? frame + pictures.frame_count() : frame;
  if (at >= 0 && at < pictures.frame_count()) return at;
  throw Error(ErrorKind::usage, fmt::format("the run has no frame {}", frame),
              fmt::format("give a frame from 0 to {}", pictures.frame_count() - 1));
}

}  // namespace

void bind_picture(nb::module_& m) {
  nb::class_<RunPictures>(m, "RunPictures", "Draws frames of a run, all from one camera position.")
      .def(
          "__init__",
          [](RunPictures* self, const FilePath& directory, const std::string& body,
             const std::string& surface, bool stretch, std::optional<double> stretch_max, bool ground,
             std::pair<int, int> size, int samples, double azimuth, double elevation, const Report& progress,
             const Cancel& cancel) {
            const PictureOptions options =
                options_of(body, surface, stretch, stretch_max, ground, size, samples, azimuth, elevation);
            const nb::gil_scoped_release nogil;
            const fs::path& run = directory;
            RunReader reader(run);
            if (reader.frame_count() == 0)
              throw Error(ErrorKind::input, {run.string()}, "the run has no finished frame",
                          "run the scene first");
            new (self) RunPictures(std::move(reader), options, progress_of(progress, cancel));
          },
          "run"_a, nb::kw_only(), "body"_a = "", "surface"_a = "skin", "stretch"_a = false,
          "stretch_max"_a = nb::none(), "ground"_a = true, "size"_a = std::pair(960, 540), "samples"_a = 4,
          "azimuth"_a = 30.0, "elevation"_a = 15.0, "progress"_a = nb::none(), "cancel"_a = nb::none(),
          "run: its directory. body: only this one. stretch: as colours, up to stretch_max [%]. size: width "
          "and\n"
          "height [pixels]. samples: rays a pixel. azimuth, elevation: of the camera [degrees].")
      .def_prop_ro("frame_count", &RunPictures::frame_count)
      .def_prop_ro("frame_rate", &RunPictures::frame_rate, "[1/s]")
      .def(
          "draw",
          [](RunPictures& self, int frame) {
            const int number = frame_of(self, frame);
            Image image;
            {
              const nb::gil_scoped_release nogil;
              image = self.draw(number);
            }
            return to_pixels(std::move(image));
          },
          "frame"_a, "One frame: sRGB bytes, shape (height, width, 3); negative frames count from the end.")
      .def(
          "write",
          [](RunPictures& self, const FilePath& path, std::optional<int> frame, const Report& progress,
             const Cancel& cancel) {
            if (frame) frame = frame_of(self, *frame);
            const nb::gil_scoped_release nogil;
            render(self, path, frame, progress_of(progress, cancel));
          },
          "path"_a, nb::kw_only(), "frame"_a = nb::none(), "progress"_a = nb::none(), "cancel"_a = nb::none(),
          "A .mp4 of all frames (by the program ffmpeg), a .png of one, else the last, or a folder of "
          "frames.");
  nb::class_<ViewReport>(m, "ViewReport", "What a page came to.")
      .def_ro("bytes", &ViewReport::bytes, "Of the page.")
      .def_ro("frames", &ViewReport::frames, "Shown.")
      .def_ro("notes", &ViewReport::notes, "What was left out.");
  m.def(
      "write_view",
      [](const RunReader& run, const FilePath& file, double max_size, const Report& progress,
         const Cancel& cancel) {
        if (!(max_size > 0)) throw Error(ErrorKind::usage, "max_size is not above 0", "give megabytes");
        ViewOptions options;
        options.largest_bytes = static_cast<std::uint64_t>(1e6 * std::min(max_size, 1e6));
        const nb::gil_scoped_release nogil;
        return write_view(run, file, options, progress_of(progress, cancel));
      },
      "run"_a, "file"_a, nb::kw_only(), "max_size"_a = 16.0, "progress"_a = nb::none(),
      "cancel"_a = nb::none(),
      "One HTML page that plays a run in a browser. max_size: of the page [MB]; a larger run is thinned.");
  m.def(
      "write_run_plots", [](const RunReader& run) { write_run_plots(run); }, "run"_a,
      nb::call_guard<nb::gil_scoped_release>(),
      "energy and stretch over time, .svg and .png, in the run directory.");
}

}  // namespace muslin::python
