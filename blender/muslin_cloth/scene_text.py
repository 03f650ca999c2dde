"""Writes the files muslin reads: OBJ meshes and scene.toml. Everything here is in muslin's axes and metres
(axes.py). No Blender needed."""

from dataclasses import dataclass, field
from typing import Dict, List, Optional, Tuple

import numpy as np

from . import keys

Vec = Tuple[float, float, float]


@dataclass
class Painted:
    """A number that a map varies over the body."""
    file: str  # of one weight a vertex, from 0 to 1
    low: float  # where the weight is 0
    high: float  # where it is 1


@dataclass
class Attachment:
    """Vertices of a body held to another one."""
    name: str
    group: str  # of the mesh's file: the vertices
    to: str  # the name of the other body or collider
    rest: str = keys.default("attachment", "rest")
    weight: Optional[Painted] = None  # None: all vertices have weight 1
    stiffness: Optional[float] = None  # of all vertices together [N/m]; None: stiff
    damping: float = keys.default("attachment", "damping")  # [N·s/m]
    break_force: Optional[float] = None  # of all together [N]; None: it never breaks
    begin: float = 0.0  # [s]
    end: Optional[float] = None  # [s]; None: never


@dataclass
class Cloth:
    name: str  # of the body: names files
    model: str  # "shell" | "lattice"
    material: str  # a name of the library or the path of a material file
    numbers: Dict[str, object] = field(default_factory=dict)  # of the material, in place of its own: float, curve, Painted
    own_numbers: Dict[str, object] = field(default_factory=dict)  # of the body itself
    thickness: float = 0.0  # [m]; 0: muslin's default. Of a shell as contact sees it
    voxel_width: float = 0.0  # [m], of a lattice
    separate_parts: bool = False  # of a lattice
    rest_mesh: str = ""  # file name
    pin: str = ""  # file name of the sequence; "": stands still
    pinned: bool = False
    pin_stiffness: Optional[float] = None  # of soft pins, all together [N/m]; None: they hold exactly
    pin_weight: Optional[Painted] = None  # of soft pins; None: all have weight 1
    release: Optional[float] = None  # when the pin lets go [s]
    self_contact: bool = True
    friction: Optional[float] = None  # None: the scene's
    stretch_limit: Optional[float] = None  # of a shell: length over length at rest; None: no limit
    layer: Optional[int] = None  # order outward, of cloth and colliders
    pressures: List[float] = field(default_factory=list)  # inside a shell: one, or one a frame [Pa]; empty: none
    attachments: List[Attachment] = field(default_factory=list)


@dataclass
class Collider:
    name: str
    sequence: str = ""  # file name; "": stands still
    friction: Optional[float] = None  # None: the scene's
    layer: Optional[int] = None


@dataclass
class Wind:
    velocities: List[Vec]  # one, or one a frame [m/s]
    gust: float = keys.default("force", "gust")  # root mean square [m/s]
    gust_length: float = keys.default("force", "gust_length")  # [m]
    seed: int = keys.default("force", "seed")


@dataclass
class Field:
    """A field of vectors or a drag: a [[force]] of this type."""
    type: str  # "uniform" | "radial" | "vortex" | "turbulence" | "drag"
    strengths: List[float]  # one, or one a frame [m/s or m/s²]; of a drag none
    acts_as: str = ""  # "wind" | "acceleration"; of a drag none
    center: Vec = (0.0, 0.0, 0.0)  # [m]
    falloff: Dict[str, float] = field(default_factory=dict)  # its keys; empty: none
    vectors: Dict[str, Vec] = field(default_factory=dict)  # further keys of the type
    numbers: Dict[str, float] = field(default_factory=dict)


@dataclass
class SceneInput:
    title: str
    frames: int  # last frame, from 0
    frame_rate: float
    steps_per_frame: Optional[int]  # None: automatic
    gravity: List[Vec] = field(default_factory=list)  # one, or one a frame [m/s²]; empty: none
    air_density: float = keys.default("force", "air_density")  # [kg/m³]; 0: no air
    wind: Optional[Wind] = None
    fields: List[Field] = field(default_factory=list)
    cloths: List[Cloth] = field(default_factory=list)
    colliders: List[Collider] = field(default_factory=list)
    contact: bool = True  # of cloth with itself, with other cloth and with colliders
    effort: str = keys.default("solver", "effort")
    friction: float = keys.default("contact", "friction")  # of what has none of its own
    distance: float = 0.0  # contact distance [m]; 0: muslin's default
    tangled: str = keys.default("contact", "tangled")


