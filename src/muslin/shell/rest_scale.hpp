// Scales the shape without stress of a shell along warp and weft, as cloth that shrinks or grows.
#pragma once

#include <functional>
#include <span>

#include "muslin/core/vectors.hpp"
#include "muslin/shell/shell.hpp"

namespace muslin {

/// Rest lengths along warp and weft over those before, > 0, of the triangle or hinge of these vertices.
using RestScale = std::function<Vec2(std::span<const int> vertices)>;

/// Multiplies the rest lengths of every triangle and hinge. The angles at rest stay.
void scale_rest(Shell& shell, const RestScale& scale);

}  // namespace muslin
