// Reads files that hold one number for each vertex of a mesh.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace muslin {

/// True if the name of a file ends as that of one which read_numbers reads.
bool is_number_file(std::string_view name);

/// Reads a list of numbers. A `.csv` file has one number a line, below a first line of text if there is one.
/// A `.npy` file (NumPy's format, version 1 to 3) holds an array of one dimension of floats, integers or
/// truths. Errors: file, if it cannot be read; input, if it is malformed or a number is not finite, with file
/// and, in `.csv`, line.
std::vector<double> read_numbers(const std::filesystem::path& path);

/// Reads them from memory; `file` is for messages, and its end names the format.
std::vector<double> read_numbers_from(std::string_view bytes, const std::string& file);

}  // namespace muslin
