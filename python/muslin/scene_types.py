"""Types of the tables that make_scene takes. Written by `muslin schema --python`; do not edit."""

# ruff: noqa: E501, UP007, UP013, UP045
import os
import sys
from collections.abc import Sequence
from typing import Any, Literal, Optional, TypedDict, Union

import numpy as np
import numpy.typing as npt

from muslin._muslin import Mesh

if sys.version_info >= (3, 11):
    from typing import Required
else:  # which type checkers alone know
    Required = Optional

Vector = Union[Sequence[float], npt.NDArray[np.floating[Any]]]
Points = Union[Sequence[Vector], npt.NDArray[np.floating[Any]]]
Path = Union[str, os.PathLike[str], Mesh]

RegionPlane = TypedDict(
    "RegionPlane",
    {
        "point": Required[Vector],  # a point of the plane [m]
        "normal": Required[Vector],  # normal of the plane, on the side of the region
    },
    total=False,
)

RegionCylinder = TypedDict(
    "RegionCylinder",
    {
        "from": Required[Vector],  # centre of one end [m]
        "to": Required[Vector],  # centre of the other end [m]
        "radius": Required[float],  # its radius [m]
    },
    total=False,
)

RegionSphere = TypedDict(
    "RegionSphere",
    {
        "center": Required[Vector],  # its centre [m]
        "radius": Required[float],  # its radius [m]
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

ASideOfBetween = TypedDict(
    "ASideOfBetween",
    {
        "body": Required[str],  # a body or collider
        "group": Optional[str],  # a group of vertices or faces of its mesh; an edge or triangle belongs to it if any of its corners does
    },
    total=False,
)

KeyframesOfANumber = TypedDict(
    "KeyframesOfANumber",
    {
        "time": Required[float],  # time of the keyframe, later than the previous one [s]
        "value": Required[float],  # the number at that time
        "interpolation": Optional[Literal["linear", "step", "smooth"]],  # the way to the next keyframe: `"linear"`, at a constant rate · `"step"`, at once when it is reached · `"smooth"`, begins and ends at rest and never overshoots
    },
    total=False,
)

KeyframesOfAnEffort = TypedDict(
    "KeyframesOfAnEffort",
    {
        "time": Required[float],  # time of the keyframe, later than the previous one [s]
        "value": Required[Literal["draft", "normal", "exact"]],  # the effort from that time on
    },
    total=False,
)

Region = TypedDict(
    "Region",
    {
        "box": Optional[Points],  # the box between two corners `[[x, y, z], [x, y, z]]`, the smaller coordinates first [m]
        "sphere": Optional["RegionSphere"],  # the ball within `radius` of `center`
        "cylinder": Optional["RegionCylinder"],  # the cylinder of this `radius` with its flat ends at `from` and `to`
        "plane": Optional["RegionPlane"],  # the half space of the plane through `point` to which `normal` points
        "fade": Optional[float],  # depth below its surface at which the field is full; at the surface it is 0 [m]
    },
    total=False,
)

Falloff = TypedDict(
    "Falloff",
    {
        "power": Optional[float],  # the weight is (1 + (r − `min`) / `length`)^−`power` at the distance r
        "min": Optional[float],  # distance up to which the weight is 1 [m]
        "length": Optional[float],  # distance beyond `min` at which the weight is ½ for a power of 1 [m]
        "max": Optional[float],  # distance beyond which the weight is 0 [m]
    },
    total=False,
)

ANumberOverTime = TypedDict(
    "ANumberOverTime",
    {
        "keyframes": Required[Sequence["KeyframesOfANumber"]],  # a list of tables; times ascend; constant before the first and after the last
    },
    total=False,
)

KeyframesOfWind = TypedDict(
    "KeyframesOfWind",
    {
        "time": Required[float],  # time of the keyframe, later than the previous one [s]
        "value": Required[Vector],  # `velocity` at that time [m/s]
        "interpolation": Optional[Literal["linear", "step", "smooth"]],  # the way to the next keyframe: `"linear"`, at a constant rate · `"step"`, at once when it is reached · `"smooth"`, begins and ends at rest and never overshoots
    },
    total=False,
)

KeyframesOfPoint = TypedDict(
    "KeyframesOfPoint",
    {
        "time": Required[float],  # time of the keyframe, later than the previous one [s]
        "value": Required[Vector],  # `force` at that time [N]
        "interpolation": Optional[Literal["linear", "step", "smooth"]],  # the way to the next keyframe: `"linear"`, at a constant rate · `"step"`, at once when it is reached · `"smooth"`, begins and ends at rest and never overshoots
    },
    total=False,
)

KeyframesOfGravity = TypedDict(
    "KeyframesOfGravity",
    {
        "time": Required[float],  # time of the keyframe, later than the previous one [s]
        "value": Required[Vector],  # `acceleration` at that time [m/s²]
        "interpolation": Optional[Literal["linear", "step", "smooth"]],  # the way to the next keyframe: `"linear"`, at a constant rate · `"step"`, at once when it is reached · `"smooth"`, begins and ends at rest and never overshoots
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

ContactPair = TypedDict(
    "ContactPair",
    {
        "between": Required[Sequence[Union[str, "ASideOfBetween"]]],  # two bodies or colliders by name, twice the same one for a body with itself; `{ body = …, group = … }` in place of a name takes only a group of its vertices
        "contact": Optional[bool],  # `false`: the two pass through each other · `true`: they meet, though an earlier pair says that they do not
        "thickness": Optional[float],  # distance of their midsurfaces when they touch; balls and capsules add their radius [m]
        "distance": Optional[float],  # contact distance: they repel each other where the gap is below it [m]
        "friction": Optional[Union[float, "ANumberThatVaries"]],  # Coulomb's coefficient between them
        "stiffness": Optional[float],  # stiffness of a contact between them [N/m]
        "from": Optional[float],  # time from which the pair is in force [s]
        "until": Optional[float],  # time when it ends, after `from` [s]
    },
    total=False,
)

KeyframesOfAMotion = TypedDict(
    "KeyframesOfAMotion",
    {
        "time": Required[float],  # time of the keyframe, later than the previous one [s]
        "translate": Optional[Vector],  # displacement from the modelled place [m]
        "rotate": Optional[Vector],  # rotation about `pivot`: about the x axis, then y, then z; 360 is a full turn [degrees]
        "scale": Optional[Union[float, Vector]],  # of pins: scale about `pivot`, a number or one per axis; applied first
        "interpolation": Optional[Literal["linear", "step", "smooth"]],  # the way to the next keyframe: `"linear"`, at a constant rate · `"step"`, at once when it is reached · `"smooth"`, begins and ends at rest and never overshoots
    },
    total=False,
)

MaterialOfAShell = TypedDict(
    "MaterialOfAShell",
    {
        "base": Optional[str],  # a material by name or path that has `[shell]` numbers; the other keys change it
        "areal_density": Optional[Union[float, "ANumberThatVaries"]],  # mass per area [kg/m²]
        "membrane_warp": Optional[Union[float, "ANumberThatVaries"]],  # force per width and strain along warp: Young's modulus × thickness [N/m]
        "membrane_weft": Optional[Union[float, "ANumberThatVaries"]],  # force per width and strain along weft [N/m]
        "membrane_shear": Optional[Union[float, "ANumberThatVaries"]],  # force per width and radian [N/m]
        "warp_curve": Optional[Points],  # measured, in place of `membrane_warp`: up to 10 points `[[strain, force per width], …]` of a strip pulled along warp [1, N/m]
        "weft_curve": Optional[Points],  # in place of `membrane_weft`: points of a strip pulled along weft [1, N/m]
        "shear_curve": Optional[Points],  # in place of `membrane_shear`: points `[[angle, force per length], …]` of a shear test [°, N/m]
        "poisson": Optional[float],  # Poisson's ratio of stretch and bending: geometric mean of the two directions
        "bending_warp": Optional[Union[float, "ANumberThatVaries"]],  # moment per width and curvature when warp bends [N·m]
        "bending_weft": Optional[Union[float, "ANumberThatVaries"]],  # moment per width and curvature when weft bends [N·m]
        "bending_bias": Optional[Union[float, "ANumberThatVaries"]],  # moment per width and curvature for bending at 45°; at least (warp + weft + 2 ν √(warp weft))/4, where the sheet no longer resists twisting [N·m]
        "bending_warp_curve": Optional[Points],  # measured, in place of `bending_warp`: up to 10 points `[[curvature, moment per width], …]` [1/m, N]
        "bending_weft_curve": Optional[Points],  # in place of `bending_weft`: points `[[curvature, moment per width], …]` when weft bends [1/m, N]
        "bending_friction_warp": Optional[float],  # internal friction: greatest moment per width with which warp resists every change of curvature, half of KES-FB2's 2HB; 0 is off [N]
        "bending_friction_weft": Optional[float],  # internal friction when weft bends [N]
        "bending_friction_curvature": Optional[float],  # change of curvature over which internal friction builds up [1/m]
        "yield_curvature": Optional[float],  # curvature of bent warp beyond which the sheet keeps a crease: released, it stays bent by what is above it [1/m]
        "yield_hardening": Optional[float],  # stiffness beyond yield over that below
        "yield_recovery": Optional[float],  # time in which creases fade to 37 % of themselves, as under an iron [s]
        "yield_strain": Optional[float],  # strain of a strip pulled along a thread beyond which the thread stays longer, as a knee bags: released, it keeps what is above it; needs `compression = "elastic"`
        "strain_hardening": Optional[float],  # stiffness of stretch beyond yield over that below
        "stretch_limit": Optional[Union[float, "ANumberThatVaries"]],  # largest stretch in any direction, as length over rest length, unless the body has a `stretch_limit` of its own
        "mass_damping": Optional[Union[float, "ANumberThatVaries"]],  # Rayleigh's α: slows all motion [1/s]
        "stiffness_damping": Optional[Union[float, "ANumberThatVaries"]],  # Rayleigh's β of stretch and shear [s]
        "bending_damping": Optional[Union[float, "ANumberThatVaries"]],  # Rayleigh's β of bending [s]
    },
    total=False,
)

BodyFabric = TypedDict(
    "BodyFabric",
    {
        "faces": Required[str],  # a face group of the mesh (OBJ `g`), or a material of its file (`usemtl` of OBJ, materials of glTF)
        "material": Required[Union[str, "MaterialOfAShell"]],  # a name (`muslin materials` lists them), the path of a material file (`.toml`), or a table
        "friction": Optional[Union[float, "ANumberThatVaries"]],  # Coulomb's coefficient of its faces; vertices of several fabrics have that of the last one with its own
    },
    total=False,
)

ANumberThatVaries = TypedDict(
    "ANumberThatVaries",
    {
        "map": Optional[str],  # where it varies: an attribute or group of the mesh, or a file of numbers
        "from": Optional[float],  # the number where the map has its `lowest` value
        "to": Optional[float],  # the number where the map has its `highest` value
        "lowest": Optional[float],  # value of the map that stands for `from`
        "highest": Optional[float],  # value of the map that stands for `to`
        "curve": Optional[Points],  # points `[[weight, share], …]` between 0 and 1: the number goes from `from` to `to` by the share
        "keyframes": Optional[Sequence["KeyframesOfANumber"]],  # when it varies: constant before the first and after the last
    },
    total=False,
)

MaterialOfALattice = TypedDict(
    "MaterialOfALattice",
    {
        "base": Optional[str],  # a material by name or path; the other keys change it
        "shear_modulus": Optional[float],  # shear modulus of the springs, only with `youngs_modulus` [N/m²]
        "density": Optional[Union[float, "ANumberThatVaries"]],  # mass per volume [kg/m³]
        "edge_modulus": Optional[Union[float, "ANumberThatVaries"]],  # modulus of springs along voxel edges; a spring's constant is modulus × voxel width [N/m²]
        "face_diagonal_modulus": Optional[Union[float, "ANumberThatVaries"]],  # modulus of springs along face diagonals [N/m²]
        "body_diagonal_modulus": Optional[Union[float, "ANumberThatVaries"]],  # modulus of springs along body diagonals [N/m²]
        "volume_modulus": Optional[Union[float, "ANumberThatVaries"]],  # resistance of each voxel to a change of volume; 0 is off [N/m²]
        "yield_strain": Optional[float],  # of springs: strain, in stretch or compression, beyond which a spring keeps another length: released, it keeps what is above it
        "strain_hardening": Optional[float],  # stiffness beyond yield over that below
        "mass_damping": Optional[Union[float, "ANumberThatVaries"]],  # Rayleigh's α: slows all motion, like a viscous fluid [1/s]
        "stiffness_damping": Optional[Union[float, "ANumberThatVaries"]],  # Rayleigh's β: damps stretching only [s]
        "law": Optional[Literal["springs", "neo_hookean"]],  # `neo_hookean`: a solid of tetrahedra in place of springs, with a stated E and ν
        "youngs_modulus": Optional[Union[float, "ANumberThatVaries"]],  # Young's modulus of the solid; with springs, of a large block along its axes, in place of the three moduli [N/m²]
        "poisson": Optional[float],  # Poisson's ratio of the solid
    },
    total=False,
)

AnEffortOverTime = TypedDict(
    "AnEffortOverTime",
    {
        "keyframes": Required[Sequence["KeyframesOfAnEffort"]],  # a list of tables; times ascend; before the first its effort holds
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

Attachment = TypedDict(
    "Attachment",
    {
        "name": Optional[str],  # name in messages and in `attachments.csv`
        "body": Optional[str],  # a body, or a collider with a density; must be given if there are several
        "where": Optional["Where"],  # selection of its vertices; for a collider with a density those of its mesh
        "to": Required[str],  # the body or collider that they are attached to
        "where_to": Optional["Where"],  # selection of vertices of `to`: each vertex is attached to the nearest one
        "at": Optional[Vector],  # a point of `to` at the start, in place of `where_to`: all are attached to this one [m]
        "rest": Optional[Literal["joined", "distance", "cord"]],  # `"joined"`: the points are pulled together · `"distance"`: they keep the distance that they have when it begins · `"cord"`: they come no farther apart than that
        "stiffness": Optional[Union[float, "ANumberThatVaries"]],  # of the whole attachment; each vertex has a share by its mass [N/m]
        "damping": Optional[Union[float, "ANumberThatVaries"]],  # of the whole attachment, against relative motion of the points [N·s/m]
        "break_force": Optional[Union[float, "ANumberThatVaries"]],  # of the whole attachment: a vertex whose force exceeds its share is free from then on [N]
        "weight": Optional[Union[float, "ANumberThatVaries"]],  # at each selected vertex, as a factor of stiffness, damping and breaking force; where it is 0 the vertex is not attached
        "from": Optional[float],  # start time [s]
        "until": Optional[float],  # release time, after `from` [s]
    },
    total=False,
)

Pressure = TypedDict(
    "Pressure",
    {
        "name": Optional[str],  # name in messages
        "body": Optional[str],  # a shell that is closed or nearly closed; flat lids close its holes
        "pressure": Required[Union[float, "ANumberOverTime"]],  # excess over the outside, constant or `{ keyframes = [{ time = …, value = … }, …] }`; of a gas: its excess while the surface encloses the volume at rest [Pa]
        "weight": Optional[Union[float, "ANumberThatVaries"]],  # factor of the pressure at each vertex; of a gas always 1
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
        "type": Required[Literal["gravity"]],  # `"gravity"`, `"point"`, `"wind"`, `"uniform"`, `"radial"`, `"vortex"`, `"turbulence"`, `"grid"`, `"curve"` or `"drag"`
        "body": Optional[str],  # the body it acts on
        "acceleration": Optional[Vector],  # acceleration of all bodies it acts on [m/s²]
        "keyframes": Optional[Sequence["KeyframesOfGravity"]],  # the value over time in place of a constant: a list of tables; times ascend
        "from": Optional[float],  # time when it begins to act [s]
        "until": Optional[float],  # time when it ends, after `from` [s]
    },
    total=False,
)

PointForce = TypedDict(
    "PointForce",
    {
        "name": Optional[str],  # name in messages
        "type": Required[Literal["point"]],  # `"gravity"`, `"point"`, `"wind"`, `"uniform"`, `"radial"`, `"vortex"`, `"turbulence"`, `"grid"`, `"curve"` or `"drag"`
        "body": Optional[str],  # a body, or a collider with a density; must be given if there are several
        "where": Optional["Where"],  # selection of vertices; for a collider with a density those of its mesh, or, without `where`, its centre of mass
        "force": Optional[Vector],  # force on each selected vertex [N]
        "keyframes": Optional[Sequence["KeyframesOfPoint"]],  # the value over time in place of a constant: a list of tables; times ascend
        "from": Optional[float],  # time when it begins to act [s]
        "until": Optional[float],  # time when it ends, after `from` [s]
    },
    total=False,
)

WindForce = TypedDict(
    "WindForce",
    {
        "name": Optional[str],  # name in messages
        "type": Required[Literal["wind"]],  # `"gravity"`, `"point"`, `"wind"`, `"uniform"`, `"radial"`, `"vortex"`, `"turbulence"`, `"grid"`, `"curve"` or `"drag"`
        "body": Optional[str],  # the body it acts on
        "velocity": Optional[Vector],  # mean velocity of the air [m/s]
        "keyframes": Optional[Sequence["KeyframesOfWind"]],  # the value over time in place of a constant: a list of tables; times ascend
        "from": Optional[float],  # time when it begins to act [s]
        "until": Optional[float],  # time when it ends, after `from` [s]
        "air_density": Optional[Union[float, "ANumberOverTime"]],  # density of the air [kg/m³]
        "drag": Optional[Union[float, "ANumberOverTime"]],  # drag coefficient; 1.17 is a square plate, broadside
        "lift": Optional[Union[float, "ANumberOverTime"]],  # lift coefficient, at most `drag`
        "gust": Optional[Union[float, "ANumberOverTime"]],  # root mean square of each component of the turbulence [m/s]
        "gust_length": Optional[float],  # size of its largest eddies [m]
        "seed": Optional[int],  # whole number that seeds the turbulence
        "porosity": Optional[float],  # open share of the surface, through which air passes: drag and lift are those of the rest
    },
    total=False,
)

UniformForce = TypedDict(
    "UniformForce",
    {
        "name": Optional[str],  # name in messages
        "type": Required[Literal["uniform"]],  # `"gravity"`, `"point"`, `"wind"`, `"uniform"`, `"radial"`, `"vortex"`, `"turbulence"`, `"grid"`, `"curve"` or `"drag"`
        "body": Optional[str],  # the body it acts on
        "from": Optional[float],  # time when it begins to act [s]
        "until": Optional[float],  # time when it ends, after `from` [s]
        "acts_as": Required[Literal["wind", "acceleration"]],  # `"wind"`: a velocity that adds to the air of a wind and acts through its drag and lift; `"acceleration"`: it accelerates all mass
        "wind": Optional[str],  # the name of the wind to which it adds
        "strength": Required[Union[float, "ANumberOverTime"]],  # size of the vectors before falloff, constant or `{ keyframes = [{ time = …, value = … }, …] }` [m/s or m/s²]
        "center": Optional[Vector],  # its centre: falloff counts from there, positions of the kind are relative to it [m]
        "travel": Optional[Vector],  # velocity at which it moves, without its region: what it does at x and t is what it did at x − t `travel` and 0 [m/s]
        "falloff": Optional["Falloff"],  # how it weakens with the distance from its centre, a vortex from its axis, a curve from the curve
        "region": Optional["Region"],  # where it acts, a table; of several shapes where all of them overlap
        "direction": Required[Vector],  # direction
    },
    total=False,
)

RadialForce = TypedDict(
    "RadialForce",
    {
        "name": Optional[str],  # name in messages
        "type": Required[Literal["radial"]],  # `"gravity"`, `"point"`, `"wind"`, `"uniform"`, `"radial"`, `"vortex"`, `"turbulence"`, `"grid"`, `"curve"` or `"drag"`
        "body": Optional[str],  # the body it acts on
        "from": Optional[float],  # time when it begins to act [s]
        "until": Optional[float],  # time when it ends, after `from` [s]
        "acts_as": Required[Literal["wind", "acceleration"]],  # `"wind"`: a velocity that adds to the air of a wind and acts through its drag and lift; `"acceleration"`: it accelerates all mass
        "wind": Optional[str],  # the name of the wind to which it adds
        "strength": Required[Union[float, "ANumberOverTime"]],  # size of the vectors before falloff, constant or `{ keyframes = [{ time = …, value = … }, …] }` [m/s or m/s²]
        "center": Optional[Vector],  # its centre: falloff counts from there, positions of the kind are relative to it [m]
        "travel": Optional[Vector],  # velocity at which it moves, without its region: what it does at x and t is what it did at x − t `travel` and 0 [m/s]
        "falloff": Optional["Falloff"],  # how it weakens with the distance from its centre, a vortex from its axis, a curve from the curve
        "region": Optional["Region"],  # where it acts, a table; of several shapes where all of them overlap
    },
    total=False,
)

VortexForce = TypedDict(
    "VortexForce",
    {
        "name": Optional[str],  # name in messages
        "type": Required[Literal["vortex"]],  # `"gravity"`, `"point"`, `"wind"`, `"uniform"`, `"radial"`, `"vortex"`, `"turbulence"`, `"grid"`, `"curve"` or `"drag"`
        "body": Optional[str],  # the body it acts on
        "from": Optional[float],  # time when it begins to act [s]
        "until": Optional[float],  # time when it ends, after `from` [s]
        "acts_as": Required[Literal["wind", "acceleration"]],  # `"wind"`: a velocity that adds to the air of a wind and acts through its drag and lift; `"acceleration"`: it accelerates all mass
        "wind": Optional[str],  # the name of the wind to which it adds
        "strength": Required[Union[float, "ANumberOverTime"]],  # size of the vectors before falloff, constant or `{ keyframes = [{ time = …, value = … }, …] }` [m/s or m/s²]
        "center": Optional[Vector],  # its centre: falloff counts from there, positions of the kind are relative to it [m]
        "travel": Optional[Vector],  # velocity at which it moves, without its region: what it does at x and t is what it did at x − t `travel` and 0 [m/s]
        "falloff": Optional["Falloff"],  # how it weakens with the distance from its centre, a vortex from its axis, a curve from the curve
        "region": Optional["Region"],  # where it acts, a table; of several shapes where all of them overlap
        "axis": Optional[Vector],  # its axis, through the centre; it turns counterclockwise seen against it
        "radius": Optional[float],  # distance from the axis at which the size is `strength`: inside it grows in proportion, outside it falls like 1/r, unless there is another `falloff` [m]
    },
    total=False,
)

TurbulenceForce = TypedDict(
    "TurbulenceForce",
    {
        "name": Optional[str],  # name in messages
        "type": Required[Literal["turbulence"]],  # `"gravity"`, `"point"`, `"wind"`, `"uniform"`, `"radial"`, `"vortex"`, `"turbulence"`, `"grid"`, `"curve"` or `"drag"`
        "body": Optional[str],  # the body it acts on
        "from": Optional[float],  # time when it begins to act [s]
        "until": Optional[float],  # time when it ends, after `from` [s]
        "acts_as": Required[Literal["wind", "acceleration"]],  # `"wind"`: a velocity that adds to the air of a wind and acts through its drag and lift; `"acceleration"`: it accelerates all mass
        "wind": Optional[str],  # the name of the wind to which it adds
        "strength": Required[Union[float, "ANumberOverTime"]],  # size of the vectors before falloff, constant or `{ keyframes = [{ time = …, value = … }, …] }` [m/s or m/s²]
        "center": Optional[Vector],  # its centre: falloff counts from there, positions of the kind are relative to it [m]
        "travel": Optional[Vector],  # velocity at which it moves, without its region: what it does at x and t is what it did at x − t `travel` and 0 [m/s]
        "falloff": Optional["Falloff"],  # how it weakens with the distance from its centre, a vortex from its axis, a curve from the curve
        "region": Optional["Region"],  # where it acts, a table; of several shapes where all of them overlap
        "largest": Optional[float],  # size of the largest eddies [m]
        "smallest": Optional[float],  # size of the smallest eddies [m]
        "turnover": Optional[float],  # time in which the largest eddies turn over; smaller ones are faster [s]
        "seed": Optional[int],  # whole number that seeds the turbulence
    },
    total=False,
)

GridForce = TypedDict(
    "GridForce",
    {
        "name": Optional[str],  # name in messages
        "type": Required[Literal["grid"]],  # `"gravity"`, `"point"`, `"wind"`, `"uniform"`, `"radial"`, `"vortex"`, `"turbulence"`, `"grid"`, `"curve"` or `"drag"`
        "body": Optional[str],  # the body it acts on
        "from": Optional[float],  # time when it begins to act [s]
        "until": Optional[float],  # time when it ends, after `from` [s]
        "acts_as": Required[Literal["wind", "acceleration"]],  # `"wind"`: a velocity that adds to the air of a wind and acts through its drag and lift; `"acceleration"`: it accelerates all mass
        "wind": Optional[str],  # the name of the wind to which it adds
        "strength": Required[Union[float, "ANumberOverTime"]],  # size of the vectors before falloff, constant or `{ keyframes = [{ time = …, value = … }, …] }` [m/s or m/s²]
        "center": Optional[Vector],  # its centre: falloff counts from there, positions of the kind are relative to it [m]
        "travel": Optional[Vector],  # velocity at which it moves, without its region: what it does at x and t is what it did at x − t `travel` and 0 [m/s]
        "falloff": Optional["Falloff"],  # how it weakens with the distance from its centre, a vortex from its axis, a curve from the curve
        "region": Optional["Region"],  # where it acts, a table; of several shapes where all of them overlap
        "file": Required[Path],  # a `.npy` file with an array of shape (nx, ny, nz, 3), floats or integers: the vectors at the nodes, linear between them, 0 outside
        "origin": Optional[Vector],  # the first node, relative to the centre [m]
        "spacing": Optional[Vector],  # distances of the nodes along x, y and z, above 0 [m]
    },
    total=False,
)

CurveForce = TypedDict(
    "CurveForce",
    {
        "name": Optional[str],  # name in messages
        "type": Required[Literal["curve"]],  # `"gravity"`, `"point"`, `"wind"`, `"uniform"`, `"radial"`, `"vortex"`, `"turbulence"`, `"grid"`, `"curve"` or `"drag"`
        "body": Optional[str],  # the body it acts on
        "from": Optional[float],  # time when it begins to act [s]
        "until": Optional[float],  # time when it ends, after `from` [s]
        "acts_as": Required[Literal["wind", "acceleration"]],  # `"wind"`: a velocity that adds to the air of a wind and acts through its drag and lift; `"acceleration"`: it accelerates all mass
        "wind": Optional[str],  # the name of the wind to which it adds
        "strength": Required[Union[float, "ANumberOverTime"]],  # size of the vectors before falloff, constant or `{ keyframes = [{ time = …, value = … }, …] }` [m/s or m/s²]
        "center": Optional[Vector],  # its centre: falloff counts from there, positions of the kind are relative to it [m]
        "travel": Optional[Vector],  # velocity at which it moves, without its region: what it does at x and t is what it did at x − t `travel` and 0 [m/s]
        "falloff": Optional["Falloff"],  # how it weakens with the distance from its centre, a vortex from its axis, a curve from the curve
        "region": Optional["Region"],  # where it acts, a table; of several shapes where all of them overlap
        "points": Required[Points],  # the curve, at least two points `[[x, y, z], …]`: it acts along it, from the first to the last [m]
        "attraction": Optional[float],  # further size towards the curve, as a share of `strength`
        "reach": Optional[float],  # distance at which the attraction is full; inside it is proportional to the distance [m]
    },
    total=False,
)

DragForce = TypedDict(
    "DragForce",
    {
        "name": Optional[str],  # name in messages
        "type": Required[Literal["drag"]],  # `"gravity"`, `"point"`, `"wind"`, `"uniform"`, `"radial"`, `"vortex"`, `"turbulence"`, `"grid"`, `"curve"` or `"drag"`
        "body": Optional[str],  # the body it acts on
        "from": Optional[float],  # time when it begins to act [s]
        "until": Optional[float],  # time when it ends, after `from` [s]
        "strength": Optional[Union[float, "ANumberOverTime"]],  # factor of both coefficients, constant or `{ keyframes = [{ time = …, value = … }, …] }`
        "center": Optional[Vector],  # its centre: falloff counts from there, positions of the kind are relative to it [m]
        "travel": Optional[Vector],  # velocity at which it moves, without its region: what it does at x and t is what it did at x − t `travel` and 0 [m/s]
        "falloff": Optional["Falloff"],  # how it weakens with the distance from its centre, a vortex from its axis, a curve from the curve
        "region": Optional["Region"],  # where it acts, a table; of several shapes where all of them overlap
        "linear": Optional[float],  # deceleration per speed [1/s]
        "quadratic": Optional[float],  # deceleration per square of the speed [1/m]
    },
    total=False,
)

Force = Union[GravityForce, PointForce, WindForce, UniformForce, RadialForce, VortexForce, TurbulenceForce, GridForce, CurveForce, DragForce]

Pin = TypedDict(
    "Pin",
    {
        "name": Optional[str],  # name in messages and in `selections.json`
        "body": Optional[str],  # a body, or a collider with a density; must be given if there are several
        "where": Optional["Where"],  # selection of vertices; a collider with a density is held as a whole, without `where`
        "from": Optional[float],  # start time; the vertices are held at their positions at that time [s]
        "until": Optional[float],  # release time, after `from` [s]
        "stiffness": Optional[float],  # of the whole pin, which is then soft: springs pull its vertices to their targets; each has a share by its mass [N/m]
        "time": Optional[float],  # in place of `stiffness`: time in which a critically damped soft pin brings its body to the target [s]
        "damping": Optional[float],  # of the whole pin, against motion relative to the target [N·s/m]
        "weight": Optional[Union[float, "ANumberThatVaries"]],  # of a soft pin at each vertex, as a factor of stiffness and damping; where it is 0 the vertex is free
        "pivot": Optional[Vector],  # point about which `rotate` turns and `scale` scales [m]
        "sequence": Optional[Path],  # motion, in place of `keyframes`: a file with the position of every vertex of the body's mesh per frame: `.pc2`, `.mdd`, or numbered files `walk.####.obj`. Metres, y up, in the world
        "keyframes": Optional[Sequence["KeyframesOfAMotion"]],  # motion: a list of tables; times ascend
        "ignore": Optional[Sequence[str]],  # bodies and colliders that the held vertices, with the edges and triangles at them, pass through while the pin holds
    },
    total=False,
)

Contact = TypedDict(
    "Contact",
    {
        "distance": Optional[float],  # contact distance: surfaces repel each other where the gap is below it [m]
        "friction": Optional[Union[float, "ANumberThatVaries"]],  # Coulomb's coefficient of each body and collider without its own `friction`
        "tangled": Optional[Literal["refuse", "repair", "ignore"]],  # a start at which surfaces cross: `"refuse"` it · `"repair"` it before the first frame · `"ignore"`: leave them free of each other until they part
        "pair": Optional[Sequence["ContactPair"]],  # how two of them meet, in place of what they say of themselves
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
        "keyframes": Optional[Sequence["KeyframesOfAMotion"]],  # motion relative to its initial position: a list of tables; times ascend
        "contact": Optional[bool],  # `false` excludes it from contact; it is only drawn
        "friction": Optional[Union[float, "ANumberThatVaries"]],  # Coulomb's coefficient of its surface; a [pair](#contact) has the geometric mean
        "layer": Optional[int],  # order outward (skin 0, shirt 1, jacket 2): at a [tangled start](contact.md#a-tangled-start) a body belongs outside those of lower layers
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
        "keyframes": Optional[Sequence["KeyframesOfAMotion"]],  # motion relative to its initial position: a list of tables; times ascend
        "contact": Optional[bool],  # `false` excludes it from contact; it is only drawn
        "friction": Optional[Union[float, "ANumberThatVaries"]],  # Coulomb's coefficient of its surface; a [pair](#contact) has the geometric mean
        "layer": Optional[int],  # order outward (skin 0, shirt 1, jacket 2): at a [tangled start](contact.md#a-tangled-start) a body belongs outside those of lower layers
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
        "keyframes": Optional[Sequence["KeyframesOfAMotion"]],  # motion relative to its initial position: a list of tables; times ascend
        "contact": Optional[bool],  # `false` excludes it from contact; it is only drawn
        "friction": Optional[Union[float, "ANumberThatVaries"]],  # Coulomb's coefficient of its surface; a [pair](#contact) has the geometric mean
        "layer": Optional[int],  # order outward (skin 0, shirt 1, jacket 2): at a [tangled start](contact.md#a-tangled-start) a body belongs outside those of lower layers
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
        "keyframes": Optional[Sequence["KeyframesOfAMotion"]],  # motion relative to its initial position: a list of tables; times ascend
        "contact": Optional[bool],  # `false` excludes it from contact; it is only drawn
        "friction": Optional[Union[float, "ANumberThatVaries"]],  # Coulomb's coefficient of its surface; a [pair](#contact) has the geometric mean
        "layer": Optional[int],  # order outward (skin 0, shirt 1, jacket 2): at a [tangled start](contact.md#a-tangled-start) a body belongs outside those of lower layers
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
        "keyframes": Optional[Sequence["KeyframesOfAMotion"]],  # motion relative to its initial position: a list of tables; times ascend
        "contact": Optional[bool],  # `false` excludes it from contact; it is only drawn
        "friction": Optional[Union[float, "ANumberThatVaries"]],  # Coulomb's coefficient of its surface; a [pair](#contact) has the geometric mean
        "layer": Optional[int],  # order outward (skin 0, shirt 1, jacket 2): at a [tangled start](contact.md#a-tangled-start) a body belongs outside those of lower layers
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
        "inside": Optional[Literal["auto", "filled", "sheet"]],  # `"auto"`: a mesh that is closed, or has small holes only, is a solid, any other a sheet · `"filled"`: a solid, wherever the winding number of the mesh is above one half, however large its holes · `"sheet"`: a sheet, though the mesh is closed
        "thickness": Optional[float],  # thickness of a lattice that is a sheet: an open mesh, or one that encloses nothing. An open mesh with small holes is filled as a solid unless `thickness` is given [m]
        "voxel_width": Required[float],  # edge of a voxel: halving it doubles the detail and takes at least eight times as long for a solid, four times for a sheet [m]
        "voxels": Optional[Literal["cover", "threshold"]],  # `"cover"`: every voxel that meets the solid · `"threshold"`: every voxel whose centre has a signed distance below `threshold`
        "threshold": Optional[float],  # signed distance, negative inside; only with `voxels = "threshold"` [voxel widths]
        "separate_parts": Optional[bool],  # `true`: solids of the mesh that are apart stay apart, even if they are nearer than a voxel. Parts that cross each other, or lie one inside the other, are one solid
        "bracing": Optional[Literal["kuhn", "full"]],  # `"kuhn"`: springs along the edges of six tetrahedra per voxel · `"full"`: all diagonals, equally stiff in mirrored directions
        "mass": Optional[Literal["solid", "cells"]],  # `"solid"`: mass and stiffness of a voxel are scaled by the share that the solid fills · `"cells"`: every voxel has full mass and stiffness
        "boundary_springs": Optional[Literal["full", "shared"]],  # `"full"`: springs on the surface are as stiff as inside · `"shared"`: scaled by the share of voxels around them, as in a solid cut out of a block. Without it a sheet of one voxel is 1.75 times too stiff in stretch and 4.5 times in bending
        "material": Required[Union[str, "MaterialOfALattice"]],  # a name (`muslin materials` lists them), the path of a material file (`.toml`), or a table
        "translate": Optional[Vector],  # displacement, applied last [m]
        "rotate": Optional[Vector],  # angles about the x axis, then y, then z [degrees]
        "scale": Optional[Union[float, Vector]],  # a number or one per axis; applied first
        "weld": Optional[float],  # joins vertices of the mesh that lie nearer than this, after `scale`; files that are written keep all vertices [m]
        "velocity": Optional[Vector],  # velocity at the start [m/s]
        "contact": Optional[bool],  # `false` excludes the body from contact
        "self_contact": Optional[bool],  # `false` excludes contact of the body with itself
        "friction": Optional[Union[float, "ANumberThatVaries"]],  # Coulomb's coefficient of its surface; a [pair](#contact) has the geometric mean
        "layer": Optional[int],  # order outward (skin 0, shirt 1, jacket 2): at a [tangled start](contact.md#a-tangled-start) a body belongs outside those of lower layers
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
        "thickness": Optional[Union[float, "ANumberThatVaries"]],  # thickness in contact [m]
        "rest_mesh": Optional[Path],  # a mesh with the same polygons in the stress-free shape, cut along seams or not; `scale` applies to it
        "rest": Optional[Literal["mesh", "uv"]],  # `"mesh"`: the stress-free shape is that of `rest_mesh`, or else of the mesh · `"uv"`: the texture coordinates are the flat pattern
        "uv_scale": Optional[float],  # length of one unit of the texture, only with `rest = "uv"` [m]
        "rest_scale_warp": Optional[Union[float, "ANumberThatVaries"]],  # stress-free length along warp over that of the mesh: below 1 the cloth shrinks
        "rest_scale_weft": Optional[Union[float, "ANumberThatVaries"]],  # stress-free length along weft over that of the mesh
        "rest_scale_share": Optional[Union[float, "ANumberThatVaries"]],  # share of the change to `rest_scale_warp` and `rest_scale_weft` that has come about: from 0 to 1 over time the cloth dries
        "warp": Optional[Vector],  # direction of the warp threads in the mesh as modelled
        "compression": Optional[Literal["buckling", "elastic"]],  # how threads resist compression: `buckling`, up to the load at which cells of the mesh fold; `elastic`, as they resist tension
        "stretch_limit": Optional[Union[float, "ANumberThatVaries"]],  # largest stretch of a triangle in any direction, as length over rest length; 1.05 allows 5 %
        "fabric": Optional[Sequence["BodyFabric"]],  # fabrics of some faces; the others have `material`
        "material": Required[Union[str, "MaterialOfAShell"]],  # a name (`muslin materials` lists them), the path of a material file (`.toml`), or a table
        "translate": Optional[Vector],  # displacement, applied last [m]
        "rotate": Optional[Vector],  # angles about the x axis, then y, then z [degrees]
        "scale": Optional[Union[float, Vector]],  # a number or one per axis; applied first
        "weld": Optional[float],  # joins vertices of the mesh that lie nearer than this, after `scale`; files that are written keep all vertices [m]
        "velocity": Optional[Vector],  # velocity at the start [m/s]
        "contact": Optional[bool],  # `false` excludes the body from contact
        "self_contact": Optional[bool],  # `false` excludes contact of the body with itself
        "friction": Optional[Union[float, "ANumberThatVaries"]],  # Coulomb's coefficient of its surface; a [pair](#contact) has the geometric mean
        "layer": Optional[int],  # order outward (skin 0, shirt 1, jacket 2): at a [tangled start](contact.md#a-tangled-start) a body belongs outside those of lower layers
        "colour": Optional[Vector],  # colour of the body in pictures: red, green, blue [sRGB 0 to 1]
    },
    total=False,
)

Body = Union[LatticeBody, ShellBody]

Solver = TypedDict(
    "Solver",
    {
        "integrator": Optional[Literal["implicit_euler", "bdf2", "linearly_implicit_euler", "symplectic_euler"]],  # `"implicit_euler"`: first order, always stable, damps · `"bdf2"`: second order, always stable, damps little · `"linearly_implicit_euler"`: one Newton step · `"symplectic_euler"`: explicit, only stable for small steps
        "effort": Optional[Union[Literal["draft", "normal", "exact"], "AnEffortOverTime"]],  # how accurately steps are solved, one word or `{ keyframes = [{ time = …, value = … }, …] }`: `"draft"`, to see whether a scene works · `"normal"`, for pictures · `"exact"`, for measurements
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
        "attachment": Optional[Sequence["Attachment"]],  # vertices held to points of other bodies
        "probe": Optional[Sequence["Probe"]],  # points whose path is written to `probes.csv`
    },
    total=False,
)