def body_names(names):
    """A name for each object that can be part of a file name, all different even where case does not count."""
    taken, result = set(), []
    for name in names:
        base = "".join(c if c.isalnum() or c in "-_" else "_" for c in name).strip("_")[:60] or "object"
        candidate, n = base, 2
        while candidate.lower() in taken:
            candidate, n = f"{base}_{n}", n + 1
        taken.add(candidate.lower())
        result.append(candidate)
    return result


def quoted(text):
    """A TOML string."""
    escapes = {"\\": "\\\\", '"': '\\"', "\n": "\\n", "\t": "\\t", "\r": "\\r"}
    return '"' + "".join(escapes.get(c, c if ord(c) >= 32 and ord(c) != 127 else " ") for c in text) + '"'


def number(x):
    return repr(float(x))


def vector(v):
    return "[" + ", ".join(number(x) for x in v) + "]"


def varied(x):
    """A number, a measured curve, or a number that a map varies."""
    if isinstance(x, Painted):
        return f"{{ map = {quoted(x.file)}, from = {number(x.low)}, to = {number(x.high)} }}"
    return "[" + ", ".join(vector(point) for point in x) + "]" if isinstance(x, list) else number(x)


def keyframes(values, text, frame_rate):
    keys_ = ", ".join(f"{{ time = {number(f / frame_rate)}, value = {text(v)} }}" for f, v in enumerate(values))
    return f"keyframes = [{keys_}]"


def over_time(key, values, text, frame_rate):
    """The key, if the values of all frames are equal, or else `keyframes` beside it."""
    constant = all(v == values[0] for v in values)
    return f"{key} = {text(values[0])}" if constant else keyframes(values, text, frame_rate)


def number_over_time(key, values, frame_rate):
    """The key as a number, or as a table of keyframes if the values of the frames differ."""
    constant = all(v == values[0] for v in values)
    return f"{key} = {number(values[0])}" if constant else f"{key} = {{ {keyframes(values, number, frame_rate)} }}"


def scene_toml(scene: SceneInput, moving: bool = True) -> str:
    """`moving` = False leaves sequences out: the scene as it stands at the first frame, for a check."""
    lines = [f"title = {quoted(scene.title)}", "", "[time]"]
    lines += [f"duration = {number(max(scene.frames, 1) / scene.frame_rate)}",
              f"frame_rate = {number(scene.frame_rate)}", f"steps_per_frame = {scene.steps_per_frame or quoted('auto')}"]
    lines += ["", "[solver]", f"effort = {quoted(scene.effort)}"]
    for cloth in scene.cloths:
        lines += ["", "[[body]]"] + _body(cloth)
        if not scene.contact:
            lines.append("contact = false")
        elif not cloth.self_contact:
            lines.append("self_contact = false")
        if scene.contact and cloth.friction is not None:
            lines.append(f"friction = {number(cloth.friction)}")
        if cloth.layer is not None:
            lines.append(f"layer = {cloth.layer}")
    for cloth in scene.cloths:
        if cloth.pinned:
            lines += ["", "[[pin]]"] + _pin(cloth, moving)
    for collider in scene.colliders:
        lines += ["", "[[collider]]", f"name = {quoted(collider.name)}", 'shape = "mesh"',
                  f"mesh = {quoted(collider.name + '.obj')}"]
        if collider.sequence and moving:
            lines.append(f"sequence = {quoted(collider.sequence)}")
        if not scene.contact:
            lines.append("contact = false")
        elif collider.friction is not None:
            lines.append(f"friction = {number(collider.friction)}")
        if collider.layer is not None:
            lines.append(f"layer = {collider.layer}")
    for cloth in scene.cloths:
        for attachment in cloth.attachments:
            lines += ["", "[[attachment]]", f"body = {quoted(cloth.name)}"] + _attachment(attachment)
    if scene.contact:
        lines += ["", "[contact]", f"friction = {number(scene.friction)}", f"tangled = {quoted(scene.tangled)}"]
        if scene.distance > 0:
            lines.append(f"distance = {number(scene.distance)}")
    if any(any(g) for g in scene.gravity):
        lines += ["", "[[force]]", 'type = "gravity"', over_time("acceleration", scene.gravity, vector, scene.frame_rate)]
    for cloth in scene.cloths:
        if any(cloth.pressures):
            lines += ["", "[[pressure]]", f"body = {quoted(cloth.name)}",
                      number_over_time("pressure", cloth.pressures, scene.frame_rate)]
    if scene.air_density > 0:
        lines += ["", "[[force]]", 'type = "wind"'] + _wind(scene)
    for each in scene.fields:
        if each.acts_as != "wind" or scene.air_density > 0:
            lines += ["", "[[force]]", f"type = {quoted(each.type)}"] + _field(each, scene.frame_rate)
    return "\n".join(lines) + "\n"


