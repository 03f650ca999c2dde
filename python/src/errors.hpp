// Errors of the engine as Python exceptions: the classes of muslin/errors.py.
#pragma once

#include <string>
#include <vector>

namespace muslin::python {

/// From now on muslin::Error and file system errors arrive in Python as muslin.Error and its subclasses.
void translate_errors();

/// The index of `word` among `names`. Errors: usage, naming the nearest one.
std::size_t choice(const std::string& word, const std::vector<std::string>& names, const std::string& what);

}  // namespace muslin::python
