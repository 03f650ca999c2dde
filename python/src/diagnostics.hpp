// Diagnostics of frames as Python objects.
#pragma once

#include <vector>

#include <nanobind/nanobind.h>

#include "muslin/hosts.hpp"

namespace nb = nanobind;

namespace muslin::python {

class Columns : public nb::dict {
  static bool is_dict(nb::handle h) { return nb::isinstance<nb::dict>(h); }
  NB_OBJECT_DEFAULT(Columns, nb::dict, "dict[str, numpy.typing.NDArray[typing.Any]]", is_dict)
};

/// An array per column, one entry per row; `momentum` has shape (n, 3).
Columns columns_of(const std::vector<Diagnostics>& rows);

void bind_diagnostics(nb::module_& m);

}  // namespace muslin::python
