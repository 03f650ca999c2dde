"""Types of the tables that make_scene takes. Written by `muslin schema --python`; do not edit."""

# ruff: noqa: E501, UP007, UP013, UP045
import os
from collections.abc import Sequence
from typing import Any, Literal, Optional, Required, TypedDict, Union

import numpy as np
import numpy.typing as npt

from muslin._muslin import Mesh

Vector = Union[Sequence[float], npt.NDArray[np.floating[Any]]]
Points = Union[Sequence[Vector], npt.NDArray[np.floating[Any]]]
Path = Union[str, os.PathLike[str], Mesh]

KeyframesOfANumber = TypedDict(
    "KeyframesOfANumber",
    {
        "time": Required[float],  # time of the keyframe, later than the previous one [s]
        "value": Required[float],  # the number at that time
    },
    total=False,
)

WhereLine = TypedDict(
    "WhereLine",
    {
        "from": Required[Vector],  # one end [m]
        "to": Required[Vector],  # the other end [m]
        "distance": Optional[float],  # greatest distance of a selected vertex [m]
    },
    total=False,
)

WherePlane = TypedDict(
    "WherePlane",
    {
        "point": Required[Vector],  # a point of the plane [m]
        "normal": Required[Vector],  # normal of the plane
        "distance": Optional[float],  # greatest distance of a selected vertex [m]
    },
    total=False,
)

WhereSphere = TypedDict(
    "WhereSphere",
    {
        "center": Required[Vector],  # its centre [m]
        "radius": Required[float],  # its radius [m]
    },
    total=False,
)

ANumberOverTime = TypedDict(
    "ANumberOverTime",
    {
        "keyframes": Required[Sequence["KeyframesOfANumber"]],  # a list of tables, linear between them, constant before the first and after the last
    },
    total=False,
)

KeyframesOfWind = TypedDict(
    "KeyframesOfWind",
    {
        "time": Required[float],  # time of the keyframe, later than the previous one [s]
        "value": Required[Vector],  # `velocity` at that time [m/s]
    },
    total=False,
)

KeyframesOfPoint = TypedDict(
    "KeyframesOfPoint",
    {
        "time": Required[float],  # time of the keyframe, later than the previous one [s]
        "value": Required[Vector],  # `force` at that time [N]
    },
    total=False,
)

KeyframesOfGravity = TypedDict(
    "KeyframesOfGravity",
    {
        "time": Required[float],  # time of the keyframe, later than the previous one [s]
        "value": Required[Vector],  # `acceleration` at that time [m/s²]
    },
    total=False,
)

Where = TypedDict(
    "Where",
    {
        "group": Optional[str],  # carries a vertex or face of this group of the mesh (OBJ `g`)
        "box": Optional[Points],  # lies in the box between two corners `[[x, y, z], [x, y, z]]`, the smaller coordinates first [m]
        "sphere": Optional["WhereSphere"],  # lies within `radius` of `center`
        "plane": Optional["WherePlane"],  # lies within `distance` of the plane through `point` across `normal`
        "line": Optional["WhereLine"],  # lies within `distance` of the segment `from` – `to`
        "nearest": Optional[Union[Vector, Points]],  # is the nearest to a point, or one of several that are equally near, among those which satisfy the other criteria; one point or a list of points [m]
    },
    total=False,
)

KeyframesOfAMotion = TypedDict(
    "KeyframesOfAMotion",
    {
        "time": Required[float],  # time of the keyframe, later than the previous one [s]
        "translate": Optional[Vector],  # displacement [m]
        "rotate": Optional[Vector],  # rotation about `pivot`: about the x axis, then y, then z [degrees]
    },
    total=False,
)

