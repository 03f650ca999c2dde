#include "verify_fabric.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <map>

#include <fmt/format.h>

#include "muslin/geometry/triangulated_strip.hpp"

namespace muslin::app {

std::string FabricMesh::label(const std::string& quantity) const {
  return fmt::format("{} {}: {}", kind, cells, quantity);
}

double FabricMesh::tolerance() const {
  return (kind == "delaunay" ? 0.02 : 0.01) * std::pow(40.0 / cells, 2);
}

Comparison FabricMesh::compare(const std::string& quantity, double reference, double measured,
                               double share) const {
  return {label(quantity), reference, measured, share * tolerance()};
}

std::vector<FabricMesh> fabric_meshes(std::initializer_list<int> cells) {
  std::vector<FabricMesh> meshes;
  for (const char* kind : {"right", "crossed", "equilateral", "delaunay"})
    for (const int n : cells) meshes.push_back({kind, n});
  return meshes;
}

FabricSheet::FabricSheet(const Experiment& experiment, const FabricMesh& of, double width, bool clamped)
    : mesh(triangulated_strip(of.kind, of.cells, width, clamped)) {
  experiment.mesh("sheet.obj", mesh);
}

std::size_t FabricSheet::vertex(const Vec3& point) const {
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    if ((mesh.positions[v] - point).norm() < 1e-9) return v;
  throw Error(ErrorKind::usage, fmt::format("no vertex at ({}, {})", point.x(), point.y()),
              "correct the case");
}

Vec3 FabricSheet::mean(const Simulation& simulation, const std::vector<Vec3>& points) const {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : points) sum += simulation.state().positions[vertex(p)];
  return sum / static_cast<double>(points.size());
}

Mesh bent_strip(const FabricMesh& of, double width, bool clamped,
                const std::function<Vec3(const Vec3&)>& shape) {
  const Mesh flat = triangulated_strip(of.kind, of.cells, width, clamped);
  Mesh mesh;
  std::map<std::array<std::int64_t, 3>, int> numbers;
  std::vector<int> vertices;
  for (const Vec3& p : flat.positions) {
    const Vec3 x = shape(p);
    const auto cell = [](double at) { return std::int64_t{std::llround(at * 1e8)}; };
    const auto [at, fresh] = numbers.emplace(std::array{cell(x.x()), cell(x.y()), cell(x.z())},
                                             static_cast<int>(mesh.positions.size()));
    if (fresh) mesh.positions.push_back(x);
    vertices.push_back(at->second);
  }
  for (std::size_t f = 0; f < flat.face_count(); ++f) {
    const auto face = flat.face(f);
    mesh.add_face(std::array{vertices[static_cast<std::size_t>(face[0])],
                             vertices[static_cast<std::size_t>(face[1])],
                             vertices[static_cast<std::size_t>(face[2])]});
  }
  return mesh;
}

std::string fabric_body(double rigidity, double poisson, double thickness) {
  return fmt::format(R"(
[[body]]
mesh = "sheet.obj"
model = "shell"
warp = [1, 0, 0]
material = {{ areal_density = {}, membrane_warp = {:.17g}, bending_warp = {:.17g}, poisson = {:.17g} }}
)",
                     fabric_density, 12 * (1 - poisson * poisson) * rigidity / (thickness * thickness),
                     rigidity, poisson);
}

std::string shell_body(double youngs, double poisson, double thickness) {
  return fabric_body(youngs * std::pow(thickness, 3) / (12 * (1 - poisson * poisson)), poisson, thickness);
}

std::string point_force(const Vec3& at, const Vec3& force) {
  return fmt::format(
      "[[force]]\ntype = \"point\"\nforce = [{:.17g}, {:.17g}, {:.17g}]\n"
      "where = {{ nearest = [{:.17g}, {:.17g}, {:.17g}] }}\n",
      force.x(), force.y(), force.z(), at.x(), at.y(), at.z());
}

std::string probe(const std::string& name, const Vec3& at) {
  return fmt::format("[[probe]]\nname = \"{}\"\nat = [{:.17g}, {:.17g}, {:.17g}]\n", name, at.x(), at.y(),
                     at.z());
}

std::string slow_steps(double step) {
  return fmt::format(
      "[time]\nframe_rate = {:.17g}\nsteps_per_frame = 1\nduration = 1e6\n"
      "[solver]\neffort = \"exact\"\ntolerance = 1e-4\n",
      1 / step);
}

double tolerance_around(const FabricMesh& of) { return FabricMesh{of.kind, of.cells / 2}.tolerance(); }

std::string fabric_pin(double x0, double y0, double x1, double y1, const std::string& keyframes) {
  return fmt::format(
      "[[pin]]\nwhere = {{ box = [[{:.17g}, {:.17g}, -1e-9], [{:.17g}, {:.17g}, 1e-9]] }}\n{}\n", x0, y0, x1,
      y1, keyframes);
}

}  // namespace muslin::app
