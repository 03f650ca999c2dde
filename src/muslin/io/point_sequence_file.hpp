// Reads animated points from PC2 and MDD point caches and numbered OBJ files.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "muslin/geometry/point_sequence.hpp"

namespace muslin {

/// Sample n of a `.pc2` is at start + n·rate frames; an `.mdd` states its times. `NAME.####.obj` are the
/// files with a number in place of the #, in ascending order, one per frame; only their vertices are read. A
/// frame lasts 1/frame_rate; positions are metres, y up. Errors: file; input, if the file is damaged, has no
/// sample or a position that is not finite or beyond 1e9 m.
PointSequence read_point_sequence(const std::filesystem::path& path, double frame_rate);

/// The two caches from memory; `suffix` is ".pc2" or ".mdd", `file` is for messages.
PointSequence read_point_sequence_from(std::string_view bytes, const std::string& suffix,
                                       const std::string& file, double frame_rate);

}  // namespace muslin
