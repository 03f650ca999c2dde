#include "verify_experiment.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>

#include <fmt/format.h>
#include <unistd.h>

namespace muslin::app {

Experiment::Experiment() {
  static std::atomic<int> count{0};
  folder_ = std::filesystem::temp_directory_path() / fmt::format("muslin-verify-{}-{}", ::getpid(), count++);
  std::filesystem::create_directories(folder_);
}

Experiment::~Experiment() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

std::string Experiment::held_cloth() const {
  level_sheet("cloth.obj", 1, 1, 16);
  return R"(
[[body]]
name = "cloth"
mesh = "cloth.obj"
model = "shell"
material = "cotton"
stretch_limit = 10
translate = [-0.5, 0, -0.5]
[[pin]]
body = "cloth"
where = { plane = { point = [-0.5, 0, 0], normal = [1, 0, 0] } }
[[pin]]
body = "cloth"
where = { plane = { point = [0.5, 0, 0], normal = [1, 0, 0] } }
)";
}

void Experiment::write(const std::string& file, const std::string& content) const {
  const std::filesystem::path path = folder_ / file;
  std::ofstream out(path);
  out << content;
  out.close();
  if (!out)
    throw Error(ErrorKind::file, "cannot write " + path.string(), "set TMPDIR to a folder with space");
}

void Experiment::box(const std::string& file, const Vec3& size) const {
  std::string obj;
  for (int corner = 0; corner < 8; ++corner) {
    obj += fmt::format("v {:.17g} {:.17g} {:.17g}\n", (corner & 1) * size.x(), (corner >> 1 & 1) * size.y(),
                       (corner >> 2 & 1) * size.z());
  }
  write(file, obj + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n");
}

void Experiment::level_sheet(const std::string& file, double x, double z, int cells_x, int cells_z) const {
  std::string obj;
  for (int k = 0; k <= cells_z; ++k) {
    for (int i = 0; i <= cells_x; ++i)
      obj += fmt::format("v {:.17g} 0 {:.17g}\n", x * i / cells_x, z * k / cells_z);
  }
  const int row = cells_x + 1;
  for (int k = 0; k < cells_z; ++k) {
    for (int i = 0; i < cells_x; ++i) {
      const int v = 1 + k * row + i;
      obj += fmt::format("f {} {} {} {}\n", v, v + row, v + row + 1, v + 1);
    }
  }
  write(file, obj);
}

void Experiment::ball(const std::string& file, double radius, int segments, int rings) const {
  std::string obj = fmt::format("v 0 {:.17g} 0\n", radius);
  for (int ring = 1; ring < rings; ++ring) {
    const double from_pole = std::numbers::pi * ring / rings;
    for (int i = 0; i < segments; ++i) {
      const double around = 2 * std::numbers::pi * i / segments;
      obj += fmt::format("v {:.17g} {:.17g} {:.17g}\n", radius * std::sin(from_pole) * std::cos(around),
                         radius * std::cos(from_pole), radius * std::sin(from_pole) * std::sin(around));
    }
  }
  obj += fmt::format("v 0 {:.17g} 0\n", -radius);
  const int last_ring = 2 + (rings - 2) * segments, south_pole = last_ring + segments;
  for (int i = 0; i < segments; ++i) {
    const int next = (i + 1) % segments;
    obj += fmt::format("f 1 {} {}\n", 2 + next, 2 + i);
    for (int first = 2; first < last_ring; first += segments)
      obj += fmt::format("f {} {} {} {}\n", first + i, first + next, first + segments + next,
                         first + segments + i);
    obj += fmt::format("f {} {} {}\n", south_pole, last_ring + i, last_ring + next);
  }
  write(file, obj);
}

void Experiment::cube(const std::string& file, double side, int cells) const {
  std::string vertices, faces;
  std::map<std::array<int, 3>, int> numbers;
  const auto number = [&](const std::array<int, 3>& p) {
    const auto [at, fresh] = numbers.emplace(p, static_cast<int>(numbers.size()) + 1);
    if (fresh) {
      const auto along = [&](int i) { return (static_cast<double>(i) / cells - 0.5) * side; };
      vertices += fmt::format("v {:.17g} {:.17g} {:.17g}\n", along(p[0]), along(p[1]), along(p[2]));
    }
    return at->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const bool far : {false, true}) {
      for (int i = 0; i < cells; ++i) {
        for (int k = 0; k < cells; ++k) {
          const auto corner = [&](int di, int dk) {
            std::array<int, 3> p{};
            p[axis] = far ? cells : 0;
            p[(axis + 1) % 3] = i + di;
            p[(axis + 2) % 3] = k + dk;
            return number(p);
          };
          const int a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          faces +=
              far ? fmt::format("f {} {} {} {}\n", a, b, c, d) : fmt::format("f {} {} {} {}\n", d, c, b, a);
        }
      }
    }
  }
  write(file, vertices + faces);
}

void Experiment::mesh(const std::string& file, const Mesh& mesh) const { write_mesh(folder_ / file, mesh); }

void Experiment::upright_sheet(const std::string& file, double x, double y) const {
  write(file,
        fmt::format("v 0 0 0\nv {0:.17g} 0 0\nv {0:.17g} {1:.17g} 0\nv 0 {1:.17g} 0\nf 1 2 3 4\n", x, y));
}

Simulation Experiment::start(const std::string& scene, const std::vector<std::string>& overrides) const {
  return Simulation(
      std::make_shared<const Model>(build_model(parse_scene(scene, folder_ / "scene.toml", overrides))));
}

void advance(Simulation& simulation, int frames) {
  for (int frame = 0; frame < frames; ++frame) simulation.advance();
}

Vec3 centre(const Simulation& simulation, const std::string& name, bool velocity) {
  const Component& body = simulation.model().body(name);
  const auto& of = velocity ? simulation.state().velocities : simulation.state().positions;
  Vec3 sum = Vec3::Zero();
  double mass = 0;
  for (int v = body.first_vertex; v < body.first_vertex + body.vertex_count; ++v) {
    const auto i = static_cast<std::size_t>(v);
    sum += simulation.model().masses[i] * of[i];
    mass += simulation.model().masses[i];
  }
  return sum / mass;
}

std::size_t vertex(const Simulation& simulation, int i, int j, int k) {
  const int index = as_lattice(simulation.model().bodies.front())->lattice.find_vertex({i, j, k});
  if (index < 0)
    throw Error(ErrorKind::usage, fmt::format("no vertex ({}, {}, {})", i, j, k), "correct the case");
  return static_cast<std::size_t>(index);
}

Vec3 position(const Simulation& simulation, int i, int j, int k) {
  return simulation.state().positions[vertex(simulation, i, j, k)];
}

double largest_distance(ConstVectors x, ConstVectors y) {
  double largest = 0;
  for (std::size_t v = 0; v < x.size(); ++v) largest = std::max(largest, (x[v] - y[v]).norm());
  return largest;
}

double differing(const State& a, const State& b) {
  double count = 0;
  for (std::size_t v = 0; v < a.positions.size(); ++v)
    count += a.positions[v] != b.positions[v] || a.velocities[v] != b.velocities[v];
  return count;
}

std::string static_solve(double tolerance) {
  return fmt::format(
      "[time]\nframe_rate = 1e-4\nsteps_per_frame = 1\nduration = 1e6\n"
      "[solver]\neffort = \"exact\"\ntolerance = {:.17g}\n",
      1e-4 * tolerance);
}

}  // namespace muslin::app
