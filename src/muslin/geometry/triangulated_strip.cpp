#include "muslin/geometry/triangulated_strip.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <utility>
#include <vector>

namespace muslin {
namespace {

/// Flips edges until the triangles, counter-clockwise in the plane z = 0, are Delaunay's.
void make_delaunay(const std::vector<Vec3>& x, std::vector<std::array<int, 3>>& triangles) {
  const auto at = [&](int v) -> const Vec3& { return x[static_cast<std::size_t>(v)]; };
  const auto cotangent = [&](int apex, int a, int b) {
    const Vec3 p = at(a) - at(apex), q = at(b) - at(apex);
    return p.dot(q) / p.cross(q).norm();
  };
  for (bool flipped = true; flipped;) {
    flipped = false;
    std::map<std::pair<int, int>, std::pair<std::size_t, std::size_t>> sides;  // of directed edges
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c)
        sides[{triangles[t][c], triangles[t][(c + 1) % 3]}] = {t, (c + 2) % 3};
    std::vector<char> changed(triangles.size(), 0);
    for (const auto& [edge, side] : sides) {
      const auto other = sides.find({edge.second, edge.first});
      if (edge.first > edge.second || other == sides.end()) continue;
      const auto [t, c] = side;
      const auto [u, d] = other->second;
      const int p = triangles[t][c], q = triangles[u][d], a = edge.first, b = edge.second;
      if (changed[t] || changed[u] || cotangent(p, a, b) + cotangent(q, a, b) > -1e-9) continue;
      triangles[t] = {p, a, q};
      triangles[u] = {q, b, p};
      changed[t] = changed[u] = 1;
      flipped = true;
    }
  }
}

}  // namespace

Mesh triangulated_strip(const std::string& kind, int n, double width, bool clamped) {
  const int m = std::max(3, static_cast<int>(std::lround(n * width))), before = clamped ? 1 : 0;
  const double hx = 1.0 / n, hy = width / m;
  std::mt19937 engine(7);
  const auto random = [&] { return 2.0 * engine() / 4294967295.0 - 1; };
  const double jitter = kind == "jittered" ? 0.2 : kind == "delaunay" ? 0.3 : 0;
  Mesh mesh;
  std::vector<std::array<int, 3>> triangles;
  std::vector<std::vector<int>> rows;
  const auto add = [&](double x, double y) {
    mesh.positions.emplace_back(x, y, 0);
    return static_cast<int>(mesh.positions.size()) - 1;
  };
  for (int j = 0; j <= m; ++j) {
    auto& row = rows.emplace_back();
    const bool shifted = kind == "equilateral" && j % 2 == 1;
    for (int i = -before; i <= n; ++i) {
      const bool inside = i > 0 && i < n && j > 0 && j < m;
      const double dx = inside ? jitter * std::min(hx, hy) * random() : 0,
                   dy = inside ? jitter * std::min(hx, hy) * random() : 0;
      row.push_back(add(i * hx + dx - (shifted && i > 0 ? hx / 2 : 0), j * hy + dy));
    }
    if (shifted) row.push_back(add(1, j * hy));
  }
  const auto id = [&](int i, int j) {
    return rows[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)];
  };
  for (int j = 0; j < m; ++j) {
    if (kind == "equilateral") {
      // Both rows from left to right, each time with the shorter diagonal.
      const auto &low = rows[static_cast<std::size_t>(j)], &high = rows[static_cast<std::size_t>(j) + 1];
      for (std::size_t a = 0, b = 0; a + 1 < low.size() || b + 1 < high.size();) {
        const auto x = [&](const std::vector<int>& row, std::size_t i) {
          return mesh.positions[static_cast<std::size_t>(row[i])].x();
        };
        const bool along_low = b + 1 == high.size() || (a + 1 < low.size() && x(low, a + 1) - x(high, b) <=
                                                                                  x(high, b + 1) - x(low, a));
        if (along_low) {
          triangles.push_back({low[a], low[a + 1], high[b]});
          ++a;
        } else {
          triangles.push_back({low[a], high[b + 1], high[b]});
          ++b;
        }
      }
      continue;
    }
    for (int i = 0; i < n + before; ++i) {
      const int a = id(i, j), b = id(i + 1, j), c = id(i + 1, j + 1), d = id(i, j + 1);
      if (kind == "crossed" && i >= before) {
        const int o = add((i - before + 0.5) * hx, (j + 0.5) * hy);
        for (const auto& t : {std::array{a, b, o}, {b, c, o}, {c, d, o}, {d, a, o}}) triangles.push_back(t);
        continue;
      }
      const bool left =
          kind == "left" || (kind == "alternating" && (i + j) % 2 == 1) || (kind == "random" && random() > 0);
      for (const auto& t : left ? std::array{std::array{a, b, d}, std::array{b, c, d}}
                                : std::array{std::array{a, b, c}, std::array{a, c, d}})
        triangles.push_back(t);
    }
  }
  if (kind == "delaunay") make_delaunay(mesh.positions, triangles);
  for (const auto& t : triangles) mesh.add_face(t);
  return mesh;
}

}  // namespace muslin
