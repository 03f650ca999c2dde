// Bindings of contours and shells.
#include <optional>

#include "arrays.hpp"
#include "bindings.hpp"
#include "errors.hpp"
#include <fmt/format.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include "muslin/hosts.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muslin::python {
namespace {

const std::vector<std::string> contour_methods = {"squares", "cubes"};

template <class Value>
std::vector<Value> of_hinges(const Shell& shell, Value Hinge::* value) {
  std::vector<Value> values;
  values.reserve(shell.hinges.size());
  for (const Hinge& hinge : shell.hinges) values.push_back(hinge.*value);
  return values;
}

}  // namespace

void bind_surface(nb::module_& m) {
  nb::class_<Contour>(m, "Contour", "The surface by marching squares or cubes, carried by a lattice.")
      .def_prop_ro(
          "method", [](const Contour& c) { return contour_methods[static_cast<std::size_t>(c.method)]; },
          "\"squares\" (flat shapes) or \"cubes\".")
      .def_prop_ro(
          "mesh", [](const Contour& c) -> const Mesh& { return c.mesh; }, nb::rv_policy::reference_internal,
          "Triangles at rest, closed, facing outward.")
      .def_prop_ro(
          "embedding", [](const Contour& c) -> const Embedding& { return c.embedding; },
          nb::rv_policy::reference_internal, "Of its vertices.")
      .def_ro("distance", &Contour::distance,
              "Largest distance of contour and solid from each other at rest [m].");
  m.def(
      "build_contour",
      [](const Lattice& lattice, const Mesh& solid, const SignedDistance& distance,
         const std::string& method) {
        const auto chosen = static_cast<ContourMethod>(choice(method, contour_methods, "contour method"));
        const nb::gil_scoped_release nogil;
        return build_contour(lattice, solid, distance, chosen);
      },
      "lattice"_a, "solid"_a, "distance"_a, "method"_a = "cubes",
      "The contour of `solid`, the closed mesh that the lattice was built from, `distance` its field. "
      "\"squares\" is\n"
      "for lattices one voxel thick.");

  using SelfShell = nb::pointer_and_handle<Shell>;
  nb::class_<Shell>(m, "Shell", "A triangle mesh as thin cloth: triangles with threads, hinges between them.")
      .def_prop_ro(
          "triangles", [](SelfShell self) { return view(self.p->triangles, self.h); }, "(T, 3) vertices.")
      .def_prop_ro(
          "faces", [](SelfShell self) { return view(self.p->faces, self.h); },
          "(T,) polygon that each triangle comes from.")
      .def_prop_ro(
          "areas", [](SelfShell self) { return view(self.p->areas, self.h); }, "(T,) at rest [m²].")
      .def_prop_ro(
          "vertex_areas", [](SelfShell self) { return view(self.p->vertex_areas, self.h); },
          "(V,) a third of each adjacent triangle at rest [m²].")
      .def_ro("area", &Shell::area, "At rest [m²].")
      .def_ro("mean_edge", &Shell::mean_edge, "At rest [m].")
      .def(
          "hinges", [](const Shell& s) { return taken(of_hinges(s, &Hinge::vertices)); },
          "(H, 4) the shared edge of two triangles, then the two vertices opposite to it.")
      .def(
          "hinge_angles", [](const Shell& s) { return taken(of_hinges(s, &Hinge::angle)); },
          "(H,) between the normals at rest [rad].")
      .def(
          "hinge_lengths", [](const Shell& s) { return taken(of_hinges(s, &Hinge::length)); },
          "(H,) of the edges at rest [m].")
      .def(
          "max_stretch",
          [](const Shell& s, const ArrayLike& positions) {
            return max_stretch(s, as_vectors(positions, "positions", s.vertex_count()));
          },
          "positions"_a, "Largest stretch of any triangle in any direction at these positions (V, 3).");
  m.def(
      "build_shell",
      [](const Mesh& mesh, const std::optional<ArrayLike>& rest_positions,
         const std::optional<ArrayLike>& warp) {
        std::vector<Vec3> rest = mesh.positions;
        if (rest_positions) rest = as_vectors(*rest_positions, "rest_positions", mesh.vertex_count());
        Weave weave;
        if (warp) {
          weave.warp = as_vector(*warp, "warp");
          if (!(weave.warp->norm() > 0))
            throw Error(ErrorKind::usage, "warp is no direction", "give a vector along the warp threads");
        }
        const nb::gil_scoped_release nogil;
        return build_shell(mesh, rest, weave);
      },
      "mesh"_a, "rest_positions"_a = nb::none(), "warp"_a = nb::none(),
      "rest_positions: the shape without stress (V, 3) [m]; warp: direction of the warp threads, else along "
      "the\n"
      "texture's u, or the longest side of a mesh without texture coordinates.");
}

}  // namespace muslin::python
