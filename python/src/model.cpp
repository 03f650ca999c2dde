// The model: all that does not change during a run.
#include <memory>
#include <optional>
#include <string>

#include "arrays.hpp"
#include "bindings.hpp"
#include "callbacks.hpp"
#include "json.hpp"
#include "simulation_object.hpp"
#include <fmt/format.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "muslin/hosts.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muslin::python {
namespace {

/// Python objects for the parts of `self`, each keeping it alive.
template <class Part, class List>
nb::typed<nb::list, Part> parts(const List& parts, nb::handle self) {
  nb::typed<nb::list, Part> list;
  for (const Part& part : parts) list.append(nb::cast(&part, nb::rv_policy::reference_internal, self));
  return list;
}

void bind_body(nb::module_& m) {
  constexpr auto inside = nb::rv_policy::reference_internal;
  nb::class_<Component>(m, "Body", "A body of a model. Its parts are views of the model.")
      .def_ro("name", &Component::name)
      .def_prop_ro(
          "model", [](const Component& b) { return b.kind(); },
          "\"lattice\" or \"shell\"; of colliders \"rigid\" or \"sequence\".")
      .def_prop_ro(
          "mesh", [](const Component& b) -> const Mesh& { return b.mesh; }, inside,
          "The user's mesh, placed in the world: the skin at rest.")
      .def_prop_ro(
          "solid", [](const Component& b) { return as_lattice(b) ? &as_lattice(b)->solid : nullptr; }, inside,
          nb::sig("def solid(self) -> Mesh | None"), "The closed mesh that was filled with voxels.")
      .def_prop_ro(
          "report", [](const Component& b) -> const MeshReport& { return b.report; }, inside, "Of the mesh.")
      .def_prop_ro(
          "is_collider", [](const Component& b) { return b.is_collider(); },
          "Of [[collider]], not of [[body]].")
      .def_prop_ro(
          "prescribed", [](const Component& b) { return b.is_prescribed(); },
          "True for scripted motion: forces do not move it, and it has no mass.")
      .def_ro("sheet", &Component::sheet, "Thin: a shell, or a mesh that was given a thickness.")
      .def_prop_ro(
          "thickness", [](const Component& b) { return as_lattice(b) ? as_lattice(b)->thickness : 0; },
          "Of a sheet of voxels [m].")
      .def_prop_ro(
          "lattice", [](const Component& b) { return as_lattice(b) ? &as_lattice(b)->lattice : nullptr; },
          inside, nb::sig("def lattice(self) -> Lattice | None"))
      .def_prop_ro(
          "springs", [](const Component& b) { return as_lattice(b) ? &as_lattice(b)->springs : nullptr; },
          inside, nb::sig("def springs(self) -> Springs | None"))
      .def_prop_ro(
          "contour", [](const Component& b) { return as_lattice(b) ? &as_lattice(b)->contour : nullptr; },
          inside, nb::sig("def contour(self) -> Contour | None"))
      .def_prop_ro(
          "shell", [](const Component& b) { return as_shell(b) ? &as_shell(b)->shell : nullptr; }, inside,
          nb::sig("def shell(self) -> Shell | None"))
      .def_prop_ro(
          "skin", [](const Component& b) -> const Embedding& { return b.skin; }, inside,
          "From the body's vertices to those of its mesh.")
      .def_ro("first_vertex", &Component::first_vertex, "In arrays of all bodies.")
      .def_ro("vertex_count", &Component::vertex_count)
      .def_prop_ro(
          "vertices",
          [](const Component& b) { return nb::slice(b.first_vertex, b.first_vertex + b.vertex_count, 1); },
          "The slice of its vertices in arrays of all bodies.")
      .def_prop_ro(
          "mass", [](const Component& b) { return b.statistics.mass; }, "[kg]")
      .def("__repr__", [](const Component& b) {
        return fmt::format("<muslin.Body {}: {}, {} vertices>", b.name, b.kind(), b.vertex_count);
      });
}

}  // namespace

void bind_model(nb::module_& m) {
  bind_body(m);
  using SelfPin = nb::pointer_and_handle<Pin>;
  nb::class_<Pin>(m, "Pin", "Vertices that are held, and when.")
      .def_ro("name", &Pin::name)
      .def_prop_ro(
          "vertices", [](SelfPin self) { return view(self.p->vertices, self.h); },
          "(n,) in arrays of all bodies, ascending.")
      .def_ro("begin", &Pin::from, "[s]")
      .def_ro("end", &Pin::until, "[s]");

  using Self = nb::pointer_and_handle<Model>;
  nb::class_<Model>(m, "Model", "All data that is constant during a run. Its arrays are read-only views.")
      .def_prop_ro(
          "scene", [](const Model& model) -> const Scene& { return model.scene; },
          nb::rv_policy::reference_internal)
      .def_prop_ro("bodies", [](Self self) { return parts<Component>(self.p->bodies, self.h); })
      .def(
          "body",
          [](const Model& model, const std::string& name) -> const Component& {
            return find_body(model, name);
          },
          "name"_a, nb::rv_policy::reference_internal, "The body of this name.")
      .def_prop_ro("pins", [](Self self) { return parts<Pin>(self.p->pins, self.h); })
      .def_prop_ro(
          "rest_positions", [](Self self) { return view(self.p->rest_positions, self.h); },
          "(V, 3) of all bodies, one after the other [m].")
      .def_prop_ro(
          "masses", [](Self self) { return view(self.p->masses, self.h); },
          "(V,) [kg]; 0 for prescribed vertices.")
      .def_prop_ro("vertex_count", &Model::vertex_count)
      .def_ro("warnings", &Model::warnings, "Warnings for the user before a run.")
      .def(
          "crossings",
          [](const Model& model, const std::optional<ArrayLike>& positions) {
            std::vector<Vec3> at = model.rest_positions;
            if (positions) at = as_vectors(*positions, "positions", model.vertex_count());
            std::vector<std::string> sentences;
            if (!model.contact) return sentences;
            const nb::gil_scoped_release nogil;
            for (const Crossing& crossing :
                 one_of_each_pair(*model.contact, find_crossings(*model.contact, at)))
              sentences.push_back(describe(*model.contact, crossing));
            return sentences;
          },
          "positions"_a = nb::none(),
          "Where surfaces cross or are too close at these positions (V, 3), or at the start: a sentence "
          "each. Such\n"
          "positions are refused by simulations.")
      .def(
          "describe", [](const Model& model) { return from_json(describe_json(model)); },
          "What `muslin check --json` prints, as Python objects.")
      .def("__str__", [](const Model& model) { return describe_text(model); })
      .def("__repr__", [](const Model& model) {
        return fmt::format("<muslin.Model \"{}\": {} bodies, {} vertices>", model.scene.title,
                           model.bodies.size(), model.vertex_count());
      });
  m.def(
      "build_model",
      [](const Scene& scene, const Report& progress, const Cancel& cancel) {
        const nb::gil_scoped_release nogil;
        return std::make_shared<const Model>(build_model(scene, progress_of(progress, cancel)));
      },
      "scene"_a, nb::kw_only(), "progress"_a = nb::none(), "cancel"_a = nb::none(),
      "Reads the meshes and builds everything.");
}

}  // namespace muslin::python
