// Makes characters by a formula, dressed and animated: the input of bench/characters.
#pragma once

#include <filesystem>
#include <string>

namespace muslin::bench {

/// Writes `scene.toml` with its meshes and motions into `folder`: 60 frames of 1/24 s. `index` chooses build,
/// motion and fabrics; every fifth character starts with its sleeve in its skin. The skin is the zero of a
/// smooth union of cones, moved by linear blend skinning; from an A-pose it goes to one of five poses and
/// returns. It wears a loose dress and, on its left arm, a tight sleeve. Returns the name of the pose.
/// Errors: file.
std::string write_character(const std::filesystem::path& folder, int index);

}  // namespace muslin::bench
