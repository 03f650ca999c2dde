// Declares `falloff` and `region` of a field.
#pragma once

#include "muslin/schema/table.hpp"

namespace muslin {

const schema::Table& falloff_table();  ///< of Falloff
const schema::Table& region_table();   ///< of Region

}  // namespace muslin
