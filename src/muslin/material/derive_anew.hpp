// Keeps numbers of a shell that follow from others consistent where a scene changes a material.
#pragma once

#include "muslin/material/shell_material.hpp"

namespace muslin {

class TomlTable;

/// `material` is `base` changed by the keys of `given`. Derives shear, bias and bending_damping anew from the
/// changed numbers, unless they are given or those of the base are not the derived ones.
void derive_anew(const TomlTable& given, const ShellMaterial& base, ShellMaterial& material);

}  // namespace muslin