MaterialOfAShell = TypedDict(
    "MaterialOfAShell",
    {
        "base": Optional[str],  # a material by name or path that has `[shell]` numbers; the other keys change it
        "areal_density": Optional[float],  # mass per area [kg/m²]
        "membrane_warp": Optional[float],  # force per width and strain along warp: Young's modulus × thickness [N/m]
        "membrane_weft": Optional[float],  # force per width and strain along weft [N/m]
        "membrane_shear": Optional[float],  # force per width and radian [N/m]
        "warp_curve": Optional[Points],  # measured, in place of `membrane_warp`: up to 10 points `[[strain, force per width], …]` of a strip pulled along warp [1, N/m]
        "weft_curve": Optional[Points],  # in place of `membrane_weft`: points of a strip pulled along weft [1, N/m]
        "shear_curve": Optional[Points],  # in place of `membrane_shear`: points `[[angle, force per length], …]` of a shear test [°, N/m]
        "poisson": Optional[float],  # Poisson's ratio of stretch and bending: geometric mean of the two directions
        "bending_warp": Optional[float],  # moment per width and curvature when warp bends [N·m]
        "bending_weft": Optional[float],  # moment per width and curvature when weft bends [N·m]
        "bending_bias": Optional[float],  # moment per width and curvature for bending at 45°; at least (warp + weft + 2 ν √(warp weft))/4, where the sheet no longer resists twisting [N·m]
        "bending_warp_curve": Optional[Points],  # measured, in place of `bending_warp`: up to 10 points `[[curvature, moment per width], …]` [1/m, N]
        "bending_weft_curve": Optional[Points],  # in place of `bending_weft`: points `[[curvature, moment per width], …]` when weft bends [1/m, N]
        "bending_friction_warp": Optional[float],  # internal friction: greatest moment per width with which warp resists every change of curvature, half of KES-FB2's 2HB; 0 is off [N]
        "bending_friction_weft": Optional[float],  # internal friction when weft bends [N]
        "bending_friction_curvature": Optional[float],  # change of curvature over which internal friction builds up [1/m]
        "stretch_limit": Optional[float],  # largest stretch in any direction, as length over rest length, unless the body has a `stretch_limit` of its own
        "mass_damping": Optional[float],  # Rayleigh's α: slows all motion [1/s]
        "stiffness_damping": Optional[float],  # Rayleigh's β of stretch and shear [s]
        "bending_damping": Optional[float],  # Rayleigh's β of bending [s]
    },
    total=False,
)

MaterialOfALattice = TypedDict(
    "MaterialOfALattice",
    {
        "base": Optional[str],  # a material by name or path; the other keys change it
        "shear_modulus": Optional[float],  # shear modulus of the springs, only with `youngs_modulus` [N/m²]
        "density": Optional[float],  # mass per volume [kg/m³]
        "edge_modulus": Optional[float],  # modulus of springs along voxel edges; a spring's constant is modulus × voxel width [N/m²]
        "face_diagonal_modulus": Optional[float],  # modulus of springs along face diagonals [N/m²]
        "body_diagonal_modulus": Optional[float],  # modulus of springs along body diagonals [N/m²]
        "volume_modulus": Optional[float],  # resistance of each voxel to a change of volume; 0 is off [N/m²]
        "mass_damping": Optional[float],  # Rayleigh's α: slows all motion, like a viscous fluid [1/s]
        "stiffness_damping": Optional[float],  # Rayleigh's β: damps stretching only [s]
        "law": Optional[Literal["springs", "neo_hookean"]],  # `neo_hookean`: a solid of tetrahedra in place of springs, with a stated E and ν
        "youngs_modulus": Optional[float],  # Young's modulus of the solid; with springs, of a large block along its axes, in place of the three moduli [N/m²]
        "poisson": Optional[float],  # Poisson's ratio of the solid
    },
    total=False,
)

Probe = TypedDict(
    "Probe",
    {
        "name": Optional[str],  # name in `probes.csv`
        "body": Optional[str],  # must be given if there are several
        "at": Required[Vector],  # a point of the body or collider at the start, which moves with it [m]
    },
    total=False,
)

Pressure = TypedDict(
    "Pressure",
    {
        "name": Optional[str],  # name in messages
        "body": Optional[str],  # a shell that is closed or nearly closed; flat lids close its holes
        "pressure": Required[Union[float, "ANumberOverTime"]],  # excess over the outside, constant or `{ keyframes = [{ time = …, value = … }, …] }`; of a gas: its excess while the surface encloses the volume at rest [Pa]
        "gas": Optional[bool],  # `true`: a fixed amount of gas at a constant temperature, whose pressure falls as the volume grows
        "atmosphere": Optional[float],  # pressure outside, for a gas [Pa]
        "from": Optional[float],  # time when it begins to act [s]
        "until": Optional[float],  # time when it ends, after `from` [s]
    },
    total=False,
)

