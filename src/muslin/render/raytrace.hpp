// Raytracer renders a preview on the CPU: soft sun, sky light with occlusion, cloth seen from both sides,
// contact shadows on a ground that fades into the background. The picture is the same, bit for bit, for any
// thread count.
#pragma once

#include <memory>

#include "muslin/core/progress.hpp"
#include "muslin/render/camera.hpp"
#include "muslin/render/image.hpp"
#include "muslin/render/scene_view.hpp"

namespace muslin {

struct RenderOptions {
  int width = 1280;  ///< [pixels]
  int height = 720;  ///< [pixels]
  int samples = 8;   ///< camera rays per pixel, each with four rays to the sun, 1…4096
  int sky_rays = 8;  ///< rays to the sky per camera ray, 1…1024
};

class Raytracer {
 public:
  /// Throws Error(usage) on options out of range or a surface whose array sizes do not match.
  Raytracer(SceneView scene, const Camera& camera, const RenderOptions& options);
  ~Raytracer();
  Raytracer(const Raytracer&) = delete;
  Raytracer& operator=(const Raytracer&) = delete;

  /// Renders one frame, with label and legend. Throws Error(input) where a position or value is not finite.
  /// Not thread-safe: the frame's vertices are stored in the object.
  Image render(const FrameView& frame, const Progress& progress = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace muslin
