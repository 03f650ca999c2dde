#include "muslin/shell/rest_scale.hpp"

#include <algorithm>
#include <cmath>

namespace muslin {

namespace {

void scale_hinge(Hinge& hinge, const Vec2& scale) {
  // The edge runs across the bending direction.
  const double warp = scale[0] * scale[0] * (1 - hinge.warp_share);
  const double weft = scale[1] * scale[1] * hinge.warp_share;
  hinge.length *= std::sqrt(warp + weft);
  hinge.area *= scale.prod();
  hinge.warp_share = weft / (warp + weft);
}

}  // namespace

void scale_rest(Shell& shell, const RestScale& scale) {
  const double before = shell.area;
  std::fill(shell.vertex_areas.begin(), shell.vertex_areas.end(), 0.0);
  shell.area = 0;
  for (std::size_t t = 0; t < shell.triangles.size(); ++t) {
    const Vec3i& v = shell.triangles[t];
    const Vec2 of_triangle = scale({v.data(), 3});
    const Mat2 shrink = of_triangle.cwiseInverse().asDiagonal();
    shell.inverses[t] *= shrink;
    shell.areas[t] *= of_triangle.prod();
    shell.area += shell.areas[t];
    for (const int corner : v) shell.vertex_areas[static_cast<std::size_t>(corner)] += shell.areas[t] / 3;
  }
  for (Hinge& hinge : shell.hinges) scale_hinge(hinge, scale(hinge.vertices));
  shell.mean_edge *= std::sqrt(shell.area / before);
}

}  // namespace muslin
