#include "picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace muslin::app {
namespace {

const std::array<Vec3, 5> body_colours = {Vec3(0.72, 0.20, 0.17), Vec3(0.16, 0.42, 0.62),
                                          Vec3(0.82, 0.60, 0.20), Vec3(0.30, 0.52, 0.32),
                                          Vec3(0.50, 0.34, 0.58)};

/// The edges of a mesh at rest: what stretch is measured on.
class EdgeStretch {
 public:
  explicit EdgeStretch(const Mesh& mesh) {
    std::map<std::pair<int, int>, double> edges;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
      const auto corners = mesh.face(f);
      for (std::size_t c = 0; c < corners.size(); ++c) {
        const int a = std::min(corners[c], corners[(c + 1) % corners.size()]);
        const int b = std::max(corners[c], corners[(c + 1) % corners.size()]);
        const double length =
            (mesh.positions[static_cast<std::size_t>(a)] - mesh.positions[static_cast<std::size_t>(b)])
                .norm();
        if (length > 0) edges[{a, b}] = length;
      }
    }
    edges_.assign(edges.begin(), edges.end());
  }

  /// Per vertex, the largest stretch of its edges in percent of the rest length; compression counts as 0.
  std::vector<double> at(ConstVectors x) const {
    std::vector<double> stretch(x.size(), 0.0);
    for (const auto& [ends, rest] : edges_) {
      const auto a = static_cast<std::size_t>(ends.first), b = static_cast<std::size_t>(ends.second);
      const double percent = 100 * ((x[a] - x[b]).norm() / rest - 1);
      stretch[a] = std::max(stretch[a], percent);
      stretch[b] = std::max(stretch[b], percent);
    }
    return stretch;
  }

 private:
  std::vector<std::pair<std::pair<int, int>, double>> edges_;
};

/// As the scene says, else from the palette.
std::vector<Vec3> colours_of(const RunReader& run) {
  std::vector<Vec3> colours;
  const auto scene = nlohmann::json::parse(run.resolved_scene());
  for (std::size_t b = 0; b < run.bodies().size(); ++b) {
    Vec3 colour = body_colours[b % body_colours.size()];
    if (scene.contains("body") && b < scene["body"].size() && scene["body"][b].contains("colour")) {
      const auto& rgb = scene["body"][b]["colour"];
      colour = Vec3(rgb[0].get<double>(), rgb[1].get<double>(), rgb[2].get<double>());
    }
    colours.push_back(colour);
  }
  return colours;
}

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
  const std::vector<Vec3> colours = colours_of(p.run);
  for (int body : p.bodies) {
    const Mesh& mesh = p.run.mesh(body, options.surface);
    const Vec3& colour = colours[static_cast<std::size_t>(body)];
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
