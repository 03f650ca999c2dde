"""Meshes: from arrays and files, checked, written, thickened; what is wrong with them is said."""

import numpy as np
import pytest
from conftest import grid_mesh

import muslin

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float)


def test_holds_what_it_was_given():
    mesh = muslin.Mesh(
        SQUARE, [[0, 1, 2], (0, 2, 3)], uvs=SQUARE[:, :2], groups={"left": [3, 0]}, face_groups={"upper": [1]}, name="sq"
    )
    assert (mesh.vertex_count, mesh.face_count, mesh.name) == (4, 2, "sq")
    assert np.array_equal(mesh.positions, SQUARE)
    assert mesh.faces == [(0, 1, 2), (0, 2, 3)]
    assert mesh.face_offsets.tolist() == [0, 3, 6]
    assert mesh.face_vertices.tolist() == [0, 1, 2, 0, 2, 3]
    assert np.array_equal(mesh.uvs[mesh.corner_uvs], SQUARE[mesh.face_vertices, :2])
    assert mesh.groups["left"].tolist() == [0, 3]
    assert mesh.groups["upper"].tolist() == [0, 2, 3]
    assert mesh.face_groups["upper"].tolist() == [1]
    assert set(mesh.face_groups) == {"upper"}
    assert mesh.bounds.tolist() == [[0, 0, 0], [1, 1, 0]]
    assert "4 vertices, 2 faces" in repr(mesh)


def test_quads_are_cut_into_triangles():
    mesh = muslin.Mesh(SQUARE, [[0, 1, 2, 3]])
    triangles = mesh.triangles()
    assert triangles.shape == (2, 3)
    corners = mesh.positions[triangles]
    areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2] / 2
    assert areas.tolist() == [0.5, 0.5]


@pytest.mark.parametrize("dtype", [np.float32, np.float16, np.int8, np.uint16, ">f8", np.longdouble])
def test_takes_any_real_type_and_layout(dtype):
    positions = SQUARE.astype(dtype)
    assert np.array_equal(muslin.Mesh(positions, [[0, 1, 2, 3]]).positions, SQUARE)
    wide = np.zeros((8, 6), dtype=dtype)
    wide[::2, ::2] = positions
    assert np.array_equal(muslin.Mesh(wide[::2, ::2], [[0, 1, 2, 3]]).positions, SQUARE)
    assert np.array_equal(muslin.Mesh(np.asfortranarray(positions), [[0, 1, 2, 3]]).positions, SQUARE)


def test_survives_its_file(tmp_path):
    mesh = grid_mesh(2, 1, 4, 2)
    muslin.write_mesh(tmp_path / "a.obj", mesh)
    again = muslin.read_mesh(str(tmp_path / "a.obj"))
    assert np.array_equal(again.positions, mesh.positions)
    assert again.faces == mesh.faces
    assert np.array_equal(again.uvs[again.corner_uvs], mesh.uvs[mesh.corner_uvs])
    assert again.groups["top"].tolist() == mesh.groups["top"].tolist()
    muslin.write_mesh(tmp_path / "b.ply", mesh, mesh.positions + [0, 0, 5])
    assert np.array_equal(muslin.read_mesh(tmp_path / "b.ply").positions, mesh.positions + [0, 0, 5])


def test_says_what_the_reader_had_to_change(tmp_path):
    (tmp_path / "a.stl").write_text(
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
        "facet normal 0 0 1\nouter loop\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n"
    )
    with pytest.warns(UserWarning, match="weld"):
        mesh = muslin.read_mesh(tmp_path / "a.stl")
    assert mesh.vertex_count == 4


