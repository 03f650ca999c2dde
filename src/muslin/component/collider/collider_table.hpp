// Declares [[collider]]: the keys of every collider, those of each shape, and those of each kind.
#pragma once

#include "muslin/schema/table.hpp"

namespace muslin {

const schema::Table& collider_table();  ///< of ColliderSettings

}  // namespace muslin
