// The lattice: voxels, vertices, springs, tetrahedra, and the points it carries.
#include <algorithm>

#include "arrays.hpp"
#include "bindings.hpp"
#include "callbacks.hpp"
#include "errors.hpp"
#include <fmt/format.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include "muslin/hosts.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muslin::python {
namespace {

const std::vector<std::string> spring_kinds = {"edge", "face_diagonal", "body_diagonal"};

/// The two ends of each spring, in order.
std::vector<std::array<int, 2>> ends_of(const Springs& springs) {
  std::vector<std::array<int, 2>> ends(static_cast<std::size_t>(springs.count));
  for (const SpringRun& run : springs.runs) {
    for (int i = 0; i < run.length; ++i)
      ends[static_cast<std::size_t>(run.first + i)] = {run.a + i, run.b + i};
  }
  return ends;
}

std::vector<std::uint8_t> kinds_of(const Springs& springs) {
  std::vector<std::uint8_t> kinds(static_cast<std::size_t>(springs.count));
  for (const SpringRun& run : springs.runs) {
    const SpringKind kind = springs.directions[static_cast<std::size_t>(run.direction)].kind;
    std::fill_n(kinds.begin() + run.first, run.length, static_cast<std::uint8_t>(kind));
  }
  return kinds;
}

int vertices_needed(const Embedding& embedding) {
  int highest = -1;
  for (const auto& vertices : embedding.vertices)
    highest = std::max(highest, *std::max_element(vertices.begin(), vertices.end()));
  return highest + 1;
}

std::vector<Vec3> apply(const Embedding& embedding, const ArrayLike& q) {
  const std::vector<Vec3> vertices = as_vectors(q, "q");
  if (vertices.size() < static_cast<std::size_t>(vertices_needed(embedding))) {
    throw Error(ErrorKind::usage, fmt::format("q: it has {} rows", vertices.size()),
                fmt::format("give the positions of all vertices, at least {}", vertices_needed(embedding)));
  }
  std::vector<Vec3> points(embedding.size());
  embedding.apply(vertices, points);
  return points;
}

std::vector<Vec3> transpose(const Embedding& embedding, const ArrayLike& forces, std::size_t vertex_count) {
  const std::vector<Vec3> f = as_vectors(forces, "forces", embedding.size());
  if (vertex_count < static_cast<std::size_t>(vertices_needed(embedding))) {
    throw Error(ErrorKind::usage, fmt::format("vertex_count is {}", vertex_count),
                fmt::format("give the number of vertices, at least {}", vertices_needed(embedding)));
  }
  std::vector<Vec3> result(vertex_count, Vec3::Zero());
  embedding.add_transpose(f, result);
  return result;
}

}  // namespace

