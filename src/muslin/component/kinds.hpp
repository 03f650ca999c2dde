// Lists the kinds of components that a scene can name, one row per kind.
#pragma once

#include "muslin/component/body_settings.hpp"
#include "muslin/component/collider/collider_settings.hpp"
#include "muslin/component/component_source.hpp"

namespace muslin {

/// Return the source of the component that the settings describe. Errors: usage, for an unknown model.
ComponentSource source_of(const BodySettings& settings);
ComponentSource source_of(const ColliderSettings& settings);

}  // namespace muslin
