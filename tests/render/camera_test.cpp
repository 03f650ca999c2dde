// The camera sees all points of all frames, and stands no farther than it must.
#include "muslin/render/camera.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

TEST(Camera, SeesEveryPointAndTouchesTwoSides) {
  std::vector<Vec3> points;
  for (int i = 0; i < 500; ++i)
    points.emplace_back(3 * std::sin(i * 1.7), 100 + std::cos(i * 2.9), 5 * std::sin(i * 0.61));
  for (const double aspect : {0.5, 1.0, 16.0 / 9}) {
    for (const double azimuth : {-140.0, 0.0, 35.0, 90.0}) {
      CameraFit fit({.azimuth = azimuth, .elevation = 25}, aspect);
      fit.add({points.data(), 200});
      fit.add({points.data() + 200, 300});
      const Camera camera = fit.camera();
      double widest = 0;
      for (const Vec3& point : points) {
        ASSERT_GT((point - camera.position).dot(camera.forward), 0);
        const Vec2 seen = camera.project(point, 2, 2) - Vec2(1, 1);
        widest = std::max(widest, seen.cwiseAbs().maxCoeff());
      }
      EXPECT_NEAR(widest, 1 / 1.06, 1e-9) << aspect << " " << azimuth;
    }
  }
}

TEST(Camera, HasTheRightOrientation) {
  CameraFit fit({.azimuth = 0, .elevation = 10}, 1.5);
  fit.add(std::vector<Vec3>{Vec3(-1, -1, -1), Vec3(1, 1, 1)});
  const Camera camera = fit.camera();
  const Vec2 middle = camera.project(Vec3::Zero(), 300, 200);
  EXPECT_LT(camera.project(Vec3(0, 1, 0), 300, 200).y(), middle.y());
  EXPECT_GT(camera.project(Vec3(1, 0, 0), 300, 200).x(), middle.x());
  EXPECT_GT(camera.position.z(), 1);
}

TEST(Camera, NoPointsOrOnePointGiveACamera) {
  CameraFit empty({}, 1);
  EXPECT_TRUE(empty.camera().position.allFinite());
  CameraFit one({}, 1);
  one.add(std::vector<Vec3>{Vec3(5, 5, 5), Vec3(NAN, 0, 0)});
  const Camera camera = one.camera();
  EXPECT_TRUE(camera.position.allFinite());
  EXPECT_GT((camera.position - Vec3(5, 5, 5)).norm(), 0);
}

TEST(Camera, OptionsOutOfRangeAreRefused) {
  EXPECT_THROW(CameraFit({.elevation = 90}, 1), Error);
  EXPECT_THROW(CameraFit({.field_of_view = 0}, 1), Error);
  EXPECT_THROW(CameraFit({.distance_factor = -1}, 1), Error);
  EXPECT_THROW(CameraFit({}, 0), Error);
}

}  // namespace
}  // namespace muslin
