#include "muslin/fit/drape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <vector>

#include "muslin/geometry/mesh.hpp"
#include "muslin/geometry/triangulated_strip.hpp"
#include "muslin/geometry/weld.hpp"
#include "muslin/scene/model.hpp"
#include "muslin/scene/scene.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

constexpr double tau = 2 * std::numbers::pi;

/// In the test the table around the support is lowered: the weight of the cloth grows over so many seconds,
/// in which folds grow into the shape of least energy. Cloth that falls stays in small, uneven folds. Damping
/// brings it to rest; the shape at rest does not depend on it. The cloth does not touch itself: it hangs in
/// open folds. Its material is replaced, so that no material of the library is named, whose limit of stretch
/// would remain.
constexpr const char* drape_scene = R"(
[time]
frame_rate = 24
duration = 12
[[body]]
name = "cloth"
mesh = "cloth"
model = "shell"
warp = [1, 0, 0]
material = { areal_density = 0.1, membrane_warp = 1000, bending_warp = 1e-5 }
contact = false
[[pin]]
where = { group = "held" }
[[force]]
type = "gravity"
keyframes = [{ time = 0, value = [0, -0.49, 0] }, { time = 6, value = [0, -9.80665, 0] }]
)";
constexpr double settling = 4;        // mass damping [1/s]
constexpr int first_look = 156;       // frame after which the cloth may be at rest
constexpr double at_rest = 1e-6;      // kinetic energy over what the cloth gains by its fall
constexpr double unevenness = 0.002;  // of the start over the overhang [m]
constexpr double prominence = 0.1;    // of a fold over the overhang

/// A ring of cloth from one row inside of the edge of the support to its own edge, level at y = 0. Both rows
/// of the support are the group `held`: a clamp.
struct Ring {
  Ring(const DrapeTest& test, const DrapeOptions& options)
      : inner(test.support_diameter / 2), width((test.specimen_diameter - test.support_diameter) / 2) {
    const double cell = width / options.rings;
    // Cells in the middle of the overhang are square.
    const int sectors = 4 * static_cast<int>(std::round(tau * (inner + width / 2) / cell / 4));
    const double strip_width = static_cast<double>(options.rings) / sectors;
    Mesh strip = triangulated_strip(options.mesh, sectors, strip_width, false);
    // The first vertices of the strip are those of its straight edge y = 0, which becomes that of the
    // support.
    const int more = static_cast<int>(strip.vertex_count());
    strip.positions.reserve(strip.vertex_count() + static_cast<std::size_t>(sectors) + 1);
    for (int i = 0; i <= sectors; ++i)
      strip.positions.emplace_back(strip.positions[static_cast<std::size_t>(i)] - Vec3(0, 1.0 / sectors, 0));
    for (int i = 0; i < sectors; ++i) strip.add_face(std::array{more + i, more + i + 1, i + 1, i});
    for (Vec3& p : strip.positions) {
      const double radius = inner + width * p.y() / strip_width, angle = tau * p.x();
      p = {radius * std::cos(angle), 0, radius * std::sin(angle)};
    }
    mesh = weld(strip, 1e-3 * cell).mesh;
    MeshGroup held{"held", {}, {}};
    held.vertices.reserve(2 * static_cast<std::size_t>(sectors));
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
      if (mesh.positions[v].norm() < inner + 1e-3 * cell) held.vertices.push_back(static_cast<int>(v));
    mesh.groups.push_back(held);
  }

  double inner, width;
  Mesh mesh;
};

/// The start of a drop: waves of 2 to 9 folds around, whose phases differ from drop to drop.
std::vector<Vec3> uneven(const Ring& ring, int drop) {
  std::vector<Vec3> positions = ring.mesh.positions;
  for (Vec3& p : positions) {
    const double angle = std::atan2(p.z(), p.x());
    const double share = std::max(0.0, (std::hypot(p.x(), p.z()) - ring.inner) / ring.width);
    double wave = 0;
    for (int folds = 2; folds <= 9; ++folds)
      wave += std::cos(folds * angle + tau * std::fmod(0.618034 * (8 * drop + folds) * folds, 1.0));
    p.y() += unevenness * share * share * wave / 8;
  }
  return positions;
}

