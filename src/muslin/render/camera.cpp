#include "muslin/render/camera.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

constexpr double margin = 1.06;

}  // namespace

Vec2 Camera::project(const Vec3& point, int width, int height) const {
  const Vec3 seen = point - position;
  const double depth = seen.dot(forward);
  return Vec2(width * (0.5 + 0.5 * seen.dot(right) / (depth * half_width)),
              height * (0.5 - 0.5 * seen.dot(up) / (depth * half_height)));
}

CameraFit::CameraFit(const CameraOptions& options, double aspect) : options_(options) {
  require(std::isfinite(options.azimuth), "the camera's azimuth is not a number", "give it in degrees");
  require(std::abs(options.elevation) <= 89, "the camera's elevation is not within −89…89 degrees",
          "give an elevation such as 20");
  require(options.field_of_view >= 5 && options.field_of_view <= 120,
          "the field of view is not within 5…120 degrees", "give a field of view such as 32");
  require(options.distance_factor > 0 && options.distance_factor <= 1000,
          "the camera's distance factor is not within 0…1000", "give 1 to fit the scene, 2 for twice as far");
  require(aspect > 0 && std::isfinite(aspect), "the picture has no area", "give a width and a height");
  const double degree = std::numbers::pi / 180;
  const double a = options.azimuth * degree;
  const double e = options.elevation * degree;
  view_.forward = -Vec3(std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e));
  view_.right = Vec3(std::cos(a), 0, -std::sin(a));
  view_.up = view_.right.cross(view_.forward);
  view_.half_height = std::tan(options.field_of_view * degree / 2);
  view_.half_width = view_.half_height * aspect;
  std::fill(std::begin(sides_), std::end(sides_), -std::numeric_limits<double>::infinity());
}

void CameraFit::add(ConstVectors points) {
  const double tx = view_.half_width / margin;
  const double ty = view_.half_height / margin;
  for (const Vec3& point : points) {
    if (!point.allFinite()) continue;
    box_.extend(point);
    const double x = point.dot(view_.right);
    const double y = point.dot(view_.up);
    const double z = point.dot(view_.forward);
    sides_[0] = std::max(sides_[0], x - z * tx);
    sides_[1] = std::max(sides_[1], -x - z * tx);
    sides_[2] = std::max(sides_[2], y - z * ty);
    sides_[3] = std::max(sides_[3], -y - z * ty);
  }
}

Camera CameraFit::camera() const {
  if (box_.isEmpty()) {
    CameraFit cube(options_, view_.half_width / view_.half_height);
    std::vector<Vec3> corners;
    for (int i = 0; i < 8; ++i) corners.emplace_back(i & 1, (i >> 1) & 1, i >> 2);
    cube.add(corners);
    return cube.camera();
  }
  Camera camera = view_;
  camera.target = box_.center();
  camera.radius = std::max(box_.sizes().norm() / 2, 1e-9 * (1 + box_.center().norm()));
  // The view's four planes through (x, y, −distance) hold all points when x + distance·tan ≥ sides[0], …
  const double tx = view_.half_width / margin;
  const double ty = view_.half_height / margin;
  const double back = std::max((sides_[0] + sides_[1]) / (2 * tx), (sides_[2] + sides_[3]) / (2 * ty));
  const double middle = camera.target.dot(view_.forward);
  const double distance = std::max(back + middle, 0.1 * camera.radius / view_.half_height);
  const Vec3 eye = (sides_[0] - sides_[1]) / 2 * view_.right + (sides_[2] - sides_[3]) / 2 * view_.up;
  camera.position = eye + (middle - distance * options_.distance_factor) * view_.forward;
  return camera;
}

}  // namespace muslin
