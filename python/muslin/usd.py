"""Runs as USD files, by the package usd-core: ``pip install muslin[usd]``.

``muslin.export_run`` writes .usda without it; this module writes the small binary form, .usdc, too.
"""

import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from muslin._muslin import Mesh, Run
from muslin.errors import FileError, InputError, Interrupted, UsageError

__all__ = ["write"]


def write(
    run: Run,
    file: str | os.PathLike[str],
    *,
    body: str | None = None,
    surface: str = "skin",
    progress: Callable[[float, str], object] | None = None,
    cancel: Callable[[], bool] | None = None,
) -> None:
    """Writes a run as .usdc, .usda or .usd (binary).

    A mesh per body (or only ``body``) under ``/run``, with time samples of points [m], velocities [m/s] and extents,
    one a frame; texture coordinates as ``primvars:st``, groups of faces as subsets, materials of the
    mesh's file by name, the body's colour as ``displayColor``. y is up, a unit is a metre, a time code is a frame. The file appears when it is complete.
    """
    pxr = _pxr()
    target = Path(file)
    if target.suffix not in (".usdc", ".usda", ".usd"):
        raise UsageError(f"cannot write `{target.suffix}` as USD", "use .usdc, .usda or .usd")
    if run.frame_count == 0:
        raise InputError("the run has no finished frame", "run the scene first", str(run.directory))
    bodies = [body] if body is not None else run.bodies
    for name in bodies:
        run.mesh(name, surface=surface)  # what is asked for is there

    done, whole = 0, len(bodies) * run.frame_count

    def advance() -> None:
        nonlocal done
        if progress is not None:
            progress(done / whole, "export")
        if cancel is not None and cancel():
            raise Interrupted("stopped", "export again")
        done += 1

    try:
        scratch = tempfile.TemporaryDirectory(dir=target.parent or ".", prefix=".muslin-usd-")
    except OSError as error:
        raise FileError(error.strerror or str(error), "check the path", str(target)) from None
    with scratch as folder:
        unfinished = Path(folder) / target.name
        stage = pxr.Usd.Stage.CreateNew(str(unfinished))
        _describe(pxr, stage, run)
        taken = {"materials"}
        for name in bodies:
            _write_body(pxr, stage, run, name, surface, _identifier(pxr, name, taken), advance)
        try:
            stage.GetRootLayer().Save()
            del stage
            os.replace(unfinished, target)
        except (OSError, pxr.Tf.ErrorException) as error:
            raise FileError(str(error), "check the disk and the path", str(target)) from None


def _pxr() -> Any:
    try:
        import pxr  # type: ignore[import-untyped, unused-ignore]
        from pxr import Sdf, Tf, Usd, UsdGeom, UsdShade, Vt  # noqa: F401  (makes them attributes of pxr)
    except ImportError:
        raise UsageError("the package usd-core is not installed", "pip install muslin[usd]") from None
    return pxr


def _describe(pxr: Any, stage: Any, run: Run) -> None:
    stage.SetTimeCodesPerSecond(run.frame_rate)
    stage.SetFramesPerSecond(run.frame_rate)
    stage.SetStartTimeCode(0)
    stage.SetEndTimeCode(run.frame_count - 1)
    pxr.UsdGeom.SetStageUpAxis(stage, pxr.UsdGeom.Tokens.y)
    pxr.UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    stage.GetRootLayer().documentation = run.title
    root = pxr.UsdGeom.Xform.Define(stage, "/run").GetPrim()
    pxr.Usd.ModelAPI(root).SetKind("component")
    stage.SetDefaultPrim(root)


def _identifier(pxr: Any, name: str, taken: set[str]) -> str:
    base: str = pxr.Tf.MakeValidIdentifier(name)
    unique, number = base, 2
    while unique in taken:
        unique, number = f"{base}_{number}", number + 1
    taken.add(unique)
    return unique


