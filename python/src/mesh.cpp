// Meshes: made from arrays, read, written, inspected, thickened.
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "paths.hpp"
#include <fmt/format.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "muslin/hosts.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muslin::python {
namespace {

using Groups = std::map<std::string, ArrayLike>;

void check_index(int index, int lowest, std::size_t count, const std::string& what) {
  if (index >= lowest && static_cast<std::int64_t>(index) < static_cast<std::int64_t>(count)) return;
  throw Error(ErrorKind::usage, fmt::format("{}: there is no number {}", what, index),
              fmt::format("give numbers from {} to {}", lowest, static_cast<std::int64_t>(count) - 1));
}

void add_faces(Mesh& mesh, nb::handle faces) {
  mesh.face_offsets = {0};
  if (!nb::isinstance<nb::iterable>(faces))
    throw Error(ErrorKind::usage, "faces: no list of polygons",
                "give an (n, k) array or a list of index lists");
  for (const nb::handle corners : nb::borrow<nb::iterable>(faces)) {
    const std::string what = fmt::format("faces[{}]", mesh.face_count());
    const std::vector<int> vertices = as_indices(corners, what);
    for (const int v : vertices) check_index(v, 0, mesh.vertex_count(), what);
    mesh.add_face(vertices);
  }
}

void add_uvs(Mesh& mesh, const std::optional<ArrayLike>& uvs, const std::optional<ArrayLike>& corner_uvs) {
  if (!uvs) {
    if (corner_uvs) throw Error(ErrorKind::usage, "corner_uvs needs uvs", "give both");
    return;
  }
  mesh.uvs = as_plane_vectors(*uvs, "uvs");
  if (corner_uvs) {
    mesh.corner_uvs = as_indices(*corner_uvs, "corner_uvs");
    for (const int index : mesh.corner_uvs) check_index(index, -1, mesh.uvs.size(), "corner_uvs");
  } else if (mesh.uvs.size() == mesh.vertex_count()) {
    mesh.corner_uvs = mesh.face_vertices;
  } else {
    throw Error(ErrorKind::usage, fmt::format("{} uvs for {} vertices", mesh.uvs.size(), mesh.vertex_count()),
                "give one for each vertex, or corner_uvs as well");
  }
  if (mesh.corner_uvs.size() != mesh.face_vertices.size()) {
    throw Error(
        ErrorKind::usage,
        fmt::format("{} corner_uvs for {} corners", mesh.corner_uvs.size(), mesh.face_vertices.size()),
        "give one for each corner of each face, -1 where there is none");
  }
}

std::vector<int> ascending(std::vector<int> indices) {
  std::sort(indices.begin(), indices.end());
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
  return indices;
}

/// Groups become part of OBJ files, where a blank ends a name.
void check_group_name(const std::string& name) {
  const bool blank =
      name.empty() || std::any_of(name.begin(), name.end(), [](unsigned char c) { return c <= ' '; });
  if (blank)
    throw Error(ErrorKind::usage, "`" + name + "` cannot be the name of a group",
                "use a name without blanks");
}

Mesh make_mesh(const ArrayLike& positions, const nb::object& faces, const std::optional<ArrayLike>& uvs,
               const std::optional<ArrayLike>& corner_uvs, const Groups& groups, const Groups& face_groups,
               const Groups& materials, const std::string& name) {
  Mesh mesh;
  mesh.name = name;
  mesh.positions = as_vectors(positions, "positions");
  if (mesh.positions.empty()) throw Error(ErrorKind::usage, "there are no positions", "give one per vertex");
  add_faces(mesh, faces);
  require_usable(mesh, name.empty() ? "the mesh" : name);
  add_uvs(mesh, uvs, corner_uvs);
  std::vector<int> of_face(mesh.face_count(), -1);
  for (const auto& [material, members] : materials) {
    const std::string what = "materials[" + material + "]";
    mesh.materials.push_back({material, ascending(as_indices(members, what))});
    for (const int f : mesh.materials.back().faces) {
      check_index(f, 0, mesh.face_count(), what);
      if (std::exchange(of_face[static_cast<std::size_t>(f)], 0) >= 0)
        throw Error(ErrorKind::usage, fmt::format("{}: face {} has a material already", what, f),
                    "give every face one");
    }
  }
  for (const auto& [group, members] : face_groups) {
    check_group_name(group);
    MeshGroup added{group, ascending(as_indices(members, "face_groups[" + group + "]")), {}};
    for (const int f : added.faces) {
      check_index(f, 0, mesh.face_count(), "face_groups[" + group + "]");
      for (const int v : mesh.face(static_cast<std::size_t>(f))) added.vertices.push_back(v);
    }
    added.vertices = ascending(std::move(added.vertices));
    mesh.groups.push_back(std::move(added));
  }
  for (const auto& [group, members] : groups) {
    check_group_name(group);
    MeshGroup added{group, {}, ascending(as_indices(members, "groups[" + group + "]"))};
    for (const int v : added.vertices) check_index(v, 0, mesh.vertex_count(), "groups[" + group + "]");
    if (face_groups.contains(group))
      throw Error(ErrorKind::usage, "`" + group + "` is both in groups and in face_groups", "rename one");
    mesh.groups.push_back(std::move(added));
  }
  return mesh;
}

nb::list faces_of(const Mesh& mesh) {
  nb::list faces;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    nb::list face;
    for (const int v : mesh.face(f)) face.append(v);
    faces.append(nb::tuple(face));
  }
  return faces;
}

