"""Every stage between mesh and simulation, each on its own, against what can be worked out by hand."""

import numpy as np
import pytest
from conftest import flag_tables, grid_mesh, shell_tables

import muslin


def box(size) -> muslin.Mesh:
    corners = np.array([[c & 1, c >> 1 & 1, c >> 2 & 1] for c in range(8)]) * size
    faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    return muslin.Mesh(corners, faces)


def box_distance(x, size):
    """Distances of points to the surface of the box [0, size], negative inside."""
    q = np.abs(x - np.array(size) / 2) - np.array(size) / 2
    return np.linalg.norm(np.maximum(q, 0), axis=1) + np.minimum(q.max(axis=1), 0)


def test_signed_distance_of_a_box():
    distance = muslin.SignedDistance(box([3, 2, 1]))
    x = np.random.default_rng(1).uniform(-1, 4, (500, 3))
    expected = box_distance(x, [3, 2, 1])
    assert np.allclose(distance(x), expected, atol=1e-12)
    assert np.allclose(distance.distance(x), np.abs(expected), atol=1e-12)
    inside = distance.inside(x)
    assert inside.dtype == bool
    assert np.array_equal(inside, expected < 0)
    assert distance.watertight
    assert distance.bounds.tolist() == [[0, 0, 0], [3, 2, 1]]
    assert distance([]).shape == (0,)
    for bad in (np.zeros(3), [[np.nan, 0, 0]], "x"):
        with pytest.raises(muslin.UsageError, match="points"):
            distance(bad)


def test_sampled_field_is_the_distance_at_its_points():
    distance = muslin.SignedDistance(box([3, 2, 1]))
    seen = []
    field = muslin.sample_field(
        distance, [-1, -1, -1], 0.5, (11, 9, 7), progress=lambda fraction, stage: seen.append((fraction, stage))
    )
    assert field.values.shape == (7, 9, 11)
    assert field.values.dtype == np.float32
    k, j, i = np.meshgrid(*map(np.arange, field.values.shape), indexing="ij")
    points = field.origin + field.width * np.stack([i, j, k], axis=-1).reshape(-1, 3)
    assert np.allclose(field.values.ravel(), distance(points), atol=1e-6)
    assert seen[-1][0] == 1
    assert field.band == np.inf
    banded = muslin.sample_field(distance, [-1, -1, -1], 0.5, (11, 9, 7), band=0.25)
    assert np.abs(banded.values).max() == 0.25
    for samples in ((2, 2, -2), (2, 2), (1.5, 2, 2)):
        with pytest.raises(muslin.UsageError):
            muslin.sample_field(distance, [0, 0, 0], 0.5, samples)
    for width in (0, -1, np.nan):
        with pytest.raises(muslin.UsageError):
            muslin.sample_field(distance, [0, 0, 0], width, (2, 2, 2))


def test_printed_field_is_that_of_the_program(source, program):
    import subprocess

    file = source / "scenes/meshes/flag_box.obj"
    printed = subprocess.run(
        [program, "field", file, "--voxel-width", "1", "--slice", "z=0.5"], check=True, capture_output=True, text=True
    ).stdout
    assert muslin.print_field(muslin.read_mesh(file), 1, slice="z=0.5") == printed
    with pytest.raises(muslin.UsageError):
        muslin.print_field(muslin.read_mesh(file), 1, slice="w=0")


