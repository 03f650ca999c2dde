// Python callables as the engine's progress reports and cancel polls.
#pragma once

#include <optional>

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>

#include "muslin/core/progress.hpp"

namespace nb = nanobind;

namespace muslin::python {

/// progress(fraction, stage): the finished share from 0 to 1, and what is being done.
using Report = std::optional<nb::typed<nb::callable, nb::object(double, nb::str)>>;
/// cancel() → bool: true stops the work with muslin.Interrupted.
using Cancel = std::optional<nb::typed<nb::callable, bool()>>;

/// Calls them with the GIL taken, for work that runs without it. Ctrl-C is looked for at every poll: it
/// leaves the work as KeyboardInterrupt. What the callables raise leaves it as it is. Valid as long as both
/// are.
Progress progress_of(const Report& report, const Cancel& cancel);

/// Polls for Ctrl-C and calls `cancel`. Takes the GIL.
bool is_cancelled(const Cancel& cancel);

}  // namespace muslin::python
