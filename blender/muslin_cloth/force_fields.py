"""Maps Blender's force fields onto fields of muslin."""

import numpy as np

from . import axes
from .advice import INFO, Notice
from .scene_text import Field

MAPPED = {"WIND": "Wind", "TURBULENCE": "Turbulence", "FORCE": "Force", "VORTEX": "Vortex", "DRAG": "Drag"}


def unit_scale(scene):
    return scene.unit_settings.scale_length


def field_objects(scene):
    return [o for o in scene.objects if o.field and o.field.type != "NONE" and o.visible_get()]


def has_falloff(field):
    return field.falloff_power > 0 or field.use_max_distance or field.use_min_distance


def along_z(obj):
    """The direction of its z axis, (3,) in Blender's axes; 0 for a flat object."""
    along = np.array(obj.matrix_world)[:3, 2]
    length = np.linalg.norm(along)
    return along / length if length > 0 else np.zeros(3)


def fields_notices(scene):
    """What of the scene's fields muslin does not do."""
    notices = []
    for obj in field_objects(scene):
        field = obj.field
        if field.type not in MAPPED:
            notices.append(Notice(INFO, f"Its force field ({field.type.title()}) is ignored: muslin supports only "
                                  + ", ".join(MAPPED.values()), obj.name))
            continue
        if field.shape != "POINT":
            notices.append(Notice(INFO, "The shape of its field is taken as Point", obj.name))
        if field.falloff_type != "SPHERE" and has_falloff(field):
            notices.append(Notice(INFO, "Its falloff is taken as that of a Sphere", obj.name))
        if is_own(field) and obj.animation_data and obj.animation_data.action and any(
                curve.data_path in ("location", "rotation_euler") for curve in obj.animation_data.action.fcurves):
            notices.append(Notice(INFO, "Its field stays where it is at the start of the bake", obj.name))
    return notices


def is_own(field):
    """True if it becomes a field of its own; the others are the air that is the same everywhere."""
    return field.type in ("FORCE", "VORTEX", "DRAG") or field.type in ("WIND", "TURBULENCE") and has_falloff(field)


def falloff(field, scale):
    """The keys of muslin's falloff: Blender's is (1 + r - minimum)^-power, r in scene units."""
    keys = {"power": field.falloff_power, "min": field.distance_min * scale if field.use_min_distance else 0.0,
            "length": scale}
    if field.use_max_distance:
        keys["max"] = max(field.distance_max * scale, keys["min"], 1e-9)
    return keys


def as_field(obj, scale):
    """The field of an evaluated object, without its strength."""
    field, axis = obj.field, tuple(float(x) for x in axes.turned(along_z(obj)))
    center = tuple(float(x) for x in axes.turned(np.array(obj.matrix_world)[:3, 3], scale))
    own = {"center": center, "falloff": falloff(field, scale)}
    if field.type == "DRAG":
        return Field("drag", [], numbers={"linear": max(field.linear_drag, 0.0),
                                          "quadratic": max(field.quadratic_drag, 0.0) / scale}, **own)
    if field.type == "FORCE":
        return Field("radial", [], "acceleration", **own)
    if field.type == "VORTEX":
        return Field("vortex", [], "wind", vectors={"axis": axis}, numbers={"radius": scale}, **own)
    if field.type == "WIND":
        return Field("uniform", [], "wind", vectors={"direction": axis}, **own)
    return Field("turbulence", [], "wind", numbers={"largest": max(field.size * scale, 1e-6),
                                                    "seed": max(int(field.seed), 0)}, **own)


class Fields:
    """Samples the fields that are not the same everywhere: their place at the first frame, their strength in all."""

    def __init__(self, scene):
        self._scene, self._fields = scene, {}

    def sample(self, depsgraph):
        scale = unit_scale(self._scene)
        for obj in field_objects(self._scene):
            if not is_own(obj.field):
                continue
            evaluated = obj.evaluated_get(depsgraph)
            own = self._fields.setdefault(obj.name, as_field(evaluated, scale))
            if own.type != "drag":
                own.strengths.append(evaluated.field.strength * scale)

    def all(self):
        """Those that act: muslin refuses a drag of 0 and an object without a z axis has no direction."""
        return [f for f in self._fields.values()
                if all(any(v) for v in f.vectors.values())
                and (f.type != "drag" or f.numbers["linear"] > 0 or f.numbers["quadratic"] > 0)]
