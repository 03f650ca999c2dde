// A force on chosen vertices as a kind of [[force]].
#pragma once

#include "muslin/scene/force_kind.hpp"

namespace muslin {

extern const ForceKind point_kind;

}  // namespace muslin