Mesh moved(const Mesh& mesh, const ArrayLike& positions) {
  Mesh copy = mesh;
  copy.positions = as_vectors(positions, "positions", mesh.vertex_count());
  return copy;
}

Mesh read(const FilePath& given) {
  const std::filesystem::path& path = given;
  MeshFile file;
  {
    const nb::gil_scoped_release nogil;
    file = read_mesh(path);
  }
  if (!file.note.empty() &&
      PyErr_WarnEx(PyExc_UserWarning, (path.string() + ": " + file.note).c_str(), 1) != 0)
    throw nb::python_error();
  return std::move(file.mesh);
}

void bind_report(nb::module_& m) {
  nb::class_<MeshReport>(m, "MeshReport", "The kind of a mesh and its defects.")
      .def_ro("vertices", &MeshReport::vertices)
      .def_ro("faces", &MeshReport::faces)
      .def_ro("triangles", &MeshReport::triangles)
      .def_ro("components", &MeshReport::components, "Parts that share no vertex.")
      .def_ro("open_edges", &MeshReport::open_edges, "Edges of one face only.")
      .def_ro("non_manifold_edges", &MeshReport::non_manifold_edges, "Edges of three faces or more.")
      .def_ro("near_border_vertices", &MeshReport::near_border_vertices,
              "Vertices on borders that nearly coincide with others but are not joined.")
      .def_ro("near_border_distance", &MeshReport::near_border_distance, "Their largest distance [m].")
      .def_ro("flipped_edges", &MeshReport::flipped_edges,
              "Edges that two faces traverse in the same direction.")
      .def_ro("degenerate_faces", &MeshReport::degenerate_faces, "Faces without area.")
      .def_ro("duplicate_faces", &MeshReport::duplicate_faces)
      .def_ro("unused_vertices", &MeshReport::unused_vertices)
      .def_ro("area", &MeshReport::area, "[m²]")
      .def_ro("volume", &MeshReport::volume, "Enclosed, signed [m³]; meaningful if closed.")
      .def_prop_ro(
          "bounds", [](const MeshReport& r) { return to_array(r.bounds); }, nb::rv_policy::automatic,
          "Lowest and highest corner [m], shape (2, 3).")
      .def_ro("closed", &MeshReport::closed)
      .def_ro("flat_axis", &MeshReport::flat_axis,
              "0, 1, 2 if all lies in a plane x, y or z = const, else -1.")
      .def_ro("warnings", &MeshReport::warnings, "Sentences, each with a remedy.");
}

}  // namespace

