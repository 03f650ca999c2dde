// ColliderKind describes a kind of component made of a [[collider]]: the keys that only it has, and how it is
// made. component/kinds.cpp lists the kinds.
#pragma once

#include <memory>
#include <vector>

#include "muslin/component/collider/collider_settings.hpp"
#include "muslin/component/component_source.hpp"
#include "muslin/schema/declare.hpp"

namespace muslin {

struct ColliderKind {
  /// True if it is the kind that the settings describe: of one kind for all settings.
  bool (*is_meant)(const ColliderSettings& settings);
  std::vector<schema::Key> (*keys)(ColliderSettings::Shape shape);  ///< of ColliderSettings, for a shape
  std::shared_ptr<Component> (*build)(const ColliderSettings& settings, const ComponentInputs& inputs);
};

}  // namespace muslin