def _write_body(
    pxr: Any, stage: Any, run: Run, body: str, surface: str, identifier: str, advance: Callable[[], None]
) -> None:
    mesh = run.mesh(body, surface=surface)
    prim = pxr.UsdGeom.Mesh.Define(stage, f"/run/{identifier}")
    prim.CreateSubdivisionSchemeAttr(pxr.UsdGeom.Tokens.none)
    prim.CreateDoubleSidedAttr(True)
    prim.CreateFaceVertexCountsAttr(pxr.Vt.IntArray.FromNumpy(np.diff(mesh.face_offsets).astype(np.int32)))
    prim.CreateFaceVertexIndicesAttr(pxr.Vt.IntArray.FromNumpy(np.array(mesh.face_vertices)))
    _write_uvs(pxr, prim, mesh)
    _write_groups(pxr, prim, mesh)
    _write_materials(pxr, prim, mesh)
    prim.CreateDisplayColorAttr([tuple(float(c) for c in run.colour(body))])
    points, velocities = prim.CreatePointsAttr(), prim.CreateVelocitiesAttr()
    extent = prim.CreateExtentAttr()
    for frame in range(run.frame_count):
        advance()
        x = run.points(frame, body, surface=surface)
        points.Set(pxr.Vt.Vec3fArray.FromNumpy(x), frame)
        velocities.Set(pxr.Vt.Vec3fArray.FromNumpy(run.velocities(frame, body, surface=surface)), frame)
        extent.Set(pxr.Vt.Vec3fArray.FromNumpy(np.stack([x.min(axis=0), x.max(axis=0)])), frame)


def _write_uvs(pxr: Any, prim: Any, mesh: Mesh) -> None:
    if len(mesh.corner_uvs) == 0:
        return
    uvs, corners = mesh.uvs.astype(np.float32), np.array(mesh.corner_uvs)
    if (corners < 0).any():  # corners without coordinates share one at the origin
        corners[corners < 0] = len(uvs)
        uvs = np.concatenate([uvs, np.zeros((1, 2), np.float32)])
    primvar = pxr.UsdGeom.PrimvarsAPI(prim).CreatePrimvar(
        "st", pxr.Sdf.ValueTypeNames.TexCoord2fArray, pxr.UsdGeom.Tokens.faceVarying
    )
    primvar.Set(pxr.Vt.Vec2fArray.FromNumpy(uvs))
    primvar.SetIndices(pxr.Vt.IntArray.FromNumpy(corners))


def _write_materials(pxr: Any, prim: Any, mesh: Mesh) -> None:
    """Binds the faces of each material of the file to a plain material of its name, under /run/materials."""
    taken: set[str] = set()
    for name, faces in mesh.materials.items():
        stage, own = prim.GetPrim().GetStage(), _identifier(pxr, name, taken)
        pxr.UsdGeom.Scope.Define(stage, "/run/materials")
        material = pxr.UsdShade.Material.Define(stage, f"/run/materials/{own}")
        material.GetPrim().SetDisplayName(name)
        shader = pxr.UsdShade.Shader.Define(stage, f"/run/materials/{own}/surface")
        shader.CreateIdAttr("UsdPreviewSurface")
        shader.CreateInput("roughness", pxr.Sdf.ValueTypeNames.Float).Set(0.9)
        material.CreateSurfaceOutput().ConnectToSource(shader.ConnectableAPI(), "surface")
        pxr.UsdShade.MaterialBindingAPI.Apply(prim.GetPrim())
        subset = pxr.UsdShade.MaterialBindingAPI(prim.GetPrim()).CreateMaterialBindSubset(
            f"material_{own}", pxr.Vt.IntArray.FromNumpy(np.array(faces))
        )
        pxr.UsdShade.MaterialBindingAPI.Apply(subset.GetPrim()).Bind(material)


def _write_groups(pxr: Any, prim: Any, mesh: Mesh) -> None:
    taken: set[str] = set()
    for name, faces in mesh.face_groups.items():
        pxr.UsdGeom.Subset.CreateGeomSubset(
            prim,
            _identifier(pxr, name, taken),
            pxr.UsdGeom.Tokens.face,
            pxr.Vt.IntArray.FromNumpy(np.array(faces)),
            "groups",
        )
