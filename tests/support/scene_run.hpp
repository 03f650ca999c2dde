// A scene of scenes/ in motion, and facts about it.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "muslin/hosts.hpp"

namespace muslin::test {

class SceneRun {
 public:
  /// `file` is relative to scenes/.
  explicit SceneRun(const std::string& file, const std::vector<std::string>& overrides = {})
      : simulation_(std::make_shared<const Model>(
            build_model(read_scene(std::string(MUSLIN_SOURCE_DIR) + "/scenes/" + file, overrides)))) {}

  SceneRun& until_frame(int frame) {
    while (simulation_.frame() < frame) simulation_.advance();
    return *this;
  }

  SceneRun& step() {
    simulation_.step();
    return *this;
  }

  const Simulation& simulation() const { return simulation_; }
  const Model& model() const { return simulation_.model(); }
  const Component& body() const { return model().bodies.front(); }
  const LatticeBody& lattice_body() const { return *as_lattice(body()); }
  const std::vector<Vec3>& now() const { return simulation_.state().positions; }
  const std::vector<Vec3>& rest() const { return model().rest_positions; }

  Vec3 probe(const std::string& name) const {
    for (const Probe& probe : model().probes) {
      if (probe.name != name) continue;
      Vec3 point;
      probe.point.apply(model().of(model().bodies[static_cast<std::size_t>(probe.body)], now()),
                        std::span(&point, 1));
      return point;
    }
    throw std::invalid_argument("no probe " + name);
  }

  /// Rest position of the lowest vertex.
  Vec3 rest_of_lowest() const {
    const auto lowest = std::min_element(now().begin(), now().end(),
                                         [](const Vec3& a, const Vec3& b) { return a.y() < b.y(); });
    return rest()[static_cast<std::size_t>(lowest - now().begin())];
  }

  /// Mean over the vertices whose rest position satisfies the condition.
  template <class Condition>
  Vec3 mean(const Condition& at_rest) const {
    Vec3 sum = Vec3::Zero();
    int count = 0;
    for (std::size_t v = 0; v < now().size(); ++v) {
      if (at_rest(rest()[v])) sum += now()[v], ++count;
    }
    return sum / count;
  }

  /// Every held vertex stands exactly where it stood at rest.
  bool held_are_still(const std::string& pin_name = "") const {
    for (const Pin& pin : model().pins) {
      if (!pin_name.empty() && pin.name != pin_name) continue;
      for (const int v : pin.vertices) {
        if (now()[static_cast<std::size_t>(v)] != rest()[static_cast<std::size_t>(v)]) return false;
      }
    }
    return true;
  }

  /// Volume of all voxels over that at rest.
  double volume_ratio() const {
    double volume = 0;
    for (const auto& tet : build_tetrahedra(lattice_body().lattice)) {
      const auto corner = [&](int i) {
        return now()[static_cast<std::size_t>(tet[static_cast<std::size_t>(i)])];
      };
      volume += (corner(1) - corner(0)).dot((corner(2) - corner(0)).cross(corner(3) - corner(0))) / 6;
    }
    const double width = lattice_body().lattice.width;
    return volume / (static_cast<double>(lattice_body().lattice.voxel_count()) * width * width * width);
  }

 private:
  Simulation simulation_;
};

}  // namespace muslin::test
