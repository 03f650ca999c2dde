// Facts that pictures must show: the silhouette where the camera says, shadow under things, two sides told
// apart, crisp and smooth edges, the same bits for any thread count, errors instead of wrong pictures.
#include "muslin/render/raytrace.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/scenes.hpp"
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/render/render_mesh.hpp"

namespace muslin {
namespace {

using testing::grey;

Image draw(const SceneView& scene, const std::vector<std::vector<Vec3>>& positions,
           const CameraOptions& options = {}, const std::vector<double>& values = {}) {
  CameraFit fit(options, 160.0 / 120);
  FrameView frame;
  for (const auto& p : positions) {
    fit.add(p);
    frame.surfaces.push_back({p, values});
  }
  Raytracer raytracer(scene, fit.camera(), {.width = 160, .height = 120, .samples = 4, .sky_rays = 8});
  return raytracer.render(frame);
}

bool reddish(const std::uint8_t* p) { return p[0] > p[1] + 40; }

TEST(Raytrace, SilhouetteIsWhereTheCameraProjectsIt) {
  const Mesh mesh = testing::grid(8, 6, 2, 1);
  SceneView scene;
  scene.surfaces.push_back(make_surface(mesh, fabric_look(Vec3(0.8, 0.1, 0.1))));
  const CameraOptions options{.azimuth = 20, .elevation = 10};
  const Image image = draw(scene, {mesh.positions}, options);
  CameraFit fit(options, 160.0 / 120);
  fit.add(mesh.positions);
  Eigen::AlignedBox2d expected, seen;
  for (const Vec3& p : mesh.positions) expected.extend(fit.camera().project(p, 160, 120));
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x)
      if (reddish(image.pixel(x, y))) seen.extend(Vec2(x + 0.5, y + 0.5));
  ASSERT_FALSE(seen.isEmpty());
  EXPECT_LT((seen.min() - expected.min()).cwiseAbs().maxCoeff(), 1.6);
  EXPECT_LT((seen.max() - expected.max()).cwiseAbs().maxCoeff(), 1.6);
}

TEST(Raytrace, GroundIsDarkerUnderABody) {
  const Mesh mesh = testing::box(Vec3(-1, 0, -1), Vec3(1, 1, 1));
  SceneView scene;
  scene.surfaces.push_back(make_surface(mesh, solid_look(Vec3(0.8, 0.1, 0.1))));
  scene.ground = 0;
  CameraFit fit({.distance_factor = 2.2}, 160.0 / 120);
  fit.add(mesh.positions);
  const Camera camera = fit.camera();
  Raytracer raytracer(scene, camera, {.width = 160, .height = 120});
  const Image image = raytracer.render({{{mesh.positions, {}}}, {}, ""});
  // The sun stands behind the eye's left shoulder: the shadow falls to the right.
  const auto ground_at = [&](double along) {
    const Vec2 p = camera.project(along * camera.right, 160, 120);
    return grey(image, static_cast<int>(p.x()), static_cast<int>(p.y()));
  };
  EXPECT_LT(ground_at(1.6) + 30, ground_at(-2.3));
}

TEST(Raytrace, SameBitsForAnyThreadCount) {
  const Mesh mesh = testing::grid(20, 20, 1, 1);
  std::vector<Vec3> folded = mesh.positions;
  for (Vec3& p : folded) p.z() = 0.1 * std::sin(12 * p.x()) * std::cos(7 * p.y());
  SceneView scene;
  scene.surfaces.push_back(make_surface(mesh, fabric_look(Vec3(0.2, 0.3, 0.7))));
  scene.ground = -0.2;
  set_thread_count(1);
  const Image one = draw(scene, {folded});
  set_thread_count(2);
  const Image two = draw(scene, {folded});
  set_thread_count(0);
  EXPECT_EQ(one.pixels, two.pixels);
}

TEST(Raytrace, FrontAndBackDiffer) {
  const Mesh mesh = testing::grid(4, 4, 1, 1);
  SceneView scene;
  Look look = fabric_look(Vec3(0.8, 0.1, 0.1));
  look.back_colour = Vec3(0.1, 0.1, 0.8);
  scene.surfaces.push_back(make_surface(mesh, look));
  for (const double thickness : {0.0, 0.02}) {
    scene.surfaces[0].thickness = thickness;
    const Image front = draw(scene, {mesh.positions}, {.azimuth = 0});
    const Image back = draw(scene, {mesh.positions}, {.azimuth = 180});
    EXPECT_GT(front.pixel(80, 60)[0], front.pixel(80, 60)[2] + 40) << thickness;
    EXPECT_GT(back.pixel(80, 60)[2], back.pixel(80, 60)[0] + 40) << thickness;
  }
}

TEST(Raytrace, ThicknessShowsFromTheEdge) {
  const Mesh mesh = testing::grid(4, 4, 1, 1);
  SceneView scene;
  scene.surfaces.push_back(make_surface(mesh, solid_look(Vec3(0.8, 0.1, 0.1))));
  const auto red = [&](double thickness) {
    scene.surfaces[0].thickness = thickness;
    const Image image = draw(scene, {mesh.positions}, {.azimuth = 90, .elevation = 0});
    int count = 0;
    for (int x = 0; x < 160; ++x) count += reddish(image.pixel(x, 60));
    return count;
  };
  EXPECT_LE(red(0), 1);
  EXPECT_NEAR(red(0.1), 0.1 * 120 / 1.06, 2);
}

TEST(Raytrace, ValuesShowAsColoursWithALegend) {
  const Mesh mesh = testing::grid(4, 4, 1, 1);
  SceneView scene;
  scene.surfaces.push_back(make_surface(mesh, solid_look(Vec3(0.8, 0.1, 0.1))));
  const Image plain = draw(scene, {mesh.positions}, {.azimuth = 0});
  scene.colour_scale = ColourScale{0, 10, "stretch [%]", ColourMap::diverging};
  const Image low = draw(scene, {mesh.positions}, {.azimuth = 0}, std::vector<double>(25, 0.0));
  const Image high = draw(scene, {mesh.positions}, {.azimuth = 0}, std::vector<double>(25, 10.0));
  EXPECT_GT(low.pixel(80, 60)[2], low.pixel(80, 60)[0] + 30);
  EXPECT_GT(high.pixel(80, 60)[0], high.pixel(80, 60)[2] + 30);
  int changed = 0;  // at the right edge stands only the legend
  for (int y = 0; y < 120; ++y)
    for (int x = 135; x < 160; ++x) changed += std::abs(grey(low, x, y) - grey(plain, x, y)) > 20;
  EXPECT_GT(changed, 50);
}

TEST(Raytrace, MarkersAndLabelsAreDrawn) {
  const Mesh mesh = testing::grid(4, 4, 1, 1);
  SceneView scene;
  scene.surfaces.push_back(make_surface(mesh, solid_look(Vec3(0.8, 0.1, 0.1))));
  CameraFit fit({.azimuth = 0}, 160.0 / 120);
  fit.add(mesh.positions);
  Raytracer raytracer(scene, fit.camera(), {.width = 160, .height = 120, .samples = 4});
  const FrameView bare{{{mesh.positions, {}}}, {}, ""};
  FrameView marked = bare;
  marked.markers.push_back({Vec3(0.5, 0.5, 0), 0.1, Vec3(0.1, 0.8, 0.1)});
  marked.label = "frame 12";
  const Image a = raytracer.render(bare);
  const Image b = raytracer.render(marked);
  const Vec2 ball = fit.camera().project(Vec3(0.5, 0.5, 0.1), 160, 120);
  const auto* p = b.pixel(static_cast<int>(ball.x()), static_cast<int>(ball.y()));
  EXPECT_GT(p[1], p[0]);
  double darkest = 255;
  for (int y = 100; y < 120; ++y)
    for (int x = 5; x < 60; ++x) darkest = std::min(darkest, grey(b, x, y) - grey(a, x, y));
  EXPECT_LT(darkest, -50);
}

TEST(Raytrace, BoxEdgesStayCrispAndBallsSmooth) {
  const Mesh cube = testing::box(Vec3::Zero(), Vec3::Ones());
  const Surface surface = make_surface(cube, prop_look());
  EXPECT_EQ(smoothing_groups(surface.triangles, surface.rest_positions, 0.7).count, 24u);
  EXPECT_EQ(smoothing_groups(surface.triangles, surface.rest_positions, 1.7).count, 8u);
  const Surface sheet = make_surface(testing::grid(3, 2, 1, 1), prop_look());
  EXPECT_EQ(smoothing_groups(sheet.triangles, sheet.rest_positions, 0.7).count, 12u);
}

TEST(Raytrace, BadInputIsAnError) {
  const Mesh mesh = testing::grid(2, 2, 1, 1);
  SceneView scene;
  scene.surfaces.push_back(make_surface(mesh, prop_look()));
  EXPECT_THROW(draw(scene, {}), Error);
  EXPECT_THROW(draw(scene, {{Vec3::Zero()}}), Error);
  std::vector<Vec3> broken = mesh.positions;
  broken[3].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(draw(scene, {broken}), Error);
  EXPECT_THROW(Raytracer(scene, Camera(), {.samples = 0}), Error);
  EXPECT_THROW(Raytracer(scene, Camera(), {.width = -3}), Error);
  scene.colour_scale = ColourScale{};
  EXPECT_THROW(draw(scene, {mesh.positions}, {}, {1.0, 2.0}), Error);
  scene.surfaces[0].triangles[0][1] = 99;
  EXPECT_THROW(draw(scene, {mesh.positions}), Error);
}

TEST(Raytrace, EmptySceneIsBackgroundAndCancelStops) {
  SceneView scene;
  scene.ground = 0;
  Raytracer raytracer(scene, CameraFit({}, 1).camera(), {.width = 32, .height = 32, .samples = 1});
  EXPECT_GT(grey(raytracer.render({}), 16, 16), 100);
  Progress stop;
  stop.cancelled = [] { return true; };
  EXPECT_THROW(raytracer.render({}, stop), Error);
}

}  // namespace
}  // namespace muslin
