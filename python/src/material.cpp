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
using Curve = nb::typed<nb::list, nb::typed<nb::tuple, nb::float_, nb::float_>>;

Numbers as_dict(const std::vector<MaterialNumber>& numbers) {
  Numbers dict;
  for (const MaterialNumber& number : numbers) dict[number.key.c_str()] = number.value;
  return dict;
}

}  // namespace

void bind_material(nb::module_& m) {
  nb::class_<Material>(m, "Material", "What a body is made of.")
      .def_ro("name", &Material::name)
      .def_ro("description", &Material::description)
      .def_ro("source", &Material::source, "Source of the numbers.")
      .def_ro("guesses", &Material::guesses, "Numbers that are not measured, such as shell.poisson.")
      .def_prop_ro(
          "lattice", [](const Material& material) { return as_dict(lattice_numbers(material)); },
          "Numbers of a lattice by the keys of the scene file, in SI units; empty if it has none.")
      .def_prop_ro(
          "shell", [](const Material& material) { return as_dict(shell_numbers(material)); },
          "Numbers of a shell by the keys of the scene file, in SI units; empty if it has none.")
      .def_prop_ro(
          "curves",
          [](const Material& material) {
            nb::typed<nb::dict, nb::str, Curve> curves;
            for (const MaterialCurve& curve : shell_curves(material)) {
              Curve points;
              for (const Vec2& point : curve.points) points.append(nb::make_tuple(point[0], point[1]));
              curves[curve.key.c_str()] = points;
            }
            return curves;
          },
          "Measured curves of a shell by the keys of the scene file: lists of points; empty if it has none.")
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
  m.def(
      "parse_material",
      [](const std::string& text, const std::string& file) { return parse_material(text, file); }, "text"_a,
      "file"_a = "material.toml", "The same for a text; `file` is the name that messages carry.");
}

}  // namespace muslin::python
