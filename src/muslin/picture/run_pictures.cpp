#include "muslin/picture/run_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "muslin/geometry/thicken.hpp"
#include "muslin/picture/cords.hpp"
#include "muslin/render/plot.hpp"
#include "muslin/render/scene_view.hpp"
#include "muslin/scene/colours.hpp"
#include "muslin/surface/edge_stretch.hpp"

namespace muslin {
namespace {

std::vector<Vec3> in_double(const std::vector<Vec3f>& points) {
  std::vector<Vec3> result;
  result.reserve(points.size());
  for (const Vec3f& p : points) result.push_back(p.cast<double>());
  return result;
}

/// Returns 1, 2 or 5 times a power of ten, at least `value`.
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
  std::optional<Cords> cords;
  std::unique_ptr<Raytracer> tracer;

  Look look(int body, const Mesh& mesh) const {
    const Vec3 colour = run.colour(body);
    if (run.is_collider(body)) {
      Look look = prop_look();
      look.colour = colour;
      return look;
    }
    return is_closed(mesh) ? solid_look(colour) : fabric_look(colour);
  }
  /// Returns the surface to show: if all bodies are shown, the skin for those without the chosen one.
  SurfaceKind surface(int body) const {
    return options.body.empty() && !run.has(body, options.surface) ? SurfaceKind::skin : options.surface;
  }
  std::vector<Vec3> points(int body, int frame) const {
    return in_double(run.points(body, surface(body), frame));
  }

  /// Returns the height of a static plane that serves as floor, which is drawn unbounded.
  std::optional<double> floor_height(int body) const {
    if (!run.is_plane(body)) return std::nullopt;
    const Mesh& mesh = run.mesh(body, SurfaceKind::skin);
    const Vec3 normal = newell_normal(mesh.positions, mesh.face(0)).normalized();
    const std::vector<Vec3> first = points(body, 0), last = points(body, run.frame_count() - 1);
    const bool still = run.frame_count() > 0 && first == points(body, run.frame_count() / 2) && first == last;
    if (!still || normal.y() < 1 - 1e-9) return std::nullopt;
    return first.front().y();
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
  if (options.ground && options.body.empty()) {
    for (const int body : p.bodies)
      if (const auto height = p.floor_height(body))
        scene.ground = std::max(*height, scene.ground.value_or(*height));
    if (scene.ground) std::erase_if(p.bodies, [&](int body) { return p.floor_height(body).has_value(); });
  }
  for (int body : p.bodies) {
    const Mesh& mesh = p.run.mesh(body, p.surface(body));
    scene.surfaces.push_back(make_surface(mesh, p.look(body, mesh)));
    if (options.stretch) p.stretch.emplace_back(mesh);
  }
  CameraFit fit(options.camera, static_cast<double>(options.render.width) / options.render.height);
  double largest_stretch = 0;
  Box bounds;
  for (int frame = 0; frame < frame_count(); ++frame) {
    progress.at(static_cast<double>(frame) / frame_count(), "looking for the view");
    for (std::size_t b = 0; b < p.bodies.size(); ++b) {
      const std::vector<Vec3> x = p.points(p.bodies[b], frame);
      // A plane is unbounded; the camera frames the objects on it.
      if (!p.run.is_plane(p.bodies[b]) || p.bodies.size() == 1) {
        fit.add(x);
        for (const Vec3& point : x) bounds.extend(point);
      }
      if (options.stretch && !p.run.is_collider(p.bodies[b]))
        for (double percent : p.stretch[b].at(x)) largest_stretch = std::max(largest_stretch, percent);
    }
  }
  if (options.ground && !scene.ground) scene.ground = bounds.min().y() - 0.02 * bounds.diagonal().norm();
  if (options.stretch) {
    ColourScale scale;
    scale.high = options.stretch_max ? *options.stretch_max : round_up(largest_stretch);
    scale.label = "stretch [%]";
    scene.colour_scale = scale;
  }
  if (options.body.empty() && !p.run.selections().cords.empty() && frame_count() > 0) {
    p.cords.emplace(p.run, 0.0018 * bounds.diagonal().norm());
    scene.surfaces.push_back(p.cords->surface());
  }
  p.tracer = std::make_unique<Raytracer>(std::move(scene), fit.camera(), options.render);
}

RunPictures::~RunPictures() = default;

int RunPictures::frame_count() const { return parts_->run.frame_count(); }

double RunPictures::frame_rate() const { return parts_->run.frame_rate(); }

Image RunPictures::draw(int frame, const std::vector<Marker>& markers) {
  Parts& p = *parts_;
  std::vector<std::vector<Vec3>> positions;
  std::vector<std::vector<double>> values;
  FrameView view;
  for (std::size_t b = 0; b < p.bodies.size(); ++b) {
    positions.push_back(p.points(p.bodies[b], frame));
    const bool coloured = p.options.stretch && !p.run.is_collider(p.bodies[b]);
    values.push_back(coloured ? p.stretch[b].at(positions.back()) : std::vector<double>());
  }
  for (std::size_t b = 0; b < p.bodies.size(); ++b) view.surfaces.push_back({positions[b], values[b]});
  const std::vector<Vec3> cords = p.cords ? p.cords->points(frame) : std::vector<Vec3>();
  if (p.cords) view.surfaces.push_back({cords, {}});
  view.markers = markers;
  view.label = fmt::format("{}   {:.2f} s", p.run.title(), frame / p.run.frame_rate());
  return p.tracer->render(view);
}

namespace {

/// The components of a model at the start, and a camera that sees them.
struct StartView {
  explicit StartView(const Model& model)
      : model(model), fit({}, static_cast<double>(render.width) / render.height) {
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
      const Component& body = model.bodies[b];
      const Vec3 colour = colour_of(body, b);
      Look look = body.is_collider() ? prop_look() : body.sheet ? fabric_look(colour) : solid_look(colour);
      look.colour = colour;
      scene.surfaces.push_back(make_surface(body.mesh, look));
      view.surfaces.push_back({body.mesh.positions, {}});
      if (body.appearance().unbounded) continue;
      fit.add(body.mesh.positions);
      bounds.extend(body.mesh.bounds());
    }
  }
  Image draw() { return Raytracer(std::move(scene), fit.camera(), render).render(view); }

