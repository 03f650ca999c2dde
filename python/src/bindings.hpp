// One function per part of the façade; module.cpp calls them in this order.
#pragma once

#include <nanobind/nanobind.h>

namespace muslin::python {

void bind_mesh(nanobind::module_& m);
void bind_field(nanobind::module_& m);
void bind_lattice(nanobind::module_& m);
void bind_surface(nanobind::module_& m);
void bind_material(nanobind::module_& m);
void bind_scene(nanobind::module_& m);
void bind_model(nanobind::module_& m);
void bind_simulation(nanobind::module_& m);
void bind_run(nanobind::module_& m);
void bind_picture(nanobind::module_& m);
void bind_run_report(nanobind::module_& m);
void bind_fit(nanobind::module_& m);
void bind_toml(nanobind::module_& m);

}  // namespace muslin::python
