// Lists the pairs of vertices that a shell's energies couple.
#pragma once

#include <memory>

#include "muslin/potential/symmetric_pattern.hpp"
#include "muslin/shell/shell.hpp"

namespace muslin {

/// Returns the pairs of vertices that share a triangle or a hinge.
std::shared_ptr<const SymmetricPattern> block_pattern(const Shell& shell);

}  // namespace muslin
