#include "muslin/report/stretch_place.hpp"

#include <array>
#include <cmath>
#include <vector>

#include <Eigen/LU>
#include <nlohmann/json.hpp>

#include "muslin/geometry/mesh.hpp"
#include "muslin/lattice/springs.hpp"
#include "muslin/report/json_list.hpp"

namespace muslin {
namespace {

using Json = nlohmann::ordered_json;

/// Keeps the largest ratio and where it was.
class Largest {
 public:
  void see(double ratio, const std::string& body, const Vec3& at) {
    if (!place_ || ratio > place_->ratio) place_ = StretchPlace{ratio, body, at};
  }
  const std::optional<StretchPlace>& place() const { return place_; }

 private:
  std::optional<StretchPlace> place_;
};

Vec3 at(const std::vector<Vec3f>& points, int i) {
  return points[static_cast<std::size_t>(i)].cast<double>();
}

/// Returns the largest singular value of the map from the first triangle to the second; 0 of a first one
/// without area.
double triangle_stretch(const std::array<Vec3, 3>& rest, const std::array<Vec3, 3>& now) {
  const Vec3 u = rest[1] - rest[0], v = rest[2] - rest[0];
  const Vec3 along = u.normalized();
  Eigen::Matrix2d edges;
  edges << u.norm(), v.dot(along), 0, (v - v.dot(along) * along).norm();
  if (!(edges.determinant() > 0)) return 0;
  Eigen::Matrix<double, 3, 2> moved;
  moved << now[1] - now[0], now[2] - now[0];
  const Eigen::Matrix<double, 3, 2> gradient = moved * edges.inverse();
  const Vec3 a = gradient.col(0), b = gradient.col(1);
  const double half = (a.squaredNorm() - b.squaredNorm()) / 2, shear = a.dot(b);
  return std::sqrt((a.squaredNorm() + b.squaredNorm()) / 2 + std::sqrt(half * half + shear * shear));
}

void see_shell(const RunReader& run, int body, int frame, Largest& largest) {
  const std::vector<Vec3f> rest = run.points(body, SurfaceKind::skin, 0),
                           now = run.points(body, SurfaceKind::skin, frame);
  for (const Vec3i& t : triangulate(run.mesh(body, SurfaceKind::skin)).triangles) {
    const auto corners = [&t](const std::vector<Vec3f>& points) {
      return std::array{at(points, t[0]), at(points, t[1]), at(points, t[2])};
    };
    const std::array<Vec3, 3> x = corners(now);
    largest.see(triangle_stretch(corners(rest), x), run.bodies()[static_cast<std::size_t>(body)],
                (x[0] + x[1] + x[2]) / 3);
  }
}

/// Pairs of corners of a voxel that springs join.
std::vector<std::array<int, 2>> springs_of_voxel(Bracing bracing) {
  std::vector<std::array<int, 2>> pairs;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3i place(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    for (const SpringDirection& direction : spring_directions(bracing)) {
      const Vec3i end = place + direction.offset;
      if (end.minCoeff() >= 0 && end.maxCoeff() <= 1)
        pairs.push_back({corner, end[0] + 2 * end[1] + 4 * end[2]});
    }
  }
  return pairs;
}

void see_cells(const RunReader& run, int body, Bracing bracing, int frame, Largest& largest) {
  const RunReader::Cells& cells = run.cells(body);
  const std::vector<Vec3f> now = run.selectable_points(body, frame);
  const std::vector<std::array<int, 2>> springs = springs_of_voxel(bracing);
  for (const std::array<int, 8>& voxel : cells.voxels) {
    for (const auto& [a, b] : springs) {
      const int i = voxel[static_cast<std::size_t>(a)], j = voxel[static_cast<std::size_t>(b)];
      const double rest = (cells.rest_positions[static_cast<std::size_t>(j)] -
                           cells.rest_positions[static_cast<std::size_t>(i)])
                              .norm();
      largest.see((at(now, j) - at(now, i)).norm() / rest, run.bodies()[static_cast<std::size_t>(body)],
                  (at(now, i) + at(now, j)) / 2);
    }
  }
}

Bracing bracing_of(const Json& scene, const std::string& name) {
  for (const Json& body : json_list(scene, "body"))
    if (body.is_object() && body.value("name", Json()) == Json(name))
      return body.value("bracing", Json()) == "full" ? Bracing::full : Bracing::kuhn;
  return Bracing::kuhn;
}

}  // namespace

std::optional<StretchPlace> find_largest_stretch(const RunReader& run, int frame) {
  const Json scene = Json::parse(run.resolved_scene(), nullptr, false);
  Largest largest;
  for (int b = 0; b < static_cast<int>(run.bodies().size()); ++b) {
    if (run.is_collider(b)) continue;
    if (run.has_cells(b))
      see_cells(run, b, bracing_of(scene, run.bodies()[static_cast<std::size_t>(b)]), frame, largest);
    else
      see_shell(run, b, frame, largest);
  }
  return largest.place();
}

}  // namespace muslin