def test_lattice_of_a_box():
    mesh = box([3, 2, 1])
    distance = muslin.SignedDistance(mesh)
    lattice = muslin.build_lattice(mesh, distance, 0.5)
    assert lattice.extent.tolist() == [6, 4, 2]
    assert lattice.voxel_count == len(lattice.voxels) == 48
    assert lattice.vertex_count == len(lattice.vertices) == 7 * 5 * 3
    assert np.allclose(lattice.fill, 1)
    assert lattice.coverage == pytest.approx(1)
    assert lattice.origin.tolist() == [0, 0, 0]
    assert lattice.width == 0.5
    rest = lattice.rest_positions()
    assert np.allclose(rest, lattice.origin + 0.5 * lattice.vertices)
    offsets = lattice.vertices[lattice.voxel_vertices] - lattice.voxels[:, None]
    assert np.array_equal(offsets[0], [[c & 1, c >> 1 & 1, c >> 2 & 1] for c in range(8)])
    assert (offsets == offsets[0]).all()
    for index, at in ((0, lattice.voxels[0]), (47, lattice.voxels[47])):
        assert lattice.find_voxel(at) == index
    assert lattice.find_voxel([9, 9, 9]) == -1
    assert lattice.find_vertex(lattice.vertices[11]) == 11
    wide = muslin.build_lattice(mesh, distance, 0.5, voxels="threshold", threshold=0.6)
    assert wide.voxel_count > 48
    with pytest.raises(muslin.UsageError, match="did you mean `cover`"):
        muslin.build_lattice(mesh, distance, 0.5, voxels="covr")
    for width in (0, -1, np.nan, np.inf):
        with pytest.raises(muslin.UsageError):
            muslin.build_lattice(mesh, distance, width)
    with pytest.raises(muslin.InputError):
        muslin.build_lattice(mesh, distance, 1e-7)


def test_springs_and_tetrahedra_of_one_voxel():
    mesh = box([1, 1, 1])
    lattice = muslin.build_lattice(mesh, muslin.SignedDistance(mesh), 1)
    springs = muslin.build_springs(lattice)
    assert springs.count == 19
    assert springs.count_by_kind == {"edge": 12, "face_diagonal": 6, "body_diagonal": 1}
    ends, kinds = springs.ends(), springs.kinds()
    lengths = np.linalg.norm(np.diff(lattice.rest_positions()[ends], axis=1)[:, 0], axis=1)
    assert np.allclose(lengths**2, kinds + 1)
    assert springs.share.shape == springs.mean_fill.shape == (19,)
    assert muslin.build_springs(lattice, "full").count == 28
    with pytest.raises(muslin.UsageError, match="kuhn"):
        muslin.build_springs(lattice, "kun")
    corners = lattice.rest_positions()[muslin.build_tetrahedra(lattice)]
    edges = corners[:, 1:] - corners[:, :1]
    assert np.allclose(np.linalg.det(edges), 1)


def test_embedding_is_linear_and_its_transpose_conserves():
    mesh = box([3, 2, 1])
    lattice = muslin.build_lattice(mesh, muslin.SignedDistance(mesh), 1)
    rng = np.random.default_rng(2)
    points = rng.uniform(0, 1, (20, 3)) * [3, 2, 1]
    embedding = muslin.embed(lattice, points)
    assert len(embedding) == 20
    assert np.allclose(embedding.weights.sum(axis=1), 1)
    q = lattice.rest_positions()
    assert np.allclose(embedding.apply(q), points)
    matrix, shift = rng.normal(size=(3, 3)), rng.normal(size=3)
    assert np.allclose(embedding.apply(q @ matrix + shift), points @ matrix + shift)
    forces = rng.normal(size=(20, 3))
    carried = embedding.transpose(forces, len(q))
    assert np.allclose((carried * q).sum(), (forces * points).sum())
    assert np.allclose(carried.sum(axis=0), forces.sum(axis=0))
    with pytest.raises(muslin.UsageError, match="q: it has 3 rows"):
        embedding.apply(np.zeros((3, 3)))
    with pytest.raises(muslin.UsageError, match="forces: it has 3 rows"):
        embedding.transpose(np.zeros((3, 3)), len(q))
    with pytest.raises(muslin.UsageError, match="vertex_count"):
        embedding.transpose(forces, 2)


def test_contour_of_a_box_is_closed_and_near_it():
    mesh = box([3, 2, 1])
    distance = muslin.SignedDistance(mesh)
    lattice = muslin.build_lattice(mesh, distance, 0.25)
    contour = muslin.build_contour(lattice, mesh, distance)
    assert contour.method == "cubes"
    assert muslin.is_closed(contour.mesh)
    assert contour.distance < 0.25
    assert np.allclose(contour.embedding.apply(lattice.rest_positions()), contour.mesh.positions)
    assert contour.mesh.report().volume == pytest.approx(6, rel=0.02)
    with pytest.raises(muslin.InputError):
        muslin.build_contour(lattice, mesh, distance, "squares")
    with pytest.raises(muslin.UsageError):
        muslin.build_contour(lattice, mesh, distance, "spheres")


