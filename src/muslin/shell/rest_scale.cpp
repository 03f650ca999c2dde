#include "muslin/shell/rest_scale.hpp"

#include <cmath>

namespace muslin {

void scale_rest(Shell& shell, const Vec2& scale) {
  const double area = scale[0] * scale[1];
  const Mat2 shrink = scale.cwiseInverse().asDiagonal();
  for (Mat2& inverse : shell.inverses) inverse *= shrink;
  for (double& of_triangle : shell.areas) of_triangle *= area;
  for (double& of_vertex : shell.vertex_areas) of_vertex *= area;
  for (Hinge& hinge : shell.hinges) {
    // The edge runs across the bending direction.
    const double warp = scale[0] * scale[0] * (1 - hinge.warp_share);
    const double weft = scale[1] * scale[1] * hinge.warp_share;
    hinge.length *= std::sqrt(warp + weft);
    hinge.area *= area;
    hinge.warp_share = weft / (warp + weft);
  }
  shell.area *= area;
  shell.mean_edge *= std::sqrt(area);
}

}  // namespace muslin
