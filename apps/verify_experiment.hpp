// Provides the building blocks of the cases of `muslin verify`: a temporary folder with meshes, scenes
// written as text, and access to lattice vertices.
#pragma once

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "muslin/hosts.hpp"

namespace muslin::app {

inline constexpr double gravity = 9.8;  ///< of scenes that state no other [m/s²]

/// The lowest height that something has reached, and the highest after that [m].
struct Rebound {
  double lowest, highest;
  explicit Rebound(double height) : lowest(height), highest(height) {}
  void see(double height) {
    highest = height < lowest ? height : std::max(highest, height);
    lowest = std::min(lowest, height);
  }
};

/// A temporary folder, removed with the object.
class Experiment {
 public:
  Experiment();
  ~Experiment();
  Experiment(const Experiment&) = delete;
  Experiment& operator=(const Experiment&) = delete;

  /// Writes a closed box from the origin to `size` [m].
  void box(const std::string& file, const Vec3& size) const;
  /// Writes a flat sheet x by z in the plane y = 0, made of `cells` by `cells` squares [m].
  void level_sheet(const std::string& file, double x, double z, int cells) const {
    level_sheet(file, x, z, cells, cells);
  }
  /// Writes a sheet of 1 m as `cloth.obj` and returns tables of a scene: it is cotton about the origin, held
  /// at two opposite edges.
  std::string held_cloth() const;
  /// Writes a sheet of `cells_x` by `cells_z` squares; vertex i + k (cells_x + 1).
  void level_sheet(const std::string& file, double x, double z, int cells_x, int cells_z) const;
  /// Writes a ball about the origin [m]: `rings` rows of polygons from pole to pole, `segments` in each.
  void ball(const std::string& file, double radius, int segments, int rings) const;
  /// Writes a closed cube about the origin, every side of `cells` by `cells` squares [m].
  void cube(const std::string& file, double side, int cells) const;
  /// Writes any mesh.
  void mesh(const std::string& file, const Mesh& mesh) const;
  /// Writes an upright sheet x by y in the plane z = 0 [m].
  void upright_sheet(const std::string& file, double x, double y) const;

  /// A simulation of the scene given as text; meshes are found in the folder.
  Simulation start(const std::string& scene, const std::vector<std::string>& overrides = {}) const;

 private:
  void write(const std::string& file, const std::string& content) const;
  std::filesystem::path folder_;
};

void advance(Simulation& simulation, int frames);

/// Returns the centre of mass [m] or its velocity [m/s] of the body or collider of this name.
Vec3 centre(const Simulation& simulation, const std::string& name, bool velocity = false);

/// Returns the index of vertex (i, j, k) of the only body's lattice.
std::size_t vertex(const Simulation& simulation, int i, int j, int k);
/// Returns the position of that vertex [m].
Vec3 position(const Simulation& simulation, int i, int j, int k);

/// Largest |x − y| over all vertices [m].
double largest_distance(ConstVectors x, ConstVectors y);

/// Number of vertices whose positions or velocities differ in any bit.
double differing(const State& a, const State& b);

/// The part of a scene that finds its static equilibrium: steps so long that inertia does not matter.
/// `tolerance` is the allowed error as a share of an edge.
std::string static_solve(double tolerance);

}  // namespace muslin::app