void bind_mesh(nb::module_& m) {
  bind_report(m);
  using Self = nb::pointer_and_handle<Mesh>;
  nb::class_<Mesh>(m, "Mesh", "A polygon mesh. Immutable: its arrays are views, and read-only.")
      .def(
          "__init__",
          [](Mesh* self, const ArrayLike& positions, const nb::object& faces,
             const std::optional<ArrayLike>& uvs, const std::optional<ArrayLike>& corner_uvs,
             const Groups& groups, const Groups& face_groups, const Groups& materials,
             const std::string& name) {
            new (self)
                Mesh(make_mesh(positions, faces, uvs, corner_uvs, groups, face_groups, materials, name));
          },
          "positions"_a, "faces"_a, nb::kw_only(), "uvs"_a = nb::none(), "corner_uvs"_a = nb::none(),
          "groups"_a = Groups(), "face_groups"_a = Groups(), "materials"_a = Groups(), "name"_a = "",
          nb::sig(
              "def __init__(self, positions: numpy.typing.ArrayLike, faces: numpy.typing.ArrayLike | "
              "collections.abc.Iterable[collections.abc.Sequence[int]], *, uvs: numpy.typing.ArrayLike | "
              "None = "
              "None, corner_uvs: numpy.typing.ArrayLike | None = None, groups: collections.abc.Mapping[str, "
              "numpy.typing.ArrayLike] = {}, face_groups: collections.abc.Mapping[str, "
              "numpy.typing.ArrayLike] = {}, materials: collections.abc.Mapping[str, "
              "numpy.typing.ArrayLike] = {}, name: str = '') -> None"),
          "From positions [m], shape (V, 3), and polygons: an (F, k) array or lists of vertex indices.\n\n"
          "uvs: texture coordinates (T, 2), one for each vertex, or any number with `corner_uvs`, the index "
          "of\n"
          "each corner of each face, -1 for none. groups: vertices by name; face_groups: faces by name. Pins "
          "and\n"
          "forces choose vertices by the names of both. materials: faces by the name of a material, which "
          "exports\n"
          "keep; a face has at most one.")
      .def_prop_ro(
          "positions", [](Self self) { return view(self.p->positions, self.h); }, "(V, 3) [m]")
      .def_prop_ro(
          "face_offsets", [](Self self) { return view(self.p->face_offsets, self.h); },
          "(F + 1,): face f has corners face_offsets[f] to face_offsets[f + 1] - 1.")
      .def_prop_ro(
          "face_vertices", [](Self self) { return view(self.p->face_vertices, self.h); },
          "(C,) vertex of each corner.")
      .def_prop_ro(
          "uvs", [](Self self) { return view(self.p->uvs, self.h); }, "(T, 2) texture coordinates.")
      .def_prop_ro(
          "corner_uvs", [](Self self) { return view(self.p->corner_uvs, self.h); },
          "(C,) index into uvs, -1 for none; empty if no corner has any.")
      .def_prop_ro(
          "groups",
          [](Self self) {
            nb::typed<nb::dict, nb::str, Array<const int, -1>> groups;
            for (const MeshGroup& group : self.p->groups)
              groups[group.name.c_str()] = view(group.vertices, self.h);
            return groups;
          },
          "The vertices of each group.")
      .def_prop_ro(
          "face_groups",
          [](Self self) {
            nb::typed<nb::dict, nb::str, Array<const int, -1>> groups;
            for (const MeshGroup& group : self.p->groups)
              if (!group.faces.empty()) groups[group.name.c_str()] = view(group.faces, self.h);
            return groups;
          },
          "The faces of each group that has any.")
      .def_prop_ro(
          "materials",
          [](Self self) {
            nb::typed<nb::dict, nb::str, Array<const int, -1>> materials;
            for (const MeshMaterial& material : self.p->materials)
              materials[material.name.c_str()] = view(material.faces, self.h);
            return materials;
          },
          "The faces of each material of the file.")
      .def_prop_ro("faces", &faces_of, nb::sig("def faces(self) -> list[tuple[int, ...]]"),
                   "The vertex indices of each polygon.")
      .def_ro("name", &Mesh::name)
      .def_prop_ro("vertex_count", &Mesh::vertex_count)
      .def_prop_ro("face_count", &Mesh::face_count)
      .def_prop_ro(
          "bounds", [](const Mesh& mesh) { return to_array(mesh.bounds()); }, nb::rv_policy::automatic,
          "Lowest and highest corner of all faces [m], shape (2, 3).")
      .def(
          "triangles",
          [](const Mesh& mesh) {
            const auto [kept, owner] = given_away(triangulate(mesh).triangles);
            return Array<int, -1, 3>(reinterpret_cast<int*>(kept->data()), {kept->size(), 3}, owner);
          },
          "The polygons cut into triangles: vertex indices, shape (T, 3).")
      .def("moved", &moved, "positions"_a, "The same mesh with its vertices at other positions (V, 3) [m].")
      .def("report", &inspect, nb::call_guard<nb::gil_scoped_release>(),
           "Returns the kind of the mesh and its defects.")
      .def("__repr__", [](const Mesh& mesh) {
        return fmt::format("<muslin.Mesh {}{} vertices, {} faces>", mesh.name.empty() ? "" : mesh.name + ": ",
                           mesh.vertex_count(), mesh.face_count());
      });
  m.def("read_mesh", &read, "path"_a,
        "Reads .obj, .ply, .stl, .gltf, .glb, .dae or .fbx. Changes made by the reader are reported as a "
        "UserWarning.");
  m.def(
      "write_mesh",
      [](const FilePath& path, const Mesh& mesh, const std::optional<ArrayLike>& positions) {
        const Mesh written = positions ? moved(mesh, *positions) : mesh;
        const nb::gil_scoped_release nogil;
        write_mesh(path, written);
      },
      "path"_a, "mesh"_a, "positions"_a = nb::none(),
      "Writes .obj or .ply by suffix, with its own positions or others (V, 3) [m].");
  m.def(
      "thicken", [](const Mesh& mesh, double thickness) { return thicken(mesh, thickness); }, "mesh"_a,
      "thickness"_a, nb::call_guard<nb::gil_scoped_release>(),
      "A closed mesh of the points within half the thickness [m] of a sheet.");
  m.def("is_closed", &is_closed, "mesh"_a, "Whether the mesh has no boundary.");
}

}  // namespace muslin::python
