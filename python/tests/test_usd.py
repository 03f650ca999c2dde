"""USD files: what is in them, and that USD's own checker has nothing to say."""

import numpy as np
import pytest
from conftest import flag_tables, grid_mesh, shell_tables
from pxr import Gf, Usd, UsdGeom, UsdShade, UsdValidation, Vt

import muslin
import muslin.usd


def complaints(file) -> list[str]:
    """Errors that all of USD's validators find, as usdchecker prints them."""
    context = UsdValidation.ValidationContext(UsdValidation.ValidationRegistry().GetOrLoadAllValidators())
    return [error.GetErrorAsString() for error in context.Validate(Usd.Stage.Open(str(file)))]


def test_the_checker_finds_fault(tmp_path):
    stage = Usd.Stage.CreateNew(str(tmp_path / "poor.usda"))
    UsdGeom.Xform.Define(stage, "/a")
    stage.GetRootLayer().Save()
    found = "\n".join(complaints(tmp_path / "poor.usda"))
    assert "defaultprim" in found.lower() and "upaxis" in found.lower() and "metersperunit" in found.lower()


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """Two bodies: the flag, with a seam, a group and a colour, and a piece of cloth."""
    sheet = grid_mesh(10, 6, 10, 6)
    corners = np.array(sheet.corner_uvs)
    corners[5] = -1
    mesh = muslin.Mesh(
        sheet.positions,
        sheet.faces,
        uvs=sheet.uvs,
        corner_uvs=corners,
        face_groups={"seam": [3, 4]},
        materials={"Blue Cotton": [0, 1], "trim": [5]},
        name="flag",
    )
    tables = flag_tables(pin=None, probe=None)
    cloth = shell_tables()["body"][0] | {"name": "my cloth", "translate": [0, 0, 5]}
    tables["body"] = [tables["body"][0] | {"mesh": mesh, "colour": [0.1, 0.2, 0.3]}, cloth]
    directory = tmp_path_factory.mktemp("usd") / "run"
    muslin.run(muslin.make_scene(tables), directory, frames=5)
    return muslin.Run(directory)


@pytest.mark.parametrize("suffix", ["usdc", "usda", "usd"])
def test_holds_the_run(run, tmp_path, suffix):
    file = tmp_path / f"flag.{suffix}"
    seen = []
    muslin.usd.write(run, file, progress=lambda fraction, stage: seen.append(fraction))
    assert complaints(file) == []
    assert seen == sorted(seen) and seen[0] == 0 and len(seen) == 12
    assert [path.name for path in tmp_path.iterdir()] == [file.name]
    stage = Usd.Stage.Open(str(file))
    assert UsdGeom.GetStageUpAxis(stage) == "Y"
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1
    assert stage.GetTimeCodesPerSecond() == stage.GetFramesPerSecond() == 24
    assert (stage.GetStartTimeCode(), stage.GetEndTimeCode()) == (0, 5)
    assert stage.GetDefaultPrim().GetPath() == "/run"
    assert stage.GetRootLayer().documentation == "flag"
    flag = UsdGeom.Mesh.Get(stage, "/run/flag")
    cloth = UsdGeom.Mesh.Get(stage, "/run/my_cloth")
    for mesh, body in ((flag, "flag"), (cloth, "my cloth")):
        assert mesh.GetPointsAttr().GetTimeSamples() == list(range(6))
        for frame in range(6):
            points = np.array(mesh.GetPointsAttr().Get(frame))
            assert np.array_equal(points, run.points(frame, body))
            assert np.array_equal(np.array(mesh.GetVelocitiesAttr().Get(frame)), run.velocities(frame, body))
            assert np.array_equal(np.array(mesh.GetExtentAttr().Get(frame)), [points.min(axis=0), points.max(axis=0)])
    rest = run.mesh("flag")
    assert np.array_equal(np.array(flag.GetFaceVertexIndicesAttr().Get()), rest.face_vertices)
    assert np.array_equal(np.array(flag.GetFaceVertexCountsAttr().Get()), np.diff(rest.face_offsets))
    assert flag.GetSubdivisionSchemeAttr().Get() == "none"
    uvs = UsdGeom.PrimvarsAPI(flag).GetPrimvar("st")
    assert uvs.GetInterpolation() == "faceVarying"
    flattened = np.array(uvs.ComputeFlattened())
    with_uv = rest.corner_uvs >= 0
    assert np.allclose(flattened[with_uv], rest.uvs[rest.corner_uvs[with_uv]])
    assert (flattened[~with_uv] == 0).all() and (~with_uv).sum() == 1
    subsets = UsdGeom.Subset.GetAllGeomSubsets(flag)
    assert {s.GetPrim().GetName(): list(s.GetIndicesAttr().Get()) for s in subsets}["seam"] == [3, 4]
    for face, name in ((1, "Blue Cotton"), (5, "trim")):
        subset = next(s for s in subsets if s.GetFamilyNameAttr().Get() == "materialBind" and face in s.GetIndicesAttr().Get())
        material, _ = UsdShade.MaterialBindingAPI(subset.GetPrim()).ComputeBoundMaterial()
        assert material.GetPrim().GetDisplayName() == name
    assert flag.GetDisplayColorAttr().Get() == Vt.Vec3fArray([Gf.Vec3f(0.1, 0.2, 0.3)])


