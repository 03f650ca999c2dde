#include "picture.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace muslin::app {
namespace {

std::vector<Vec3> in_double(const std::vector<Vec3f>& points) {
  std::vector<Vec3> result;
  result.reserve(points.size());
  for (const Vec3f& p : points) result.push_back(p.cast<double>());
  return result;
}

/// 1, 2 or 5 times a power of ten, at least `value`.
double round_up(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(std::max(value, 1e-3))));
  for (double digit : {1.0, 2.0, 5.0})
    if (digit * power >= value) return digit * power;
  return 10 * power;
}

}  // namespace

struct RunPictures::Parts {
  Parts(RunReader reader, const PictureOptions& picture_options)
      : run(std::move(reader)), options(picture_options) {}

  RunReader run;
  PictureOptions options;
  std::vector<int> bodies;
  std::vector<EdgeStretch> stretch;
  std::unique_ptr<Raytracer> tracer;

  std::vector<Vec3> points(int body, int frame) const {
    return in_double(run.points(body, options.surface, frame));
  }
};

RunPictures::RunPictures(RunReader run, const PictureOptions& options, const Progress& progress)
    : parts_(std::make_unique<Parts>(std::move(run), options)) {
  Parts& p = *parts_;
  if (options.body.empty())
    for (std::size_t b = 0; b < p.run.bodies().size(); ++b) p.bodies.push_back(static_cast<int>(b));
  else
    p.bodies.push_back(p.run.find_body(options.body));
  SceneView scene;
  for (int body : p.bodies) {
    const Mesh& mesh = p.run.mesh(body, options.surface);
    const Vec3 colour = p.run.colour(body);
    scene.surfaces.push_back(make_surface(mesh, is_closed(mesh) ? solid_look(colour) : fabric_look(colour)));
    if (options.stretch) p.stretch.emplace_back(mesh);
  }
  CameraFit fit(options.camera, static_cast<double>(options.render.width) / options.render.height);
  double largest_stretch = 0;
  Box bounds;
  for (int frame = 0; frame < frame_count(); ++frame) {
    progress.at(static_cast<double>(frame) / frame_count(), "looking for the view");
    for (std::size_t b = 0; b < p.bodies.size(); ++b) {
      const std::vector<Vec3> x = p.points(p.bodies[b], frame);
      fit.add(x);
      for (const Vec3& point : x) bounds.extend(point);
      if (options.stretch)
        for (double percent : p.stretch[b].at(x)) largest_stretch = std::max(largest_stretch, percent);
    }
  }
  if (options.ground) scene.ground = bounds.min().y() - 0.02 * bounds.diagonal().norm();
  if (options.stretch) {
    ColourScale scale;
    scale.high = options.stretch_max ? *options.stretch_max : round_up(largest_stretch);
    scale.label = "stretch [%]";
    scene.colour_scale = scale;
  }
  p.tracer = std::make_unique<Raytracer>(std::move(scene), fit.camera(), options.render);
}

RunPictures::~RunPictures() = default;

int RunPictures::frame_count() const { return parts_->run.frame_count(); }

double RunPictures::frame_rate() const { return parts_->run.frame_rate(); }

Image RunPictures::draw(int frame) {
  Parts& p = *parts_;
  std::vector<std::vector<Vec3>> positions;
  std::vector<std::vector<double>> values;
  FrameView view;
  for (std::size_t b = 0; b < p.bodies.size(); ++b) {
    positions.push_back(p.points(p.bodies[b], frame));
    values.push_back(p.options.stretch ? p.stretch[b].at(positions.back()) : std::vector<double>());
  }
  for (std::size_t b = 0; b < p.bodies.size(); ++b) view.surfaces.push_back({positions[b], values[b]});
  view.label = fmt::format("{}   {:.2f} s", p.run.title(), frame / p.run.frame_rate());
  return p.tracer->render(view);
}

void write_run_plots(const RunReader& run) {
  std::vector<double> time, kinetic, elastic, potential, work, dissipated, stretch;
  for (const Diagnostics& row : run.diagnostics()) {
    time.push_back(row.time);
    kinetic.push_back(row.kinetic);
    elastic.push_back(row.elastic);
    potential.push_back(row.potential);
    work.push_back(row.work);
    dissipated.push_back(row.dissipated);
    stretch.push_back(row.max_stretch);
  }
  const Plot energies = energy_plot(time, kinetic, elastic, potential, work, dissipated);
  const Plot stretches = stretch_plot(time, stretch);
  for (const char* suffix : {".svg", ".png"}) {
    write_plot(run.directory() / (std::string("energy") + suffix), energies);
    write_plot(run.directory() / (std::string("stretch") + suffix), stretches);
  }
}

}  // namespace muslin::app
