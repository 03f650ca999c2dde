// Lists the kinds of components that a scene can name, one row per kind.
#pragma once

#include <vector>

#include "muslin/component/body_kind.hpp"
#include "muslin/component/collider/collider_kind.hpp"

namespace muslin {

const std::vector<BodyKind>& body_kinds();
const std::vector<ColliderKind>& collider_kinds();

/// Returns the kind of a body. Errors: usage, for an unknown model.
const BodyKind& kind_of(const BodySettings& settings);
const ColliderKind& kind_of(const ColliderSettings& settings);

/// Return the source of the component that settings describe. Errors: as kind_of.
ComponentSource source_of(const BodySettings& settings);
ComponentSource source_of(const ColliderSettings& settings);

}  // namespace muslin
