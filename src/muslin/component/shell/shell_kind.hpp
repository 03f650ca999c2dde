// The shell as a kind of [[body]].
#pragma once

#include "muslin/component/body_kind.hpp"

namespace muslin {

extern const BodyKind shell_kind;

/// [[body.fabric]] of a scene file.
const schema::Table& fabric_table();

}  // namespace muslin
