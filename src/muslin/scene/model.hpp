// Model holds all data that is constant during a run: components, masses, potentials, loads, pins, probes.
// Built once from a Scene; shared read-only by the simulation and its writers.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/component/component_list.hpp"
#include "muslin/component/terms.hpp"
#include "muslin/constraint/pin.hpp"
#include "muslin/constraint/prescribed.hpp"
#include "muslin/core/progress.hpp"
#include "muslin/lattice/embedding.hpp"
#include "muslin/scene/scene.hpp"

namespace muslin {

class Attachment;
struct ContactModel;

struct Probe {
  std::string name;
  int body = 0;
  Embedding point;  ///< one point, from the vertices of the body
};

/// Points of two bodies that an [[attachment]] holds together.
struct Attached {
  std::string name;
  std::shared_ptr<const Attachment> springs;
  std::array<int, 2> bodies{};              ///< indices
  std::vector<std::array<Vec3, 2>> places;  ///< #joints, the points of both at the start [m]
};

struct MUSLIN_API Model {
  Scene scene;
  ComponentList bodies;  ///< the scene's bodies, its colliders, then components added by a program
  std::vector<Vec3> rest_positions;       ///< #V by 3, all components one after the other, at the start [m]
  std::vector<Vec3> velocities;           ///< #V by 3, at the start [m/s]; empty: at rest
  std::vector<double> masses;             ///< #V [kg]; 0 of prescribed vertices
  std::vector<PotentialTerm> potentials;  ///< over all vertices
  std::vector<LoadTerm> loads;            ///< over all vertices
  std::vector<Pin> pins;
  std::vector<Prescribed> prescribed;
  std::vector<Attached> attachments;
  std::vector<Probe> probes;
  std::shared_ptr<const ContactModel> contact;  ///< null if nothing can touch
  std::vector<std::string> warnings;            ///< for the user, before a run

  std::size_t vertex_count() const { return rest_positions.size(); }
  /// Return the component, pin, attachment or probe of that name. Errors: usage, with the nearest name.
  const Component& body(std::string_view name) const;
  const Pin& pin(std::string_view name) const;
  const Attached& attachment(std::string_view name) const;
  const Probe& probe(std::string_view name) const;
  /// Returns the component of a vertex of the model. Errors: usage, if there is no such vertex.
  const Component& body_of(std::size_t vertex) const;
  ConstVectors of(const Component& body, ConstVectors all) const {
    return all.subspan(static_cast<std::size_t>(body.first_vertex),
                       static_cast<std::size_t>(body.vertex_count));
  }
};

/// Reads the meshes and builds everything. Errors: input or file, with the place in the scene.
MUSLIN_API Model build_model(const Scene& scene, const Progress& progress = {});

}  // namespace muslin