GravityForce = TypedDict(
    "GravityForce",
    {
        "name": Optional[str],  # name in messages
        "type": Required[Literal["gravity"]],  # `"gravity"`, `"point"` or `"wind"`
        "body": Optional[str],  # the body it acts on
        "acceleration": Optional[Vector],  # acceleration of all bodies it acts on [m/s²]
        "keyframes": Optional[Sequence["KeyframesOfGravity"]],  # the value over time in place of a constant: a list of tables, linear between them; times ascend
        "from": Optional[float],  # time when it begins to act [s]
        "until": Optional[float],  # time when it ends, after `from` [s]
    },
    total=False,
)

PointForce = TypedDict(
    "PointForce",
    {
        "name": Optional[str],  # name in messages
        "type": Required[Literal["point"]],  # `"gravity"`, `"point"` or `"wind"`
        "body": Optional[str],  # a body, or a collider with a density; must be given if there are several
        "where": Optional["Where"],  # selection of vertices; for a collider with a density those of its mesh, or, without `where`, its centre of mass
        "force": Optional[Vector],  # force on each selected vertex [N]
        "keyframes": Optional[Sequence["KeyframesOfPoint"]],  # the value over time in place of a constant: a list of tables, linear between them; times ascend
        "from": Optional[float],  # time when it begins to act [s]
        "until": Optional[float],  # time when it ends, after `from` [s]
    },
    total=False,
)

WindForce = TypedDict(
    "WindForce",
    {
        "name": Optional[str],  # name in messages
        "type": Required[Literal["wind"]],  # `"gravity"`, `"point"` or `"wind"`
        "body": Optional[str],  # the body it acts on
        "velocity": Optional[Vector],  # mean velocity of the air [m/s]
        "keyframes": Optional[Sequence["KeyframesOfWind"]],  # the value over time in place of a constant: a list of tables, linear between them; times ascend
        "from": Optional[float],  # time when it begins to act [s]
        "until": Optional[float],  # time when it ends, after `from` [s]
        "air_density": Optional[float],  # density of the air [kg/m³]
        "drag": Optional[float],  # drag coefficient; 1.17 is a square plate, broadside
        "lift": Optional[float],  # lift coefficient, at most `drag`
        "gust": Optional[float],  # root mean square of each component of the turbulence [m/s]
        "gust_length": Optional[float],  # size of its largest eddies [m]
        "seed": Optional[int],  # whole number that seeds the turbulence
    },
    total=False,
)

Force = Union[GravityForce, PointForce, WindForce]

Pin = TypedDict(
    "Pin",
    {
        "name": Optional[str],  # name in messages and in `selections.json`
        "body": Optional[str],  # a body, or a collider with a density; must be given if there are several
        "where": Optional["Where"],  # selection of vertices; a collider with a density is held as a whole, without `where`
        "from": Optional[float],  # start time; the vertices are held at their positions at that time [s]
        "until": Optional[float],  # release time, after `from` [s]
        "pivot": Optional[Vector],  # point about which `rotate` turns [m]
        "sequence": Optional[Path],  # motion, in place of `keyframes`: a file with the position of every vertex of the body's mesh per frame: `.pc2`, `.mdd`, or numbered files `walk.####.obj`. Metres, y up, in the world
        "keyframes": Optional[Sequence["KeyframesOfAMotion"]],  # motion: a list of tables; linear between them, rotation at constant speed; times ascend
    },
    total=False,
)

Contact = TypedDict(
    "Contact",
    {
        "distance": Optional[float],  # contact distance: surfaces repel each other where the gap is below it [m]
        "friction": Optional[float],  # Coulomb's coefficient of each body and collider without its own `friction`
    },
    total=False,
)

PlaneCollider = TypedDict(
    "PlaneCollider",
    {
        "name": Optional[str],  # different for each body and collider
        "shape": Required[Literal["plane"]],  # `"plane"`, `"sphere"`, `"capsule"`, `"box"` or `"mesh"`
        "center": Optional[Vector],  # any point of the plane [m]
        "normal": Optional[Vector],  # points to the side where bodies are; they cannot reach the other side
        "pivot": Optional[Vector],  # point about which `rotate` of the keyframes turns, before `translate` [m]
        "keyframes": Optional[Sequence["KeyframesOfAMotion"]],  # motion relative to its initial position: a list of tables; linear between them, rotation at constant speed; times ascend
        "contact": Optional[bool],  # `false` excludes it from contact; it is only drawn
        "friction": Optional[float],  # Coulomb's coefficient of its surface; a [pair](#contact) has the geometric mean
        "colour": Optional[Vector],  # colour in pictures [sRGB 0 to 1]
    },
    total=False,
)

