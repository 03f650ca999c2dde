// Two panels of cloth side by side that look sewn.
#pragma once

#include "support/sheet.hpp"

namespace muslin::test {

/// Two sheets of 10 by 20 squares of 5 cm, `gap` apart: vertices 10, 21, … of the first have those of the
/// second, 231, 242, …, beside them.
inline Mesh two_panels(double gap) {
  Mesh mesh = flat_sheet(10, 20, 0.5, 1);
  const Mesh panel = mesh;
  for (const Vec3& p : panel.positions) mesh.positions.emplace_back(p.x() + 0.5 + gap, p.y(), p.z());
  for (std::size_t f = 0; f < panel.face_count(); ++f) {
    std::vector<int> face;
    for (const int v : panel.face(f)) face.push_back(v + static_cast<int>(panel.vertex_count()));
    mesh.add_face(face);
  }
  return mesh;
}

}  // namespace muslin::test