def test_binary_is_smaller_than_text(run, tmp_path):
    for suffix in ("usdc", "usda"):
        muslin.usd.write(run, tmp_path / f"flag.{suffix}")
    assert (tmp_path / "flag.usdc").stat().st_size < (tmp_path / "flag.usda").stat().st_size


def test_one_body_and_its_contour(run, tmp_path):
    muslin.usd.write(run, tmp_path / "flag.usdc", body="flag", surface="contour")
    assert complaints(tmp_path / "flag.usdc") == []
    stage = Usd.Stage.Open(str(tmp_path / "flag.usdc"))
    assert [prim.GetName() for prim in stage.GetDefaultPrim().GetChildren()] == ["flag"]
    points = np.array(UsdGeom.Mesh.Get(stage, "/run/flag").GetPointsAttr().Get(5))
    assert np.array_equal(points, run.points(5, "flag", surface="contour"))


def test_the_engine_writes_the_same_as_text(run, tmp_path):
    """`muslin export` writes .usda without usd-core; USD reads the same numbers from it, and is content."""
    muslin.export_run(run, tmp_path / "engine.usda")
    assert complaints(tmp_path / "engine.usda") == []
    muslin.usd.write(run, tmp_path / "module.usdc")
    engine, module = (Usd.Stage.Open(str(tmp_path / name)) for name in ("engine.usda", "module.usdc"))
    for path in ("/run/flag", "/run/my_cloth"):
        for attribute in ("points", "velocities", "extent", "primvars:st", "faceVertexIndices"):
            a, b = (stage.GetPrimAtPath(path).GetAttribute(attribute) for stage in (engine, module))
            times = b.GetTimeSamples() or [Usd.TimeCode.Default()]
            assert a.GetTimeSamples() == b.GetTimeSamples()
            for time in times:
                assert np.array_equal(np.array(a.Get(time)), np.array(b.Get(time))), (path, attribute)


    for stage in (engine, module):
        subsets = UsdGeom.Subset.GetAllGeomSubsets(UsdGeom.Mesh.Get(stage, "/run/flag"))
        bound = [s for s in subsets if s.GetFamilyNameAttr().Get() == "materialBind"]
        names = {
            UsdShade.MaterialBindingAPI(s.GetPrim()).ComputeBoundMaterial()[0].GetPrim().GetDisplayName(): list(
                s.GetIndicesAttr().Get()
            )
            for s in bound
        }
        assert names == {"Blue Cotton": [0, 1], "trim": [5]}


def test_what_cannot_be_written(run, tmp_path):
    with pytest.raises(muslin.UsageError, match=r"\.abc"):
        muslin.usd.write(run, tmp_path / "flag.abc")
    with pytest.raises(muslin.FileError):
        muslin.usd.write(run, tmp_path / "none" / "flag.usdc")
    with pytest.raises(muslin.UsageError, match="body"):
        muslin.usd.write(run, tmp_path / "flag.usdc", body="flog")
    with pytest.raises(muslin.UsageError, match="contour"):
        muslin.usd.write(run, tmp_path / "flag.usdc", surface="contour")  # the cloth has none
    with pytest.raises(muslin.Interrupted):
        muslin.usd.write(run, tmp_path / "flag.usdc", cancel=lambda: True)
    assert list(tmp_path.iterdir()) == []


def test_says_what_is_missing_without_usd(run, tmp_path, monkeypatch):
    import sys

    for name in [name for name in sys.modules if name.split(".")[0] == "pxr"]:
        monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(muslin.UsageError, match=r"muslin\[usd\]"):
        muslin.usd.write(run, tmp_path / "flag.usdc")
