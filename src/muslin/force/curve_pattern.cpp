#include "muslin/force/curve_pattern.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

/// The direction of a + b, or of a if they cancel.
Vec3 blended(const Vec3& a, const Vec3& b) {
  const Vec3 sum = a + b;
  const double length = sum.norm();
  return length > 1e-12 ? Vec3(sum / length) : a;
}

}  // namespace

CurvePattern::CurvePattern(Settings settings) : settings_(std::move(settings)) {
  const std::vector<Vec3>& points = settings_.points;
  require(points.size() >= 2, "a curve has less than two points", "give at least two");
  std::vector<Vec3> directions;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    require(points[i] != points[i + 1], "two neighbouring points of a curve are equal", "leave one out");
    directions.push_back((points[i + 1] - points[i]).normalized());
  }
  tangents_.push_back(directions.front());
  for (std::size_t i = 0; i + 1 < directions.size(); ++i)
    tangents_.push_back(blended(directions[i], directions[i + 1]));
  tangents_.push_back(directions.back());
}

FieldSample CurvePattern::at(const Vec3& place, double) const {
  const std::vector<Vec3>& points = settings_.points;
  double least = std::numeric_limits<double>::infinity(), share = 0;
  std::size_t nearest = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Vec3 segment = points[i + 1] - points[i];
    const double t = std::clamp(segment.dot(place - points[i]) / segment.squaredNorm(), 0.0, 1.0);
    const double distance = (points[i] + t * segment - place).squaredNorm();
    if (distance >= least) continue;
    least = distance;
    nearest = i;
    share = t;
  }
  const Vec3 to_curve = points[nearest] + share * (points[nearest + 1] - points[nearest]) - place;
  const double distance = to_curve.norm();
  const Vec3 along = blended((1 - share) * tangents_[nearest], share * tangents_[nearest + 1]);
  return {along + settings_.attraction / std::max(distance, settings_.radius) * to_curve, distance};
}

}  // namespace muslin
