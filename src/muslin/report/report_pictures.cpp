#include "muslin/report/report_pictures.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "muslin/core/progress_part.hpp"
#include "muslin/picture/run_pictures.hpp"

namespace muslin {
namespace {

constexpr int picture_width = 800, picture_height = 450;  // pixels
constexpr std::size_t max_balls = 200;

/// Balls at these places, of a size that suits the bodies at this frame.
std::vector<Marker> balls(const RunReader& run, int frame, const std::vector<Vec3>& places) {
  Box bounds;
  for (int body = 0; body < static_cast<int>(run.bodies().size()); ++body)
    if (!run.is_plane(body))
      for (const Vec3f& point : run.points(body, SurfaceKind::skin, frame))
        bounds.extend(point.cast<double>());
  std::vector<Marker> markers;
  for (std::size_t i = 0; i < std::min(places.size(), max_balls); ++i) {
    Marker ball;
    ball.position = places[i];
    ball.radius = 0.012 * bounds.diagonal().norm();
    ball.colour = Vec3(0.95, 0.1, 0.1);
    markers.push_back(ball);
  }
  return markers;
}

}  // namespace

std::vector<ReportPicture> draw_report_pictures(const RunReader& run, const RunReport& report,
                                                const Progress& progress) {
  const RunEvidence& evidence = report.evidence;
  const int frames = run.frame_count();
  const auto time = [&](int frame) {
    return fmt::format("frame {}, {:.4g} s", frame, frame / run.frame_rate());
  };
  std::vector<ReportPicture> pictures;
  if (frames == 0) return pictures;
  PictureOptions options;
  options.render = {.width = picture_width, .height = picture_height, .samples = 4};
  RunPictures plain(RunReader(run.directory()), options, progress_part(progress, 0, 0.2));
  const auto add = [&](RunPictures& from, int frame, const std::string& what,
                       const std::vector<Vec3>& places) {
    if (!evidence.is_finite(frame)) return;
    progress.at(&from == &plain ? 0.2 + 0.1 * static_cast<double>(pictures.size()) : 0.8, "drawing");
    pictures.push_back(
        {fmt::format("{}: {}", what, time(frame)), encode_png(from.draw(frame, balls(run, frame, places)))});
  };
  add(plain, 0, "Start", {});
  if (frames > 2) add(plain, frames / 2, "Middle", {});
  if (frames > 1) add(plain, frames - 1, "End", {});
  if (!evidence.crossing_frames.empty()) {
    const CrossingFrame& first = evidence.crossing_frames.front();
    add(plain, first.frame, "First crossings, at the balls", first.at);
  }
  if (evidence.frame_of_stretch) {
    options.stretch = true;
    RunPictures coloured(RunReader(run.directory()), options, progress_part(progress, 0.6, 0.8));
    std::vector<Vec3> place;
    if (evidence.stretch) place.push_back(evidence.stretch->at);
    add(coloured, *evidence.frame_of_stretch,
        place.empty() ? "Largest stretch" : "Largest stretch, at the ball", place);
  }
  return pictures;
}

}  // namespace muslin
