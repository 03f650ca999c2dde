// Drapes of a disc of 30 cm on a support of 18 cm (Cusick; BS 5058, ISO 9073-9): the coefficient is the share
// of the free ring that its shadow covers.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "verify_case.hpp"
#include "verify_experiment.hpp"
#include <fmt/format.h>

namespace muslin::app {
namespace {

constexpr double rim = 0.15, support = 0.09;  // radii [m]
constexpr double seconds = 3;

/// Rings of vertices about the origin, from one inside the support to the rim. The first two, held level, are
/// an exact clamp.
struct Disc {
  Mesh mesh;

  explicit Disc(double edge) {
    const int rings = static_cast<int>(std::lround((rim - support) / (edge * std::numbers::sqrt3 / 2)));
    std::vector<int> before;
    for (int ring = -1; ring <= rings; ++ring) {
      const double radius = support + (rim - support) * ring / rings;
      const int count = static_cast<int>(std::lround(2 * std::numbers::pi * radius / edge));
      std::vector<int> row;
      for (int i = 0; i < count; ++i) {
        const double angle = turn(i, count, ring);
        row.push_back(static_cast<int>(mesh.positions.size()));
        mesh.positions.emplace_back(radius * std::cos(angle), 0, radius * std::sin(angle));
      }
      if (!before.empty()) join(before, row);
      before = std::move(row);
    }
  }

 private:
  static double turn(int i, int count, int ring) {
    return 2 * std::numbers::pi * i / count + (ring % 2 == 0 ? 0 : std::numbers::pi / count);
  }

  /// Cuts the band between two rings, each time along the shorter diagonal.
  void join(const std::vector<int>& inner, const std::vector<int>& outer) {
    const auto at = [&](const std::vector<int>& ring, std::size_t i) {
      return mesh.positions[static_cast<std::size_t>(ring[i % ring.size()])];
    };
    const auto vertex = [](const std::vector<int>& ring, std::size_t i) { return ring[i % ring.size()]; };
    std::size_t i = 0, j = 0;
    while (i < inner.size() || j < outer.size()) {
      const bool along_inner =
          j == outer.size() || (i < inner.size() && (at(inner, i + 1) - at(outer, j)).norm() <
                                                        (at(inner, i) - at(outer, j + 1)).norm());
      if (along_inner) {
        mesh.add_face(std::array{vertex(inner, i), vertex(inner, i + 1), vertex(outer, j)});
        ++i;
      } else {
        mesh.add_face(std::array{vertex(inner, i), vertex(outer, j + 1), vertex(outer, j)});
        ++j;
      }
    }
  }
};

/// The area that triangles and the support cover, seen from above [m²], by cells of half a millimetre.
double shadow(const std::vector<Vec3>& x, const std::vector<Vec3i>& triangles) {
  constexpr double cell = 5e-4;
  constexpr int side = 640;
  std::vector<char> dark(static_cast<std::size_t>(side) * side, 0);
  const auto centre = [](int i) { return (i + 0.5 - side / 2.0) * cell; };
  const auto from = [](double low) {
    return std::max(0, static_cast<int>(std::floor(low / cell)) + side / 2);
  };
  const auto darken = [&](const auto& covers, int i, int j) {
    if (covers(centre(i), centre(j)))
      dark[static_cast<std::size_t>(i) * side + static_cast<std::size_t>(j)] = 1;
  };
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      darken([](double u, double v) { return u * u + v * v < support * support; }, i, j);
  for (const Vec3i& t : triangles) {
    const std::array<Vec3, 3> corner = {x[static_cast<std::size_t>(t[0])], x[static_cast<std::size_t>(t[1])],
                                        x[static_cast<std::size_t>(t[2])]};
    const auto covers = [&](double u, double v) {
      int left = 0, right = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const Vec3 &a = corner[c], &b = corner[(c + 1) % 3];
        ((b.x() - a.x()) * (v - a.z()) < (b.z() - a.z()) * (u - a.x()) ? right : left) += 1;
      }
      return left == 0 || right == 0;
    };
    const auto [low_u, high_u] = std::minmax({corner[0].x(), corner[1].x(), corner[2].x()});
    const auto [low_v, high_v] = std::minmax({corner[0].z(), corner[1].z(), corner[2].z()});
    for (int i = from(low_u); i < std::min(side, from(high_u) + 1); ++i)
      for (int j = from(low_v); j < std::min(side, from(high_v) + 1); ++j) darken(covers, i, j);
  }
  return cell * cell * static_cast<double>(std::count(dark.begin(), dark.end(), 1));
}

/// The drape coefficient [%] of a fabric at rest. `turn` [degrees] turns the threads, which gives another
/// drop.
double drape_coefficient(const std::string& material, double edge, double turn) {
  const Disc disc(edge);
  const Experiment experiment;
  experiment.mesh("disc.obj", disc.mesh);
  const double angle = turn * std::numbers::pi / 180;
  Simulation simulation = experiment.start(fmt::format(
      R"(
[time]
frame_rate = 24
[[body]]
mesh = "disc.obj"
model = "shell"
warp = [{}, 0, {}]
material = {{ base = "{}", mass_damping = 3 }}
[[pin]]
where = {{ sphere = {{ center = [0, 0, 0], radius = {} }} }}
[[force]]
type = "gravity"
)",
      std::cos(angle), std::sin(angle), material, 1.001 * support));
  advance(simulation, static_cast<int>(24 * seconds));
  constexpr double table = std::numbers::pi * support * support, whole = std::numbers::pi * rim * rim;
  return 100 * (shadow(simulation.state().positions, triangulate(disc.mesh).triangles) - table) /
         (whole - table);
}

/// Means of drops at every edge length against those at the shortest: folds of a drop differ, so that its
/// coefficient does by some points.
std::vector<Comparison> drapes_alike() {
  std::vector<Comparison> numbers;
  for (const char* material : {"silk", "denim"}) {
    const auto mean = [&](double edge) {
      double sum = 0;
      const std::array turns = {5.0, 25.0, 40.0};
      for (const double turn : turns) sum += drape_coefficient(material, edge, turn);
      return sum / static_cast<double>(turns.size());
    };
    const double finest = mean(0.007);
    for (const double edge : {0.015, 0.01})
      numbers.push_back(
          {fmt::format("{} at {:.0f} mm, of 7 mm [%]", material, 1000 * edge), finest, mean(edge), 3, false});
  }
  return numbers;
}

}  // namespace

std::vector<VerifyCase> drape_cases() {
  return {{"drape", "a disc drapes by the same coefficient at edges of 15, 10 and 7 mm", "the finest", true,
           drapes_alike}};
}

}  // namespace muslin::app
