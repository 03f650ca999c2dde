// Reads and writes the tables of a run: diagnostics.csv, probes.csv, pins.csv, attachments.csv
// and stretch.csv.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "muslin/simulation/simulation.hpp"

namespace muslin {

/// First lines of the tables, with their line ends.
extern const std::string_view diagnostics_header;
extern const std::string_view probes_header;
extern const std::string_view pins_header;
extern const std::string_view attachments_header;
extern const std::string_view stretch_header;

/// Returns one line. Reading the numbers back gives the same doubles; infinity is `inf`.
std::string diagnostics_row(const Diagnostics& row);
/// Returns one line per probe of the model.
std::string probe_rows(const Simulation& simulation);
/// Return one line per pin, and per attachment, of the model.
std::string pin_rows(const Simulation& simulation);
std::string attachment_rows(const Simulation& simulation);
std::string stretch_row(const LimitedStretch& row);

/// Returns the rows of a diagnostics table; an unfinished last line is left out. Tables of earlier versions
/// have no columns after wall_ms; these values are then 0. Errors: file, input.
std::vector<Diagnostics> read_diagnostics(const std::filesystem::path& path);
/// Returns the rows of a table of stretches; an unfinished last line is left out. Errors: file, input.
std::vector<LimitedStretch> read_stretches(const std::filesystem::path& path);

/// Returns for each frame of a table of attachments how many joints of one hold; −1 without a row. Errors:
/// file.
std::vector<int> read_holding(const std::filesystem::path& path, const std::string& attachment);

/// Returns the length of the part of a table up to and including the rows of `last_frame` (the first column).
/// 0 if the text is not a table.
std::size_t table_length(std::string_view table, int last_frame);

}  // namespace muslin
