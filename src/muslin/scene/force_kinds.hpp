// The kinds of [[force]], one row each, and the table of their keys.
#pragma once

#include <string>
#include <vector>

#include "muslin/scene/force_kind.hpp"

namespace muslin {

const std::vector<ForceKind>& force_kinds();

/// Returns the kind of a force. Errors: usage, for a type of no kind.
const ForceKind& kind_of(const ForceSettings& force);

const schema::Table& force_table();  ///< [[force]], of ForceSettings

/// Completes a force that was read from `table` with what depends on the scene. Errors: input.
void finish_force(const TomlTable& table, std::size_t index, ForceSettings& force, const Scene& scene);

/// Adds the forces of model.scene to the model. Errors: as ForceKind::add.
void build_forces(Model& model);

}  // namespace muslin
