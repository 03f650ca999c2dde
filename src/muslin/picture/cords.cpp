#include "muslin/picture/cords.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>

namespace muslin {
namespace {

constexpr int sides = 8, rings = 17;
const Vec3 colour(0.33, 0.28, 0.22);

using Line = std::array<Vec3, rings>;

Line parabola(const Vec3& a, const Vec3& b, const Vec3& sag) {
  Line points;
  for (int r = 0; r < rings; ++r) {
    const double s = static_cast<double>(r) / (rings - 1);
    points[static_cast<std::size_t>(r)] = a + s * (b - a) + 4 * s * (1 - s) * sag;
  }
  return points;
}

double length_of(const Line& line) {
  double sum = 0;
  for (std::size_t r = 1; r < rings; ++r) sum += (line[r] - line[r - 1]).norm();
  return sum;
}

/// Returns the points of a cord of that length from a to b [m]: a line, or a parabola that hangs down.
Line curve(const Vec3& a, const Vec3& b, double length) {
  const double span = (b - a).norm();
  if (span == 0 || length <= span) return parabola(a, b, Vec3::Zero());
  const Vec3 along = (b - a) / span;
  Vec3 down = -Vec3::UnitY() + along.y() * along;
  if (down.norm() < 0.1) down = Vec3::UnitX() - along.x() * along;  // an upright cord sags sideways
  down.normalize();
  double low = 0, high = length / 2;
  for (int i = 0; i < 30; ++i) {
    const double middle = (low + high) / 2;
    (length_of(parabola(a, b, middle * down)) < length ? low : high) = middle;
  }
  return parabola(a, b, low * down);
}

/// Finds ends of cords at a frame; reads each body once.
class Ends {
 public:
  Ends(const RunReader& run, int frame) : run_(run), frame_(frame), skins_(run.bodies().size()) {}

  Vec3 operator()(const Cord::End& end) {
    std::vector<Vec3f>& skin = skins_[static_cast<std::size_t>(end.body)];
    if (skin.empty()) skin = run_.points(end.body, SurfaceKind::skin, frame_);
    Vec3 sum = Vec3::Zero();
    for (std::size_t c = 0; c < 3; ++c)
      sum += end.weights[static_cast<int>(c)] * skin[static_cast<std::size_t>(end.points[c])].cast<double>();
    return sum;
  }

 private:
  const RunReader& run_;
  int frame_;
  std::vector<std::vector<Vec3f>> skins_;  // empty until wanted
};

}  // namespace

Cords::Cords(const RunReader& run, double radius) : run_(run), radius_(radius) {
  std::map<int, Ends> ends;                      // by the frame in which cords begin
  std::map<std::string, std::vector<int>> held;  // by attachment
  for (const Cord& cord : run.selections().cords) {
    const int begin = static_cast<int>(std::ceil(cord.from * run.frame_rate()));
    if (begin >= run.frame_count()) continue;
    Ends& at = ends.try_emplace(begin, run, begin).first->second;
    if (held.count(cord.name) == 0) held[cord.name] = run.holding(cord.name);
    cords_.push_back({cord, (at(cord.ends[0]) - at(cord.ends[1])).norm(), held[cord.name]});
  }
}

bool Cords::acts(const Drawn& drawn, int frame) const {
  const double time = frame / run_.frame_rate();
  if (time < drawn.cord.from || time > drawn.cord.until) return false;
  return frame == 0 || drawn.holding[static_cast<std::size_t>(frame)] != 0;
}

Surface Cords::surface() const {
  Surface surface;
  surface.name = "cords";
  surface.look = prop_look();
  surface.look.colour = colour;
  surface.crease_angle = std::numbers::pi;
  surface.rest_positions = points(0);
  surface.triangles.reserve(cords_.size() * 2 * sides * (rings - 1));
  for (int c = 0; c < static_cast<int>(cords_.size()); ++c) {
    for (int r = 0; r + 1 < rings; ++r) {
      for (int k = 0; k < sides; ++k) {
        const auto at = [&](int ring, int side) { return (c * rings + ring) * sides + side % sides; };
        surface.triangles.push_back({at(r, k), at(r, k + 1), at(r + 1, k)});
        surface.triangles.push_back({at(r, k + 1), at(r + 1, k + 1), at(r + 1, k)});
      }
    }
  }
  return surface;
}

std::vector<Vec3> Cords::points(int frame) const {
  std::vector<Vec3> all;
  all.reserve(cords_.size() * rings * sides);
  Ends at(run_, frame);
  for (const Drawn& drawn : cords_) {
    const Vec3 a = at(drawn.cord.ends[0]), b = at(drawn.cord.ends[1]);
    const double radius = acts(drawn, frame) ? radius_ : 0;
    const auto line = curve(a, radius > 0 ? b : a, drawn.cord.slackens ? drawn.length : 0);
    for (std::size_t r = 0; r < rings; ++r) {
      const Vec3 tangent =
          (line[std::min<std::size_t>(r + 1, rings - 1)] - line[r == 0 ? 0 : r - 1]).normalized();
      const Vec3 aside = std::abs(tangent.y()) < 0.9 ? Vec3::UnitY() : Vec3::UnitX();
      const Vec3 u = tangent.cross(aside).normalized(), v = tangent.cross(u);
      for (int k = 0; k < sides; ++k) {
        const double angle = 2 * std::numbers::pi * k / sides;
        all.push_back(line[r] + radius * (std::cos(angle) * u + std::sin(angle) * v));
      }
    }
  }
  return all;
}

}  // namespace muslin
