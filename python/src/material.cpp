// The materials that come with muslin, and material files.
#include <filesystem>
#include <optional>

#include "bindings.hpp"
#include "paths.hpp"
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "muslin/hosts.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muslin::python {
namespace {

using Numbers = nb::typed<nb::dict, nb::str, nb::float_>;

Numbers lattice_numbers(const Material& material) {
  Numbers numbers;
  if (!material.has_lattice) return numbers;
  numbers["density"] = material.density;
  numbers["edge_modulus"] = material.edge_modulus;
  numbers["face_diagonal_modulus"] = material.face_diagonal_modulus;
  numbers["body_diagonal_modulus"] = material.body_diagonal_modulus;
  numbers["volume_modulus"] = material.volume_modulus;
  numbers["mass_damping"] = material.mass_damping;
  numbers["stiffness_damping"] = material.stiffness_damping;
  if (material.young_modulus > 0) {
    numbers["young_modulus"] = material.young_modulus;
    numbers["poisson"] = material.poisson;
  }
  return numbers;
}

Numbers shell_numbers(const Material& material) {
  Numbers numbers;
  if (!material.shell) return numbers;
  const ShellMaterial& shell = *material.shell;
  numbers["areal_density"] = shell.areal_density;
  numbers["membrane_warp"] = shell.membrane_warp;
  numbers["membrane_weft"] = shell.membrane_weft;
  numbers["membrane_shear"] = shell.membrane_shear;
  numbers["poisson"] = shell.poisson;
  numbers["bending_warp"] = shell.bending_warp;
  numbers["bending_weft"] = shell.bending_weft;
  numbers["bending_bias"] = shell.bending_bias;
  numbers["mass_damping"] = shell.mass_damping;
  numbers["stiffness_damping"] = shell.stiffness_damping;
  numbers["bending_damping"] = shell.bending_damping;
  return numbers;
}

}  // namespace

void bind_material(nb::module_& m) {
  nb::class_<Material>(m, "Material", "What a body is made of.")
      .def_ro("name", &Material::name)
      .def_ro("description", &Material::description)
      .def_ro("source", &Material::source, "Where the numbers are from.")
      .def_prop_ro("lattice", &lattice_numbers,
                   "Numbers of a lattice by the keys of the scene file, in SI units; empty if it has none.")
      .def_prop_ro("shell", &shell_numbers,
                   "Numbers of a shell by the keys of the scene file, in SI units; empty if it has none.")
      .def_prop_ro(
          "reference",
          [](const Material& material) {
            Numbers numbers;
            for (const auto& [key, value] : material.reference) numbers[key.c_str()] = value;
            return numbers;
          },
          "Measured numbers of the real material, for the reader; the simulation uses none.")
      .def("__repr__", [](const Material& material) { return "<muslin.Material " + material.name + ">"; });
  m.def("material_names", &material_names, "The materials that come with muslin, in alphabetical order.");
  m.def("find_material", &find_material, "name"_a, "The material of this name.");
  m.def(
      "read_material", [](const FilePath& file) { return read_material(file); }, "file"_a,
      "A material file (.toml).");
}

}  // namespace muslin::python
