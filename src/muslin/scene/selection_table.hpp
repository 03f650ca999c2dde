// Declares `where`.
#pragma once

#include "muslin/schema/table.hpp"

namespace muslin {

const schema::Table& selection_table();  ///< of Selection

/// Throws Error(input): the owner must have a `where`.
[[noreturn]] void refuse_without_selection(const TomlTable& owner);

}  // namespace muslin
