"""The user's settings, stored in the .blend file."""

import bpy
from bpy.props import (BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty,
                       StringProperty)

from . import fabrics


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
        items=[("SHELL", "Cloth", "The mesh itself is thin cloth"),
               ("LATTICE", "Solid", "The mesh is filled with voxels: for bodies with a volume or a thickness")])
    fabric: StringProperty(
        name="Fabric", default="cotton", description="A material of muslin, or the path of a material file",
        search=suggest_fabrics, search_options={"SUGGESTION"})
    thickness: FloatProperty(
        name="Thickness", subtype="DISTANCE", min=0, soft_max=1, precision=4, update=drop_estimate,
        description="Thickness of cloth in contact, or of a solid made from an open mesh. 0 uses the default: "
                    "0.5 mm, or one voxel width")
    voxel_width: FloatProperty(
        name="Voxel Width", subtype="DISTANCE", min=0, soft_max=10, precision=4,
        description="Half of it shows twice the detail and takes about eight times as long; 0 takes a suggestion")
    pin_group: StringProperty(name="Pin Group", description="Vertices of weight 0.5 or more are held")
    pin_animated: BoolProperty(
        name="Follow Animation", default=True,
        description="Held vertices follow shape keys, armatures and other modifiers above the Muslin modifier, and "
                    "the object's own motion")
    use_release: BoolProperty(name="Release", description="The pins let go after a frame")
    release_frame: IntProperty(name="Release Frame", default=50)
    use_self_contact: BoolProperty(
        name="Self Contact", default=True, description="Touches itself; takes time where it does")
    use_friction: BoolProperty(
        name="Own Friction", description="Use a separate friction for this surface instead of the scene's")
    friction: FloatProperty(
        name="Friction", default=0.3, min=0, max=100, soft_max=1,
        description="Coulomb's coefficient of this surface; a pair of surfaces has the geometric mean of both")
    use_stretch_limit: BoolProperty(
        name="Limit Stretch", description="The cloth becomes stiff before any part is stretched beyond a limit")
    stretch_limit: FloatProperty(
        name="Stretch Limit", default=1.05, min=1.001, max=10, soft_min=1.01, soft_max=1.5, precision=3, step=1,
        description="Largest stretch of any part, as length over rest length: 1.05 allows 5 %. Keeps weak "
                    "fabrics from sagging where they are held; values below 1.01 take long")
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
        description="Adapt the number of steps per frame to the motion; otherwise it is fixed")
    steps_per_frame: IntProperty(
        name="Steps per Frame", default=10, min=1, soft_max=100,
        description="More steps follow fast motion better and damp less")
    air_density: FloatProperty(
        name="Air Density", default=1.2, min=0, soft_max=10, description="kg/m³; 0 is a vacuum, without wind and drag")
    use_contact: BoolProperty(
        name="Contact", default=True,
        description="Contact of cloth with itself, other cloth and colliders, without crossings")
    effort: EnumProperty(
        name="Effort", default="NORMAL",
        description="How accurately steps are solved; surfaces do not cross at any effort",
        items=[("DRAFT", "Draft", "To see whether a scene works"),
               ("NORMAL", "Normal", "For pictures"),
               ("EXACT", "Exact", "For measurements: slower by far")])
    friction: FloatProperty(
        name="Friction", default=0.3, min=0, max=100, soft_max=1,
        description="Coulomb's coefficient of cloth and colliders without Own Friction")
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