def _body(cloth):
    lines = [f"name = {quoted(cloth.name)}", f"mesh = {quoted(cloth.name + '.obj')}", f'model = "{cloth.model}"']
    if cloth.numbers:
        changed = "".join(f", {key} = {varied(x)}" for key, x in cloth.numbers.items())
        lines.append(f"material = {{ base = {quoted(cloth.material)}{changed} }}")
    else:
        lines.append(f"material = {quoted(cloth.material)}")
    lines += [f"{key} = {varied(x)}" for key, x in cloth.own_numbers.items()]
    if cloth.voxel_width > 0:
        lines.append(f"voxel_width = {number(cloth.voxel_width)}")
    if cloth.separate_parts:
        lines.append("separate_parts = true")
    if cloth.thickness > 0:
        lines.append(f"thickness = {number(cloth.thickness)}")
    if cloth.stretch_limit is not None:
        lines.append(f"stretch_limit = {number(cloth.stretch_limit)}")
    if cloth.rest_mesh:
        lines.append(f"rest_mesh = {quoted(cloth.rest_mesh)}")
    return lines


def _pin(cloth, moving):
    lines = [f"name = {quoted('pins of ' + cloth.name)}", f"body = {quoted(cloth.name)}",
             'where = { group = "pinned" }']
    if cloth.pin and moving:
        lines.append(f"sequence = {quoted(cloth.pin)}")
    if cloth.pin_stiffness is not None:
        lines.append(f"stiffness = {number(cloth.pin_stiffness)}")
    if cloth.pin_weight is not None:
        lines.append(f"weight = {varied(cloth.pin_weight)}")
    if cloth.release is not None:
        lines.append(f"until = {number(cloth.release)}")
    return lines


def _attachment(attachment):
    lines = [f"name = {quoted(attachment.name)}", f"where = {{ group = {quoted(attachment.group)} }}",
             f"to = {quoted(attachment.to)}", f"rest = {quoted(attachment.rest)}"]
    if attachment.weight is not None:
        lines.append(f"weight = {varied(attachment.weight)}")
    if attachment.stiffness is not None:
        lines.append(f"stiffness = {number(attachment.stiffness)}")
    if attachment.damping:
        lines.append(f"damping = {number(attachment.damping)}")
    if attachment.break_force is not None:
        lines.append(f"break_force = {number(attachment.break_force)}")
    if attachment.begin > 0:
        lines.append(f"from = {number(attachment.begin)}")
    if attachment.end is not None:
        lines.append(f"until = {number(attachment.end)}")
    return lines


def _wind(scene):
    wind = scene.wind or Wind([(0.0, 0.0, 0.0)])
    lines = [f"air_density = {number(scene.air_density)}",
             over_time("velocity", wind.velocities, vector, scene.frame_rate)]
    if wind.gust > 0:
        lines += [f"gust = {number(wind.gust)}", f"gust_length = {number(wind.gust_length)}", f"seed = {wind.seed}"]
    return lines


def _field(each, frame_rate):
    lines = [f"acts_as = {quoted(each.acts_as)}"] if each.acts_as else []
    if each.strengths:
        lines.append(number_over_time("strength", each.strengths, frame_rate))
    lines.append(f"center = {vector(each.center)}")
    if each.falloff:
        lines.append("falloff = { " + ", ".join(f"{key} = {number(x)}" for key, x in each.falloff.items()) + " }")
    lines += [f"{key} = {vector(v)}" for key, v in each.vectors.items()]
    lines += [f"{key} = {x if isinstance(x, int) else number(x)}" for key, x in each.numbers.items()]
    return lines


def obj_text(points, corners, sizes, uvs=None, groups=None, flip=False):
    """points (n, 3); corners: vertex of every polygon corner, polygon after polygon; sizes: corners of each
    polygon; uvs (#corners, 2) or None; groups: {name: indices of its vertices}; flip turns polygons around."""
    out = ["v %.9g %.9g %.9g" % tuple(p) for p in np.asarray(points)]
    if uvs is not None:
        out += ["vt %.9g %.9g" % tuple(uv) for uv in uvs]
    starts = np.concatenate([[0], np.cumsum(sizes)])
    corners = np.asarray(corners) + 1
    for first, end in zip(starts[:-1], starts[1:]):
        order = range(end - 1, first - 1, -1) if flip else range(first, end)
        if uvs is None:
            out.append("f " + " ".join(str(corners[c]) for c in order))
        else:
            out.append("f " + " ".join(f"{corners[c]}/{c + 1}" for c in order))
    for name, vertices in (groups or {}).items():
        if len(vertices):
            out += [f"g {name}", "p " + " ".join(str(v + 1) for v in vertices)]
    return "\n".join(out) + "\n"
