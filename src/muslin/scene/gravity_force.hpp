// Gravity as a kind of [[force]].
#pragma once

#include "muslin/scene/force_kind.hpp"

namespace muslin {

extern const ForceKind gravity_kind;

}  // namespace muslin
