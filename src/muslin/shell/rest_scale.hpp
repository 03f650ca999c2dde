// Scales the shape without stress of a shell along warp and weft, as cloth that shrinks or grows.
#pragma once

#include "muslin/core/vectors.hpp"
#include "muslin/shell/shell.hpp"

namespace muslin {

/// Multiplies the rest lengths along warp and weft by `scale` > 0. The angles at rest stay.
void scale_rest(Shell& shell, const Vec2& scale);

}  // namespace muslin
