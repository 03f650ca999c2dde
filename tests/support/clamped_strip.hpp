// Strips between two clamps, rolled up to a constant curvature: bending without free ends.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "muslin/geometry/triangulated_strip.hpp"

namespace muslin::test {

/// A strip from x = 0 to 1 between two clamps, a row of cells each.
struct ClampedStrip {
  ClampedStrip(const std::string& kind, int n, double width)
      : mesh(triangulated_strip(kind, n, width, true)) {
    std::vector<int> end;
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
      if (std::abs(mesh.positions[v].x() - 1) < 1e-9) end.push_back(static_cast<int>(v));
    const auto y = [&](int v) { return mesh.positions[static_cast<std::size_t>(v)].y(); };
    std::sort(end.begin(), end.end(), [&](int a, int b) { return y(a) < y(b); });
    const int first = static_cast<int>(mesh.vertex_count());
    for (const int v : end) mesh.positions.emplace_back(1 + 1.0 / n, y(v), 0);
    for (int j = 0; j + 1 < static_cast<int>(end.size()); ++j) {
      const int a = end[static_cast<std::size_t>(j)], d = end[static_cast<std::size_t>(j) + 1];
      mesh.add_face(std::array{a, first + j, first + j + 1});
      mesh.add_face(std::array{a, first + j + 1, d});
    }
    for (const Vec3& p : mesh.positions) held.push_back(p.x() < 1e-9 || p.x() > 1 - 1e-9 ? 1 : 0);
  }

  /// Between the clamps an arc, beyond them its tangents.
  std::vector<Vec3> rolled(double curvature) const {
    std::vector<Vec3> x;
    for (const Vec3& p : mesh.positions) {
      const double s = std::clamp(p.x(), 0.0, 1.0), angle = curvature * s;
      Vec3 on_arc = curvature == 0 ? Vec3(s, 0, 0)
                                   : Vec3(std::sin(angle) / curvature, 0, (1 - std::cos(angle)) / curvature);
      on_arc += (p.x() - s) * Vec3(std::cos(angle), 0, std::sin(angle));
      x.emplace_back(on_arc.x(), p.y(), on_arc.z());
    }
    return x;
  }

  Mesh mesh;
  std::vector<std::uint8_t> held;
};

}  // namespace muslin::test
