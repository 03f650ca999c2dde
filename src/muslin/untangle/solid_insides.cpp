#include "muslin/untangle/solid_insides.hpp"

#include <algorithm>
#include <set>

#include <Eigen/Geometry>

#include "muslin/core/index.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/geometry/closest_point.hpp"
#include "muslin/geometry/winding_number.hpp"

namespace muslin {
namespace {

constexpr std::size_t grain = 64;
constexpr double inside = 0.5;           // winding number
constexpr double contained_share = 0.1;  // depth over size of a piece that belongs inside
constexpr double on_surface = 1e-9;      // distance over size below which the direction is the normal

using Box = Eigen::AlignedBox3d;

Box box_of(std::span<const int> points, ConstVectors x) {
  Box box;
  for (const int p : points) box.extend(x[at(p)]);
  return box;
}

class Solid {
 public:
  Solid(const ContactSurface& surface, std::span<const int> numbers, ConstVectors x)
      : surface_(surface),
        numbers_(numbers),
        x_(x),
        triangles_(triangles_of(surface, numbers)),
        winding_(x, triangles_),
        nearest_(x, triangles_) {}

  bool contains(const Vec3& point) const { return winding_(point) > inside; }
  LostPoint way_out(int point, int piece, double size) const {
    const Vec3& from = x_[at(point)];
    const ClosestPoint near = nearest_(from);
    LostPoint lost;
    lost.point = point;
    lost.piece = piece;
    lost.triangle = numbers_[at(near.triangle)];
    lost.barycentric = near.barycentric;
    lost.depth = near.distance;
    const Vec3i& t = surface_.triangles()[at(lost.triangle)];
    lost.out = near.distance > on_surface * size
                   ? Vec3((near.point - from) / near.distance)
                   : Vec3((x_[at(t[1])] - x_[at(t[0])]).cross(x_[at(t[2])] - x_[at(t[0])]).normalized());
    return lost;
  }

 private:
  static std::vector<Vec3i> triangles_of(const ContactSurface& surface, std::span<const int> numbers) {
    std::vector<Vec3i> triangles;
    triangles.reserve(numbers.size());
    for (const int t : numbers) triangles.push_back(surface.triangles()[at(t)]);
    return triangles;
  }

  const ContactSurface& surface_;
  std::span<const int> numbers_;
  ConstVectors x_;
  std::vector<Vec3i> triangles_;
  WindingNumber winding_;
  ClosestPointQuery nearest_;
};

}  // namespace

std::vector<LostPoint> find_solid_insides(const ContactSurface& surface, const SurfacePieces& pieces,
                                          ConstVectors x, std::span<const std::array<int, 2>> crossing) {
  std::set<std::array<int, 2>> crossed;  // pieces
  for (const auto& [first, second] : crossing) {
    const int a = pieces.of_triangle(first), b = pieces.of_triangle(second);
    crossed.insert({a, b});
    crossed.insert({b, a});
  }
  std::vector<Box> boxes;
  boxes.reserve(std::size_t(pieces.count()));
  for (int p = 0; p < pieces.count(); ++p) boxes.push_back(box_of(pieces.points(p), x));
  std::vector<LostPoint> all;
  for (int s = 0; s < pieces.count(); ++s) {
    if (!pieces.is_solid(s)) continue;
    std::vector<int> near;  // pieces
    for (int p = 0; p < pieces.count(); ++p)
      if (p != s && surface.may_touch(pieces.body(p), pieces.body(s)) &&
          boxes[at(p)].intersects(boxes[at(s)]))
        near.push_back(p);
    if (near.empty()) continue;
    const Solid solid(surface, pieces.triangles(s), x);
    for (const int p : near) {
      std::vector<int> tested;
      for (const int point : pieces.points(p))
        if (boxes[at(s)].contains(x[at(point)])) tested.push_back(point);
      const double size = boxes[at(p)].diagonal().norm();
      std::vector<LostPoint> found = parallel_collect<LostPoint>(
          tested.size(), grain, [&](std::size_t begin, std::size_t end, std::vector<LostPoint>& out) {
            for (std::size_t i = begin; i < end; ++i)
              if (solid.contains(x[at(tested[i])])) out.push_back(solid.way_out(tested[i], s, size));
          });
      const auto deeper = [](const LostPoint& a, const LostPoint& b) { return a.depth < b.depth; };
      const bool contained = found.size() == pieces.points(p).size() && !crossed.contains({p, s});
      if (contained && std::max_element(found.begin(), found.end(), deeper)->depth > contained_share * size)
        continue;
      all.insert(all.end(), found.begin(), found.end());
    }
  }
  return all;
}

}  // namespace muslin