  const Model& model;
  const RenderOptions render = PictureOptions().render;
  SceneView scene;
  FrameView view;
  CameraFit fit;
  Box bounds;
};

/// Draws the numbers that a map gives to the body with this index.
Image draw_map(const Model& model, std::size_t body, const MappedNumber& map) {
  std::vector<double> numbers;
  numbers.reserve(map.weights.size());
  for (std::size_t v = 0; v < map.weights.size(); ++v) numbers.push_back(map.at(v));
  StartView start(model);
  ColourScale scale;
  scale.low = *std::min_element(numbers.begin(), numbers.end());
  scale.high = *std::max_element(numbers.begin(), numbers.end());
  scale.label = map.unit.empty() ? map.variation.key : fmt::format("{} [{}]", map.variation.key, map.unit);
  start.scene.colour_scale = scale;
  start.view.surfaces[body].values = numbers;
  start.view.label = fmt::format("{}   by {}", model.bodies[body].name, map.variation.map);
  return start.draw();
}

/// Puts pictures of one width below each other.
Image stacked(const std::vector<Image>& images) {
  Image all(images.front().width, images.front().height * static_cast<int>(images.size()));
  all.pixels.clear();
  for (const Image& image : images)
    all.pixels.insert(all.pixels.end(), image.pixels.begin(), image.pixels.end());
  return all;
}

}  // namespace

Image draw_start(const Model& model, const std::vector<Crossing>& crossings) {
  constexpr std::size_t max_balls = 500, max_panels = 16;
  StartView start(model);
  Marker ball;
  ball.radius = 0.012 * start.bounds.diagonal().norm();
  ball.colour = Vec3(0.95, 0.1, 0.1);
  for (std::size_t i = 0; i < std::min(crossings.size(), max_balls); ++i) {
    ball.position = crossings[i].at;
    start.view.markers.push_back(ball);
  }
  start.view.label = fmt::format("{}   {} crossings", model.scene.title, crossings.size());
  std::vector<Image> panels = {start.draw()};
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    for (const MappedNumber& map : model.bodies[b].maps)
      if (panels.size() < max_panels) panels.push_back(draw_map(model, b, map));
  return stacked(panels);
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

}  // namespace muslin
