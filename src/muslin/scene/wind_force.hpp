// Wind as a kind of [[force]]. docs/theory/wind.md.
#pragma once

#include "muslin/scene/force_kind.hpp"

namespace muslin {

extern const ForceKind wind_kind;

}  // namespace muslin
