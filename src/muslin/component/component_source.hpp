// ComponentSource builds one component of a model; a scene is a list of them.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "muslin/component/scene_files.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/progress.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

class Component;

/// All that a component is built from besides its own settings.
struct ComponentInputs {
  const SceneFiles& files;
  double frame_rate = 24;              ///< of the scene [1/s]
  double step = 1.0 / 24;              ///< of the scene, the longest if it is adaptive [s]
  Box around;                          ///< bounds of the components built before, at the start [m]
  std::vector<std::string>& warnings;  ///< for the user; a builder appends
  Progress progress;                   ///< of this component
};

struct ComponentSource {
  std::string name;
  /// Returns the component, complete except for its vertex range in the model; never null. Errors: input and
  /// file, with the place in the scene.
  std::function<std::shared_ptr<Component>(const ComponentInputs&)> build;
  Place place = {};
  /// True for a component whose size depends on `around`: it is built after all others but keeps its place in
  /// the list.
  bool surrounds = false;
};

}  // namespace muslin