def test_report_and_thickness():
    sheet = grid_mesh(2, 1, 4, 2)
    report = sheet.report()
    assert (report.vertices, report.faces, report.triangles, report.components) == (15, 8, 16, 1)
    assert (report.closed, report.open_edges, report.flat_axis) == (False, 12, 2)
    assert report.area == pytest.approx(2)
    assert not muslin.is_closed(sheet)
    box = muslin.thicken(sheet, 0.5)
    assert muslin.is_closed(box)
    assert box.report().volume == pytest.approx(1)
    assert (report.non_manifold_edges, report.flipped_edges, report.degenerate_faces) == (0, 0, 0)
    assert (report.duplicate_faces, report.unused_vertices) == (0, 0)
    assert isinstance(report.warnings, list)
    assert report.bounds.tolist() == [[0, 0, 0], [2, 1, 0]]


def test_moved_keeps_the_polygons():
    mesh = grid_mesh(2, 1, 4, 2)
    moved = mesh.moved(2 * mesh.positions)
    assert np.array_equal(moved.positions, 2 * mesh.positions)
    assert moved.faces == mesh.faces
    with pytest.raises(muslin.UsageError, match="has 3 rows"):
        mesh.moved(np.zeros((3, 3)))


FACES = [[0, 1, 2, 3]]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"positions": np.zeros((4, 2))}, r"positions: its shape is \(4, 2\)"),
        ({"positions": np.zeros(12)}, r"positions: its shape is \(12,\)"),
        ({"positions": SQUARE.astype(complex)}, "positions: it is an array of complex128"),
        ({"positions": [["a", "b", "c"]]}, "positions: it is an array of <U1"),
        ({"positions": [[0, 0, 0], [1, 0]]}, "positions: no array can be made of it"),
        
        ({"positions": np.where(SQUARE == 1, np.nan, SQUARE)}, r"positions\[1, 0\] is nan"),
        ({"positions": SQUARE + np.inf}, r"positions\[0, 0\] is inf"),
        ({"positions": SQUARE * 1e10}, "far|1e"),
        ({"positions": []}, "no positions"),
        ({"positions": SQUARE * 0}, "area"),
        ({"faces": []}, "face"),
        ({"faces": [[0, 1]]}, "three"),
        ({"faces": [[0, 1, 4]]}, r"faces\[0\]: there is no number 4"),
        ({"faces": [[0, 1, -1]]}, "no number -1; give numbers from 0 to 3"),
        ({"faces": [[0, 1, 2**40]]}, "1099511627776"),
        ({"faces": [[0.0, 1.0, 2.0]]}, r"faces\[0\]: it is an array of float64"),
        ({"faces": 3}, "no list of polygons"),
        ({"uvs": SQUARE[:2, :2]}, "2 uvs for 4 vertices"),
        ({"uvs": SQUARE[:, :2], "corner_uvs": [0, 1]}, "2 corner_uvs for 4 corners"),
        ({"uvs": SQUARE[:, :2], "corner_uvs": [0, 1, 2, 4]}, "no number 4"),
        ({"corner_uvs": [0, 1, 2, 3]}, "needs uvs"),
        ({"groups": {"a b": [0]}}, "cannot be the name"),
        ({"groups": {"a": [7]}}, r"groups\[a\]: there is no number 7"),
        ({"face_groups": {"a": [1]}}, r"face_groups\[a\]: there is no number 1"),
        ({"groups": {"a": [0]}, "face_groups": {"a": [0]}}, "both"),
    ],
)
def test_refuses(arguments, message):
    with pytest.raises(muslin.Error, match=message):
        muslin.Mesh(**({"positions": SQUARE, "faces": FACES} | arguments))


def test_files_that_are_missing_or_broken(tmp_path):
    with pytest.raises(muslin.FileError) as caught:
        muslin.read_mesh(tmp_path / "none.obj")
    assert caught.value.file.endswith("none.obj")
    (tmp_path / "bad.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n")
    with pytest.raises(muslin.InputError) as caught:
        muslin.read_mesh(tmp_path / "bad.obj")
    assert caught.value.line == 4
    with pytest.raises(muslin.FileError):
        muslin.write_mesh(tmp_path / "no" / "folder.obj", grid_mesh(1, 1, 1, 1))
    with pytest.raises(TypeError):
        muslin.read_mesh(7)
