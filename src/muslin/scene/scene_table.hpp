// Declares the scene file. docs/guide/scene-file.md describes it.
#pragma once

#include "muslin/schema/table.hpp"

namespace muslin {

const schema::Table& scene_table();  ///< of Scene

}  // namespace muslin