def test_shell_of_a_sheet():
    mesh = grid_mesh(2, 1, 4, 2)
    shell = muslin.build_shell(mesh)
    assert shell.triangles.shape == (16, 3)
    assert shell.faces.tolist() == sorted([*range(8), *range(8)])
    assert shell.area == pytest.approx(2)
    assert shell.areas.sum() == pytest.approx(2)
    assert shell.vertex_areas.sum() == pytest.approx(2)
    assert shell.hinges().shape == (16 * 3 // 2 - 12 // 2, 4)
    assert np.allclose(shell.hinge_angles(), 0)
    assert (shell.hinge_lengths() >= 0.5).all()
    assert 0.5 <= shell.mean_edge <= np.sqrt(0.5)
    assert shell.max_stretch(mesh.positions) == pytest.approx(1)
    assert shell.max_stretch(mesh.positions * [1.25, 1, 1]) == pytest.approx(1.25)
    shrunk = muslin.build_shell(mesh, rest_positions=mesh.positions / 2, warp=[0, 1, 0])
    assert shrunk.area == pytest.approx(0.5)
    with pytest.raises(muslin.UsageError, match="rows"):
        muslin.build_shell(mesh, rest_positions=np.zeros((2, 3)))
    with pytest.raises(muslin.UsageError, match="no direction"):
        muslin.build_shell(mesh, warp=[0, 0, 0])
    with pytest.raises(muslin.UsageError, match="rows"):
        shell.max_stretch(np.zeros((2, 3)))


def test_model_holds_the_stages_of_its_bodies():
    model = muslin.build_model(muslin.make_scene(flag_tables()))
    body = model.body("flag")
    assert model.bodies[0].name == body.name == "flag"
    assert (body.model, body.sheet, body.thickness) == ("lattice", True, 1)
    assert body.lattice.voxel_count == 60
    assert body.springs.count_by_kind["edge"] == 349
    assert body.shell is None
    assert muslin.is_closed(body.solid)
    assert np.allclose(body.skin.apply(model.rest_positions[body.vertices]), body.mesh.positions)
    assert body.contour.method == "squares"
    assert body.mass == pytest.approx(600)
    assert model.masses.sum() == pytest.approx(600)
    assert (body.first_vertex, body.vertex_count, model.vertex_count) == (0, 154, 154)
    assert body.report.flat_axis == 2
    assert [pin.name for pin in model.pins] == ["corners"]
    pin = model.pins[0]
    assert (pin.begin, pin.end) == (0, np.inf)
    assert np.allclose(model.rest_positions[pin.vertices][:, 1], 6)
    described = model.describe()
    assert described["bodies"][0]["voxels"] == 60
    assert "60" in str(model)
    assert "154 vertices" in repr(model)
    with pytest.raises(muslin.UsageError, match="did you mean `flag`"):
        model.body("flg")


def test_model_of_a_shell():
    body = muslin.build_model(muslin.make_scene(shell_tables())).body("cloth")
    assert body.model == "shell"
    assert body.lattice is body.springs is body.contour is body.solid is None
    assert body.shell.area == pytest.approx(1)


def test_stages_as_files(tmp_path):
    model = muslin.build_model(muslin.make_scene(flag_tables()))
    muslin.write_stages(tmp_path, model)
    names = {path.name for path in tmp_path.iterdir()}
    assert {"flag.field.vti", "flag.voxels.vtu", "flag.tets.vtu", "flag.springs.vtu", "stats.json"} <= names


def test_materials(source):
    names = muslin.material_names()
    assert len(names) >= 14 and names == sorted(names)
    cotton = muslin.find_material("cotton")
    assert cotton.name == "cotton" and cotton.source
    assert cotton.shell["areal_density"] > 0
    thesis = muslin.find_material("thesis_flag")
    assert thesis.lattice["edge_modulus"] == 20000
    assert thesis.shell == {}
    assert muslin.read_material(source / "materials/cotton.toml").shell == cotton.shell
    assert isinstance(cotton.reference, dict) and cotton.description
    with pytest.raises(muslin.InputError, match="cotton"):
        muslin.find_material("coton")