SphereCollider = TypedDict(
    "SphereCollider",
    {
        "name": Optional[str],  # different for each body and collider
        "shape": Required[Literal["sphere"]],  # `"plane"`, `"sphere"`, `"capsule"`, `"box"` or `"mesh"`
        "center": Optional[Vector],  # its centre [m]
        "radius": Required[float],  # its radius [m]
        "density": Optional[float],  # makes it a rigid body of this density; a mesh must be closed. Without it gravity and other forces do not act on it [kg/m³]
        "velocity": Optional[Vector],  # velocity at the start; only with a density [m/s]
        "angular_velocity": Optional[Vector],  # rate of rotation at the start, along the axis through the centre of mass; only with a density [degrees/s]
        "pivot": Optional[Vector],  # point about which `rotate` of the keyframes turns, before `translate` [m]
        "keyframes": Optional[Sequence["KeyframesOfAMotion"]],  # motion relative to its initial position: a list of tables; linear between them, rotation at constant speed; times ascend
        "contact": Optional[bool],  # `false` excludes it from contact; it is only drawn
        "friction": Optional[float],  # Coulomb's coefficient of its surface; a [pair](#contact) has the geometric mean
        "colour": Optional[Vector],  # colour in pictures [sRGB 0 to 1]
    },
    total=False,
)

CapsuleCollider = TypedDict(
    "CapsuleCollider",
    {
        "name": Optional[str],  # different for each body and collider
        "shape": Required[Literal["capsule"]],  # `"plane"`, `"sphere"`, `"capsule"`, `"box"` or `"mesh"`
        "points": Required[Points],  # the two ends of its axis, `[[x, y, z], [x, y, z]]`; round caps reach a radius beyond [m]
        "radius": Required[float],  # its radius [m]
        "density": Optional[float],  # makes it a rigid body of this density; a mesh must be closed. Without it gravity and other forces do not act on it [kg/m³]
        "velocity": Optional[Vector],  # velocity at the start; only with a density [m/s]
        "angular_velocity": Optional[Vector],  # rate of rotation at the start, along the axis through the centre of mass; only with a density [degrees/s]
        "pivot": Optional[Vector],  # point about which `rotate` of the keyframes turns, before `translate` [m]
        "keyframes": Optional[Sequence["KeyframesOfAMotion"]],  # motion relative to its initial position: a list of tables; linear between them, rotation at constant speed; times ascend
        "contact": Optional[bool],  # `false` excludes it from contact; it is only drawn
        "friction": Optional[float],  # Coulomb's coefficient of its surface; a [pair](#contact) has the geometric mean
        "colour": Optional[Vector],  # colour in pictures [sRGB 0 to 1]
    },
    total=False,
)

BoxCollider = TypedDict(
    "BoxCollider",
    {
        "name": Optional[str],  # different for each body and collider
        "shape": Required[Literal["box"]],  # `"plane"`, `"sphere"`, `"capsule"`, `"box"` or `"mesh"`
        "center": Optional[Vector],  # its centre [m]
        "size": Required[Vector],  # lengths along x, y and z [m]
        "rotate": Optional[Vector],  # as of a body, about its centre [degrees]
        "density": Optional[float],  # makes it a rigid body of this density; a mesh must be closed. Without it gravity and other forces do not act on it [kg/m³]
        "velocity": Optional[Vector],  # velocity at the start; only with a density [m/s]
        "angular_velocity": Optional[Vector],  # rate of rotation at the start, along the axis through the centre of mass; only with a density [degrees/s]
        "pivot": Optional[Vector],  # point about which `rotate` of the keyframes turns, before `translate` [m]
        "keyframes": Optional[Sequence["KeyframesOfAMotion"]],  # motion relative to its initial position: a list of tables; linear between them, rotation at constant speed; times ascend
        "contact": Optional[bool],  # `false` excludes it from contact; it is only drawn
        "friction": Optional[float],  # Coulomb's coefficient of its surface; a [pair](#contact) has the geometric mean
        "colour": Optional[Vector],  # colour in pictures [sRGB 0 to 1]
    },
    total=False,
)

