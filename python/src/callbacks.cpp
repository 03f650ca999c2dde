#include "callbacks.hpp"

namespace muslin::python {

bool is_cancelled(const Cancel& cancel) {
  const nb::gil_scoped_acquire gil;
  if (PyErr_CheckSignals() != 0) throw nb::python_error();
  return cancel && nb::cast<bool>(nb::bool_(nb::object((*cancel)())));
}

Progress progress_of(const Report& report, const Cancel& cancel) {
  Progress progress;
  if (report) {
    progress.report = [&report](double fraction, std::string_view stage) {
      const nb::gil_scoped_acquire gil;
      (*report)(fraction, nb::str(stage.data(), stage.size()));
    };
  }
  progress.cancelled = [&cancel] { return is_cancelled(cancel); };
  return progress;
}

}  // namespace muslin::python
