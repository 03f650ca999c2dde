// Fabrics fitted to measurements.
#include "muslin/fit/fit.hpp"

#include <optional>
#include <string>

#include "bindings.hpp"
#include "callbacks.hpp"
#include "paths.hpp"
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "muslin/core/output_file.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muslin::python {

void bind_fit(nb::module_& m) {
  nb::class_<FittedValue>(m, "FittedValue", "A number or a curve of a fitted material.")
      .def_ro("key", &FittedValue::key, "Its key in [shell].")
      .def_ro("value", &FittedValue::value,
              "In SI units; 0 of a curve, which is among the material's curves.")
      .def_ro("unit", &FittedValue::unit)
      .def_ro("plus_minus", &FittedValue::plus_minus,
              "Standard uncertainty, of a curve as a share of its forces; None: not known.")
      .def_ro("residual", &FittedValue::residual,
              "Of a curve: root of the squares of what is left over those measured.")
      .def_ro("origin", &FittedValue::from, "The measurement, or the rule of a guess.")
      .def_ro("guess", &FittedValue::guess)
      .def("__repr__", [](const FittedValue& value) { return "<muslin.FittedValue " + value.key + ">"; });
  nb::class_<Fit>(m, "FabricFit", "A material fitted to measurements.")
      .def_ro("material", &Fit::material)
      .def_ro("text", &Fit::text, "The material file.")
      .def_ro("values", &Fit::values)
      .def_ro("notes", &Fit::notes)
      .def_ro("warnings", &Fit::warnings, "Of measurements that contradict each other.")
      .def_ro("simulated_drape", &Fit::simulated_drape, "Drape coefficient of the material, a share; None.")
      .def(
          "write", [](const Fit& fit, const FilePath& file) { write_atomically(file, fit.text); }, "file"_a,
          "Writes the material file.")
      .def("__str__", &fit_table)
      .def("__repr__", [](const Fit& fit) { return "<muslin.FabricFit " + fit.material.name + ">"; });
  m.def(
      "fit",
      [](const FilePath& measurements, int rings, int drops, const Report& progress, const Cancel& cancel) {
        if (rings < 3 || drops < 1)
          throw Error(ErrorKind::usage, "fewer than 3 rings or no drop", "give rings >= 3 and drops >= 1");
        const nb::gil_scoped_release nogil;
        DrapeOptions options;
        options.rings = rings;
        options.drops = drops;
        return fit_fabric(read_measurements(measurements), options, progress_of(progress, cancel));
      },
      "measurements"_a, nb::kw_only(), "rings"_a = 9, "drops"_a = 2, "progress"_a = nb::none(),
      "cancel"_a = nb::none(),
      "Fits a material to a file of measurements, as `muslin fit` does. rings: cells of a simulated drape\n"
      "from its support to its edge; drops: simulated drapes that are averaged.");
}

}  // namespace muslin::python