void bind_lattice(nb::module_& m) {
  using SelfLattice = nb::pointer_and_handle<Lattice>;
  nb::class_<Lattice>(
      m, "Lattice",
      "The voxels of a solid. Voxel (i, j, k) spans origin + width·[i, i+1]×[j, j+1]×[k, k+1]; voxels\n"
      "and vertices are sorted by (j, k, i).")
      .def_prop_ro(
          "origin", [](const Lattice& l) { return to_array(l.origin); }, nb::rv_policy::automatic,
          "Corner of voxel (0, 0, 0) [m].")
      .def_ro("width", &Lattice::width, "Edge of a voxel [m].")
      .def_prop_ro(
          "extent", [](const Lattice& l) { return to_array(l.extent); }, nb::rv_policy::automatic,
          "Voxels of the bounding grid along x, y, z.")
      .def_prop_ro(
          "voxels", [](SelfLattice self) { return view(self.p->voxels, self.h); }, "(C, 3) kept voxels.")
      .def_prop_ro(
          "fill", [](SelfLattice self) { return view(self.p->fill, self.h); },
          "(C,) share of each voxel that the solid fills.")
      .def_prop_ro(
          "voxel_vertices", [](SelfLattice self) { return view(self.p->voxel_vertices, self.h); },
          "(C, 8) corner c lies at offset (c & 1, c >> 1 & 1, c >> 2 & 1).")
      .def_prop_ro(
          "vertices", [](SelfLattice self) { return view(self.p->vertices, self.h); },
          "(V, 3) whole coordinates.")
      .def_prop_ro("vertex_count", &Lattice::vertex_count)
      .def_prop_ro("voxel_count", &Lattice::voxel_count)
      .def_ro("coverage", &Lattice::coverage, "Share of the mesh's area that lies inside kept voxels.")
      .def(
          "rest_positions",
          [](const Lattice& l) {
            std::vector<Vec3> positions(l.vertex_count());
            for (std::size_t v = 0; v < positions.size(); ++v) positions[v] = l.rest_position(v);
            return taken(std::move(positions));
          },
          "(V, 3) origin + width·vertices [m].")
      .def(
          "find_voxel",
          [](const Lattice& l, const ArrayLike& at) {
            return l.find_voxel(as_whole_vector(at, "coordinates"));
          },
          "coordinates"_a, "Index of the voxel (i, j, k), -1 if it is not kept.")
      .def(
          "find_vertex",
          [](const Lattice& l, const ArrayLike& at) {
            return l.find_vertex(as_whole_vector(at, "coordinates"));
          },
          "coordinates"_a, "Index of the vertex (i, j, k), -1 if there is none.")
      .def("__repr__", [](const Lattice& l) {
        return fmt::format("<muslin.Lattice {} voxels of {} m, {} vertices>", l.voxel_count(), l.width,
                           l.vertex_count());
      });

  m.def(
      "build_lattice",
      [](const Mesh& mesh, const SignedDistance& distance, double width, const std::string& voxels,
         double threshold, const Report& progress, const Cancel& cancel) {
        const LatticeSettings settings{
            width, static_cast<VoxelRule>(choice(voxels, voxel_rule_names(), "voxel rule")), threshold};
        const nb::gil_scoped_release nogil;
        return build_lattice(mesh, distance, settings, progress_of(progress, cancel));
      },
      "mesh"_a, "distance"_a, "width"_a, nb::kw_only(), "voxels"_a = "cover", "threshold"_a = 0.5,
      "progress"_a = nb::none(), "cancel"_a = nb::none(),
      "The lattice of the solid that `mesh` encloses; `distance` is its field, `width` the edge of a voxel "
      "[m].\n"
      "voxels: \"cover\" keeps every voxel that meets the solid, \"threshold\" those whose centre is nearer "
      "than\n"
      "threshold·width.");

  using SelfSprings = nb::pointer_and_handle<Springs>;
  nb::class_<Springs>(m, "Springs", "The springs of a lattice, by direction.")
      .def_ro("count", &Springs::count)
      .def_prop_ro(
          "count_by_kind",
          [](const Springs& s) {
            nb::typed<nb::dict, nb::str, nb::int_> counts;
            for (std::size_t k = 0; k < spring_kinds.size(); ++k)
              counts[spring_kinds[k].c_str()] = s.count_by_kind[k];
            return counts;
          },
          "Number of \"edge\", \"face_diagonal\" and \"body_diagonal\" springs.")
      .def(
          "ends", [](const Springs& s) { return taken(ends_of(s)); },
          "(S, 2) vertices that each spring joins.")
      .def(
          "kinds", [](const Springs& s) { return taken(kinds_of(s)); },
          "(S,) 0 edge, 1 face diagonal, 2 body diagonal.")
      .def_prop_ro(
          "share", [](SelfSprings self) { return view(self.p->share, self.h); },
          "(S,) voxels around each spring, by their fill, over the number inside a solid.")
      .def_prop_ro(
          "mean_fill", [](SelfSprings self) { return view(self.p->mean_fill, self.h); },
          "(S,) mean fill of the voxels around each spring.");
  m.def(
      "build_springs",
      [](const Lattice& lattice, const std::string& bracing) {
        const auto kind = static_cast<Bracing>(choice(bracing, bracing_names(), "bracing"));
        const nb::gil_scoped_release nogil;
        return build_springs(lattice, kind);
      },
      "lattice"_a, "bracing"_a = "kuhn",
      "bracing: \"kuhn\", along the edges of six tetrahedra a voxel, or \"full\", along all diagonals.");
  m.def(
      "build_tetrahedra", [](const Lattice& lattice) { return taken(build_tetrahedra(lattice)); },
      "lattice"_a, "(6·C, 4) six positively oriented tetrahedra per voxel; faces of neighbours match.");

  using SelfEmbedding = nb::pointer_and_handle<Embedding>;
  nb::class_<Embedding>(m, "Embedding", "Points as weighted sums of vertices: the linear map x = J q.")
      .def_prop_ro(
          "vertices", [](SelfEmbedding self) { return view(self.p->vertices, self.h); },
          "(P, 8) vertex of each term.")
      .def_prop_ro(
          "weights", [](SelfEmbedding self) { return view(self.p->weights, self.h); },
          "(P, 8) its weight; they add up to 1.")
      .def("__len__", &Embedding::size)
      .def(
          "apply", [](const Embedding& e, const ArrayLike& q) { return taken(apply(e, q)); }, "q"_a,
          "J q: from vertex positions (V, 3) to points (P, 3).")
      .def(
          "transpose",
          [](const Embedding& e, const ArrayLike& forces, std::size_t count) {
            return taken(transpose(e, forces, count));
          },
          "forces"_a, "vertex_count"_a, "Jᵀ f: from forces on points (P, 3) to forces on vertices (V, 3).");
  m.def(
      "embed",
      [](const Lattice& lattice, const ArrayLike& points) {
        const std::vector<Vec3> given = as_vectors(points, "points");
        const nb::gil_scoped_release nogil;
        return embed(lattice, given);
      },
      "lattice"_a, "points"_a,
      "Trilinear weights of points (P, 3) [m] at rest; outside, those of the nearest voxel.");
}

}  // namespace muslin::python
