// Characters made by a formula, dressed and animated: the input of bench/characters and of tests.
#pragma once

#include <filesystem>
#include <string>

namespace muslin::bench {

struct CharacterSettings {
  int index = 0;        ///< chooses build, motion and fabrics; every fifth starts with cloth in its skin
  double cell = 0.015;  ///< of the mesh of the skin, as a share of the stature
  int around = 52;      ///< vertices of a ring of the dress
};

/// The number of frames after frame 0 that a character moves, at `frame_rate`.
inline constexpr int character_frames = 60;
inline constexpr int character_frame_rate = 24;

/// Writes `scene.toml` with its meshes and motions into `folder`. The skin is the zero of a smooth union of
/// cones, moved by linear blend skinning; from an A-pose it goes to one of five poses and returns. It wears a
/// loose dress and, on its left arm, a tight sleeve. Returns the name of the pose. Errors: file.
std::string write_character(const std::filesystem::path& folder, const CharacterSettings& settings);

}  // namespace muslin::bench
