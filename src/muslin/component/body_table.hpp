// Declares [[body]]: the keys of every body, and those of each kind.
#pragma once

#include "muslin/schema/table.hpp"

namespace muslin {

const schema::Table& body_table();  ///< of BodySettings

}  // namespace muslin