/// The outline of the shadow: the farthest point of the cloth in every direction from the middle.
std::vector<double> outline_of(const Ring& ring, const std::vector<Vec3>& positions) {
  constexpr int directions = 720;
  std::vector<double> farthest(directions, ring.inner);
  const auto spread = [&](int v, int w) {
    const Vec2 a(positions[static_cast<std::size_t>(v)].x(), positions[static_cast<std::size_t>(v)].z());
    const Vec2 b(positions[static_cast<std::size_t>(w)].x(), positions[static_cast<std::size_t>(w)].z());
    const double from = std::atan2(a[1], a[0]) / tau * directions;
    const double turn = std::atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]) / tau * directions;
    const int first = static_cast<int>(std::ceil(std::min(from, from + turn)));
    for (int i = first; i <= std::max(from, from + turn); ++i) {
      const Vec2 ray(std::cos(tau * i / directions), std::sin(tau * i / directions));
      const Vec2 edge = b - a;
      const double across = ray[0] * edge[1] - ray[1] * edge[0];
      const double radius = std::abs(across) > 1e-12 ? (a[0] * edge[1] - a[1] * edge[0]) / across
                                                     : std::max(a.norm(), b.norm());
      double& far = farthest[static_cast<std::size_t>(((i % directions) + directions) % directions)];
      far = std::max(far, std::min(radius, std::max(a.norm(), b.norm())));
    }
  };
  for (const Vec3i& t : triangulate(ring.mesh).triangles)
    for (int c = 0; c < 3; ++c) spread(t[c], t[(c + 1) % 3]);
  return farthest;
}

/// The area within an outline.
double area_of(const std::vector<double>& outline) {
  double twice = 0;
  for (const double radius : outline) twice += radius * radius * tau / static_cast<double>(outline.size());
  return twice / 2;
}

/// Maxima of an outline from which it falls by `rise` on both sides.
int folds_of(const std::vector<double>& outline, double rise) {
  const auto lowest = std::min_element(outline.begin(), outline.end()) - outline.begin();
  double extreme = outline[static_cast<std::size_t>(lowest)];  // since the last turn
  bool rises = true;
  int folds = 0;
  for (std::size_t i = 0; i <= outline.size(); ++i) {
    const double radius = outline[(static_cast<std::size_t>(lowest) + i) % outline.size()];
    extreme = rises ? std::max(extreme, radius) : std::min(extreme, radius);
    if (std::abs(radius - extreme) < rise) continue;
    folds += rises ? 1 : 0;
    rises = !rises;
    extreme = radius;
  }
  return folds;
}

}  // namespace

std::vector<Drape> simulate_drapes(const Material& material, const DrapeTest& test,
                                   const DrapeOptions& options, const Progress& progress) {
  const Ring ring(test, options);
  Scene scene = parse_scene(drape_scene, "drape.toml");
  ShellMaterial numbers = material.shell.value_or(ShellMaterial());
  numbers.mass_damping = settling;
  scene.bodies.front().material = material;
  scene.bodies.front().material.shell = numbers;
  scene.meshes["cloth"] = std::make_shared<const Mesh>(ring.mesh);
  const auto model = std::make_shared<const Model>(build_model(scene));
  const double disc = ring.inner * ring.inner * std::numbers::pi;
  const double whole = std::pow(ring.inner + ring.width, 2) * std::numbers::pi;
  const double fall = numbers.areal_density * (whole - disc) * 9.8 * ring.width;  // J

  std::vector<Drape> drapes;
  drapes.reserve(static_cast<std::size_t>(options.drops));
  for (int drop = 0; drop < options.drops; ++drop) {
    Simulation simulation(model);
    simulation.set_positions(uneven(ring, drop));
    for (int frame = 1; frame <= scene.time.frames(); ++frame) {
      progress.at((drop + static_cast<double>(frame) / scene.time.frames()) / options.drops, "drape");
      simulation.advance({{}, progress.cancelled});
      if (frame >= first_look && simulation.diagnostics().kinetic < at_rest * fall) break;
    }
    const std::vector<double> edge = outline_of(ring, simulation.state().positions);
    drapes.push_back({(area_of(edge) - disc) / (whole - disc), folds_of(edge, prominence * ring.width)});
  }
  return drapes;
}

double drape_coefficient(const Material& material, const DrapeTest& test, const DrapeOptions& options,
                         const Progress& progress) {
  double sum = 0;
  for (const Drape& drape : simulate_drapes(material, test, options, progress)) sum += drape.coefficient;
  return sum / options.drops;
}

}  // namespace muslin
