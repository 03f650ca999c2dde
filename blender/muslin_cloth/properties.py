"""The user's settings, stored in the .blend file. Sentences, ranges and defaults of settings that the scene file has
too come from its schema (keys.py)."""

import bpy
from bpy.props import (BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty,
                       StringProperty)

from . import fabrics, keys


def suggest_fabrics(props, _context, text):
    return [name for name in fabrics.names(props.model.lower()) if text.lower() in name.lower()]


def drop_estimate(props, _context):
    props.area = 0


class MuslinObject(bpy.types.PropertyGroup):
    role: EnumProperty(
        name="Role", items=[("NONE", "None", ""), ("CLOTH", "Cloth", "Simulated by muslin"),
                            ("COLLIDER", "Collider", "An obstacle for muslin cloth, static or animated")])
    model: EnumProperty(
        name="Kind", description="How the mesh is simulated",
        items=[("SHELL", "Cloth", keys.meaning("body", "model", "shell")),
               ("LATTICE", "Solid", keys.meaning("body", "model", "lattice"))])
    fabric: StringProperty(
        name="Fabric", default="cotton", description="A material of muslin, or the path of a material file",
        search=suggest_fabrics, search_options={"SUGGESTION"})
    thickness: FloatProperty(
        name="Thickness", subtype="DISTANCE", min=0, soft_max=1, precision=4, update=drop_estimate,
        description=f"Of cloth: {keys.sentence('body', 'thickness', model='shell')}. Of a solid: "
                    f"{keys.sentence('body', 'thickness', model='lattice')}. 0 uses the default")
    voxel_width: FloatProperty(
        name="Voxel Width", subtype="DISTANCE", min=0, soft_max=10, precision=4,
        description=f"{keys.sentence('body', 'voxel_width')}. 0 uses the default")
    pin_group: StringProperty(name="Pin Group", description="Vertices of weight 0.5 or more are held")
    pin_animated: BoolProperty(
        name="Follow Animation", default=True,
        description="Held vertices follow shape keys, armatures and other modifiers above the Muslin modifier, and "
                    "the object's own motion")
    use_soft_pins: BoolProperty(name="Soft Pins", description="Springs pull the vertices of the group to their places")
    pin_stiffness: FloatProperty(
        name="Pin Stiffness", default=100, min=1e-3, soft_max=1e4,
        description="Of the springs of all vertices together [N/m]: a load of 1 N displaces them by its inverse, in "
                    "metres")
    use_release: BoolProperty(name="Release", description="The pins let go after a frame")
    release_frame: IntProperty(name="Release Frame", default=50)
    use_self_contact: BoolProperty(
        name="Self Contact", default=keys.default("body", "self_contact"),
        description=keys.sentence("body", "self_contact"))
    use_friction: BoolProperty(
        name="Own Friction", description="Use a separate friction for this surface instead of the scene's")
    friction: FloatProperty(
        name="Friction", default=keys.default("contact", "friction"), soft_max=1, **keys.limits("body", "friction"),
        description=keys.sentence("body", "friction"))
    use_stretch_limit: BoolProperty(
        name="Limit Stretch", description="The cloth becomes stiff before any part is stretched beyond a limit")
    stretch_limit: FloatProperty(
        name="Stretch Limit", default=1.05, soft_min=1.01, soft_max=1.5, precision=3, step=1,
        **keys.limits("body", "stretch_limit"),
        description=f"{keys.sentence('body', 'stretch_limit')}. Keeps weak fabrics from sagging where they are held; "
                    "less than 1.01 takes long")
    rest_shape: EnumProperty(
        name="Rest Shape", description="The stress-free shape",
        items=[("START", "At the Start", "The mesh in the first frame"),
               ("BASE", "Base Mesh", "The mesh without its modifiers and shape keys; only cloth")])
    # Measured for the estimate of voxels, not settings.
    area: FloatProperty(options={"HIDDEN"})
    volume: FloatProperty(options={"HIDDEN"})
    closed: BoolProperty(options={"HIDDEN"})


class MuslinScene(bpy.types.PropertyGroup):
    use_scene_range: BoolProperty(name="Scene Range", default=True, description="Bake the frame range of the scene")
    frame_start: IntProperty(name="Start", default=1)
    frame_end: IntProperty(name="End", default=250)
    use_automatic_steps: BoolProperty(
        name="Automatic Steps", default=True,
        description=keys.sentence("time", "steps_per_frame"))
    steps_per_frame: IntProperty(
        name="Steps per Frame", default=10, soft_max=100, **keys.limits("time", "steps_per_frame"),
        description="More steps follow fast motion better and damp less")
    air_density: FloatProperty(
        name="Air Density", default=keys.default("force", "air_density"), soft_max=10,
        **keys.limits("force", "air_density"),
        description=f"{keys.sentence('force', 'air_density')}; 0 is a vacuum, without wind and drag")
    use_contact: BoolProperty(
        name="Contact", default=True,
        description="Contact of cloth with itself, other cloth and colliders, without crossings")
    effort: EnumProperty(
        name="Effort", default=keys.default("solver", "effort").upper(),
        description="How accurately steps are solved; surfaces do not cross at any effort",
        items=[(word.upper(), word.capitalize(), keys.meaning("solver", "effort", word))
               for word in keys.words("solver", "effort")])
    friction: FloatProperty(
        name="Friction", default=keys.default("contact", "friction"), soft_max=1,
        **keys.limits("contact", "friction"), description=keys.sentence("contact", "friction"))
    keep_states: BoolProperty(
        name="Keep States", default=True,
        description="Keep the state of every frame, to continue a bake from any of them: 96 bytes per vertex and frame")

    def steps(self):
        """Steps a frame; None if they are automatic."""
        return None if self.use_automatic_steps else self.steps_per_frame

    def frames(self, scene):
        """(first, last) frame of the bake."""
        if self.use_scene_range:
            return scene.frame_start, scene.frame_end
        return self.frame_start, max(self.frame_end, self.frame_start)


CLASSES = (MuslinObject, MuslinScene)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Object.muslin = PointerProperty(type=MuslinObject)
    bpy.types.Scene.muslin = PointerProperty(type=MuslinScene)


def unregister():
    del bpy.types.Scene.muslin
    del bpy.types.Object.muslin
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
