// Makes pictures and plots from a run directory.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "muslin/cache/run_reader.hpp"
#include "muslin/contact/crossings.hpp"
#include "muslin/core/progress.hpp"
#include "muslin/render/camera.hpp"
#include "muslin/render/image.hpp"
#include "muslin/render/raytrace.hpp"
#include "muslin/render/scene_view.hpp"
#include "muslin/scene/model.hpp"

namespace muslin {

struct PictureOptions {
  std::string body;  ///< empty: all
  SurfaceKind surface = SurfaceKind::skin;
  bool stretch = false;               ///< stretch as colours
  std::optional<double> stretch_max;  ///< [%] upper end of the colour scale
  bool ground = true;
  CameraOptions camera;
  RenderOptions render = {.width = 960, .height = 540, .samples = 4};
};

/// Draws frames of one run, all from one camera position.
class RunPictures {
 public:
  /// Finds the camera position from all frames. Errors: usage, for options out of range; file; interrupted.
  RunPictures(RunReader run, const PictureOptions& options, const Progress& progress);
  ~RunPictures();
  int frame_count() const;
  double frame_rate() const;
  /// `markers`: balls to show places.
  Image draw(int frame, const std::vector<Marker>& markers = {});

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Draws the start of a scene, with a red ball wherever surfaces cross, and below it a panel for each of the
/// first 15 maps, coloured by the number.
Image draw_start(const Model& model, const std::vector<Crossing>& crossings);

/// Writes energy.svg, energy.png, stretch.svg, stretch.png to the run directory.
void write_run_plots(const RunReader& run);

}  // namespace muslin