MeshCollider = TypedDict(
    "MeshCollider",
    {
        "name": Optional[str],  # different for each body and collider
        "shape": Required[Literal["mesh"]],  # `"plane"`, `"sphere"`, `"capsule"`, `"box"` or `"mesh"`
        "mesh": Required[Path],  # a file in a format of a body's mesh; open meshes stop bodies from both sides
        "translate": Optional[Vector],  # as of a body [m]
        "rotate": Optional[Vector],  # as of a body [degrees]
        "scale": Optional[Union[float, Vector]],  # a number or one per axis; applied first
        "sequence": Optional[Path],  # motion, in place of `keyframes`: a file with the position of every vertex of the mesh per frame: `.pc2`, `.mdd`, or numbered files `walk.####.obj`. `translate`, `rotate` and `scale` apply to it as to the mesh
        "frame_rate": Optional[float],  # frames per second of the sequence; not for an `.mdd`, which stores its own frame times [1/s]
        "start": Optional[float],  # time of the first sample; the collider is static before the first and after the last sample [s]
        "density": Optional[float],  # makes it a rigid body of this density; a mesh must be closed. Without it gravity and other forces do not act on it [kg/m³]
        "velocity": Optional[Vector],  # velocity at the start; only with a density [m/s]
        "angular_velocity": Optional[Vector],  # rate of rotation at the start, along the axis through the centre of mass; only with a density [degrees/s]
        "pivot": Optional[Vector],  # point about which `rotate` of the keyframes turns, before `translate` [m]
        "keyframes": Optional[Sequence["KeyframesOfAMotion"]],  # motion relative to its initial position: a list of tables; linear between them, rotation at constant speed; times ascend
        "contact": Optional[bool],  # `false` excludes it from contact; it is only drawn
        "friction": Optional[float],  # Coulomb's coefficient of its surface; a [pair](#contact) has the geometric mean
        "colour": Optional[Vector],  # colour in pictures [sRGB 0 to 1]
    },
    total=False,
)

Collider = Union[PlaneCollider, SphereCollider, CapsuleCollider, BoxCollider, MeshCollider]

LatticeBody = TypedDict(
    "LatticeBody",
    {
        "name": Optional[str],  # used in file names, messages and by pins; different for each body
        "mesh": Required[Path],  # `.obj`, `.ply`, `.stl`, `.gltf`, `.glb`, `.dae` or `.fbx`
        "model": Optional[Literal["lattice"]],  # `"lattice"`: voxels with springs, filled into the mesh · `"shell"`: the mesh itself as [thin cloth](shells.md)
        "thickness": Optional[float],  # thickness of a lattice that is a sheet: an open mesh, or one that encloses nothing. An open mesh with small holes is filled as a solid unless `thickness` is given [m]
        "voxel_width": Required[float],  # edge of a voxel: halving it doubles the detail and takes at least eight times as long for a solid, four times for a sheet [m]
        "voxels": Optional[Literal["cover", "threshold"]],  # `"cover"`: every voxel that meets the solid · `"threshold"`: every voxel whose centre has a signed distance below `threshold`
        "threshold": Optional[float],  # signed distance, negative inside; only with `voxels = "threshold"` [voxel widths]
        "bracing": Optional[Literal["kuhn", "full"]],  # `"kuhn"`: springs along the edges of six tetrahedra per voxel · `"full"`: all diagonals, equally stiff in mirrored directions
        "mass": Optional[Literal["solid", "cells"]],  # `"solid"`: mass and stiffness of a voxel are scaled by the share that the solid fills · `"cells"`: every voxel has full mass and stiffness
        "boundary_springs": Optional[Literal["full", "shared"]],  # `"full"`: springs on the surface are as stiff as inside · `"shared"`: scaled by the share of voxels around them, as in a solid cut out of a block. Without it a sheet of one voxel is 1.75 times too stiff in stretch and 4.5 times in bending
        "material": Required[Union[str, "MaterialOfALattice"]],  # a name (`muslin materials` lists them), the path of a material file (`.toml`), or a table
        "translate": Optional[Vector],  # displacement, applied last [m]
        "rotate": Optional[Vector],  # angles about the x axis, then y, then z [degrees]
        "scale": Optional[Union[float, Vector]],  # a number or one per axis; applied first
        "velocity": Optional[Vector],  # velocity at the start [m/s]
        "contact": Optional[bool],  # `false` excludes the body from contact
        "self_contact": Optional[bool],  # `false` excludes contact of the body with itself
        "friction": Optional[float],  # Coulomb's coefficient of its surface; a [pair](#contact) has the geometric mean
        "colour": Optional[Vector],  # colour of the body in pictures: red, green, blue [sRGB 0 to 1]
    },
    total=False,
)

