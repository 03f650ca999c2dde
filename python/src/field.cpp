// The distance field: exact values at points, samples on a grid, printed slices.
#include <limits>
#include <optional>

#include "arrays.hpp"
#include "bindings.hpp"
#include "callbacks.hpp"
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include "muslin/hosts.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muslin::python {
namespace {

constexpr std::size_t grain = 64;

/// One number per point, in parallel without the GIL.
template <class Number, class At>
Array<Number, -1> at_points(const ArrayLike& array, const At& at) {
  const std::vector<Vec3> points = as_vectors(array, "points");
  std::vector<Number> values(points.size());
  {
    const nb::gil_scoped_release nogil;
    parallel_for(points.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) values[i] = at(points[i]);
    });
  }
  return taken(std::move(values));
}

}  // namespace

void bind_field(nb::module_& m) {
  nb::class_<SignedDistance>(
      m, "SignedDistance",
      "The signed distance of any mesh, exact to rounding, negative inside; the sign is that\n"
      "of the generalised winding number, so holes and soup have an inside too.")
      .def(nb::init<const Mesh&>(), "mesh"_a, nb::call_guard<nb::gil_scoped_release>())
      .def(
          "__call__",
          [](const SignedDistance& self, const ArrayLike& points) {
            return at_points<double>(points, [&](const Vec3& x) { return self(x); });
          },
          "points"_a, "At points (n, 3) [m]: shape (n,) [m].")
      .def(
          "distance",
          [](const SignedDistance& self, const ArrayLike& points) {
            return at_points<double>(points, [&](const Vec3& x) { return self.distance(x); });
          },
          "points"_a, "Without sign.")
      .def(
          "inside",
          [](const SignedDistance& self, const ArrayLike& points) {
            const auto inside = at_points<std::uint8_t>(
                points, [&](const Vec3& x) -> std::uint8_t { return self.inside(x) ? 1 : 0; });
            return nb::cast(inside).attr("view")("bool");
          },
          "points"_a,
          nb::sig("def inside(self, points: numpy.typing.ArrayLike) -> numpy.typing.NDArray[numpy.bool_]"),
          "Whether each point (n, 3) is inside.")
      .def_prop_ro("watertight", &SignedDistance::watertight,
                   "Whether the sign changes only at the surface: each edge is traversed equally often in "
                   "both directions.")
      .def_prop_ro(
          "bounds", [](const SignedDistance& self) { return to_array(self.bounds()); },
          nb::rv_policy::automatic, "Lowest and highest corner [m], shape (2, 3).");

  nb::class_<DistanceField>(m, "DistanceField", "Samples of the signed distance on a regular grid.")
      .def_prop_ro(
          "origin", [](const DistanceField& f) { return to_array(f.grid.origin); }, nb::rv_policy::automatic,
          "Of sample 0 [m].")
      .def_prop_ro(
          "width", [](const DistanceField& f) { return f.grid.width; }, "Between samples [m].")
      .def_ro("band", &DistanceField::band, "Samples farther away than this are set to ± this value [m].")
      .def_prop_ro(
          "values",
          [](nb::pointer_and_handle<DistanceField> self) {
            const Vec3i& n = self.p->grid.samples;
            return Array<const float, -1, -1, -1>(
                self.p->values.data(),
                {static_cast<std::size_t>(n.z()), static_cast<std::size_t>(n.y()),
                 static_cast<std::size_t>(n.x())},
                self.h);
          },
          "values[k, j, i] at origin + width·(i, j, k) [m].");

  m.def(
      "sample_field",
      [](const SignedDistance& distance, const ArrayLike& origin, double width, const ArrayLike& samples,
         double band, const Report& progress, const Cancel& cancel) {
        const Grid grid{as_vector(origin, "origin"), width, as_whole_vector(samples, "samples")};
        const nb::gil_scoped_release nogil;
        return sample_field(distance, grid, band, progress_of(progress, cancel));
      },
      "distance"_a, "origin"_a, "width"_a, "samples"_a, nb::kw_only(),
      "band"_a = std::numeric_limits<double>::infinity(), "progress"_a = nb::none(), "cancel"_a = nb::none(),
      "The signed distance at origin + width·(i, j, k), samples = (nx, ny, nz). Beyond `band` [m] only its "
      "sign\n"
      "is worked out.");

  m.def(
      "print_field",
      [](const Mesh& mesh, double voxel_width, const std::optional<std::string>& slice,
         const std::string& margin, std::optional<double> thickness, bool csv) {
        FieldPrintSettings settings;
        settings.voxel_width = voxel_width;
        if (slice) settings.slice = parse_slice(*slice);
        settings.margin = parse_margin(margin);
        settings.thickness = thickness;
        settings.csv = csv;
        const nb::gil_scoped_release nogil;
        return print_field(mesh, settings);
      },
      "mesh"_a, "voxel_width"_a, nb::kw_only(), "slice"_a = nb::none(), "margin"_a = "1",
      "thickness"_a = nb::none(), "csv"_a = false,
      "A slice of the distance field as text, what `muslin field` prints. slice: such as \"z=0\"; margin: "
      "rings of\n"
      "samples around the mesh, \"N\" or \"X,Y,Z\"; thickness: of an open mesh [m].");
}

}  // namespace muslin::python
