// The extension module muslin._muslin.
#include "bindings.hpp"
#include "errors.hpp"
#include <nanobind/nanobind.h>

#include "muslin/hosts.hpp"

namespace nb = nanobind;
using namespace nb::literals;

NB_MODULE(_muslin, m) {
  using namespace muslin::python;
  m.doc() = "The engine of muslin.";
  m.def("version", &muslin::version, "MAJOR.MINOR.PATCH of the engine.");
  translate_errors();
  m.def(
      "set_thread_count",
      [](int count) {
        if (count < 0) {
          throw muslin::Error(muslin::ErrorKind::usage, "a thread count below 0",
                              "give the number of threads, or 0 for one per core");
        }
        muslin::set_thread_count(count);
      },
      "count"_a,
      "Limits all parallel work of the process to `count` threads; 0 means one per core. Results have the "
      "same\n"
      "bits for any count.");
  m.def("thread_count", &muslin::thread_count, "The number of threads in use.");
  bind_mesh(m);
  bind_field(m);
  bind_lattice(m);
  bind_surface(m);
  bind_material(m);
  bind_scene(m);
  bind_model(m);
  bind_simulation(m);
  bind_run(m);
  bind_picture(m);
  bind_run_report(m);
  bind_fit(m);
  bind_toml(m);
}