ShellBody = TypedDict(
    "ShellBody",
    {
        "name": Optional[str],  # used in file names, messages and by pins; different for each body
        "mesh": Required[Path],  # `.obj`, `.ply`, `.stl`, `.gltf`, `.glb`, `.dae` or `.fbx`
        "model": Required[Literal["shell"]],  # `"lattice"`: voxels with springs, filled into the mesh · `"shell"`: the mesh itself as [thin cloth](shells.md)
        "thickness": Optional[float],  # thickness in contact [m]
        "rest_mesh": Optional[Path],  # a mesh with the same polygons in the stress-free shape; `scale` applies to it
        "warp": Optional[Vector],  # direction of the warp threads in the mesh as modelled
        "compression": Optional[Literal["buckling", "elastic"]],  # how threads resist compression: `buckling`, up to the load at which cells of the mesh fold; `elastic`, as they resist tension
        "stretch_limit": Optional[float],  # largest stretch of a triangle in any direction, as length over rest length; 1.05 allows 5 %
        "material": Required[Union[str, "MaterialOfAShell"]],  # a name (`muslin materials` lists them), the path of a material file (`.toml`), or a table
        "translate": Optional[Vector],  # displacement, applied last [m]
        "rotate": Optional[Vector],  # angles about the x axis, then y, then z [degrees]
        "scale": Optional[Union[float, Vector]],  # a number or one per axis; applied first
        "velocity": Optional[Vector],  # velocity at the start [m/s]
        "contact": Optional[bool],  # `false` excludes the body from contact
        "self_contact": Optional[bool],  # `false` excludes contact of the body with itself
        "friction": Optional[float],  # Coulomb's coefficient of its surface; a [pair](#contact) has the geometric mean
        "colour": Optional[Vector],  # colour of the body in pictures: red, green, blue [sRGB 0 to 1]
    },
    total=False,
)

Body = Union[LatticeBody, ShellBody]

Solver = TypedDict(
    "Solver",
    {
        "integrator": Optional[Literal["implicit_euler", "bdf2", "linearly_implicit_euler", "symplectic_euler"]],  # `"implicit_euler"`: first order, always stable, damps · `"bdf2"`: second order, always stable, damps little · `"linearly_implicit_euler"`: one Newton step · `"symplectic_euler"`: explicit, only stable for small steps
        "effort": Optional[Literal["draft", "normal", "exact"]],  # how accurately steps are solved: `"draft"`, to see whether a scene works · `"normal"`, for pictures · `"exact"`, for measurements
        "tolerance": Optional[float],  # a step has converged when its estimated error, as displacement, is at most this share of the displacement that the present accelerations cause in a step
        "linear_tolerance": Optional[float],  # relative residual of the linear solve of `linearly_implicit_euler`
    },
    total=False,
)

Time = TypedDict(
    "Time",
    {
        "duration": Optional[float],  # simulated time; rounded up to whole frames, at most a million of them [s]
        "frame_rate": Optional[float],  # frames per second [1/s]
        "steps_per_frame": Optional[Union[Literal["auto"], int]],  # time steps per frame: `"auto"`, as many as the motion needs, or a whole number
    },
    total=False,
)

Scene = TypedDict(
    "Scene",
    {
        "title": Optional[str],  # name for the reader
        "time": Optional["Time"],  # duration, frames and time steps
        "solver": Optional["Solver"],  # integrator and accuracy
        "body": Optional[Sequence["Body"]],  # the simulated bodies
        "collider": Optional[Sequence["Collider"]],  # obstacles and rigid bodies
        "contact": Optional["Contact"],  # contact distance and friction
        "pin": Optional[Sequence["Pin"]],  # prescribed vertices
        "force": Optional[Sequence["Force"]],  # gravity, point forces, wind; without a gravity force there is no gravity
        "pressure": Optional[Sequence["Pressure"]],  # pressures inside shells
        "probe": Optional[Sequence["Probe"]],  # points whose path is written to `probes.csv`
    },
    total=False,
)
