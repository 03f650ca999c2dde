"""The user's settings, stored in the .blend file. Sentences, ranges and defaults of settings that the scene file has
too come from its schema (keys.py)."""

import bpy
from bpy.props import (BoolProperty, CollectionProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty,
                       StringProperty)

from . import fabrics, keys


def suggest_fabrics(props, _context, text):
    return [name for name in fabrics.names(props.model.lower()) if text.lower() in name.lower()]


def drop_estimate(props, _context):
    props.area = 0


def factor(name, of_what):
    return FloatProperty(name=f"{name} ×", default=1, min=0, soft_min=0.1, soft_max=10, precision=2,
                         description=f"{of_what}, as a multiple of that of the fabric")


class MuslinMap(bpy.types.PropertyGroup):
    what: EnumProperty(
        name="Number", description="What varies",
        items=[("WEIGHT", "Weight", "Mass per area or volume, as a multiple of that of the fabric"),
               ("STIFFNESS", "Stiffness", "Of stretch and shear, as a multiple of that of the fabric"),
               ("BENDING", "Bending", "Stiffness of bending of cloth, as a multiple of that of the fabric"),
               ("DAMPING", "Damping", "As a multiple of that of the fabric"),
               ("SHRINK", "Shrink", "Length of cloth at rest over that of the mesh: 0.8 is tight, 1.2 loose")])
    group: StringProperty(name="Vertex Group", description="Its weights, from 0 to 1, set where the number lies between "
                                                           "From and To")
    low: FloatProperty(name="From", default=1, min=0, soft_max=10, precision=2, description="Where the weight is 0")
    high: FloatProperty(name="To", default=1, min=0, soft_max=10, precision=2, description="Where the weight is 1")


def can_hold(entry, obj):
    return obj.type == "MESH" and obj.muslin.role != "NONE" and obj != entry.id_data


class MuslinAttachment(bpy.types.PropertyGroup):
    target: PointerProperty(name="Object", type=bpy.types.Object, poll=can_hold,
                            description="Muslin cloth, a muslin solid or a muslin collider")
    group: StringProperty(name="Vertex Group", description="Vertices with a weight above 0 are attached, each to the nearest "
                                                           "point of the object; stiffness and breaking force follow the "
                                                           "weight")
    rest: EnumProperty(
        name="Kind", description="What the attachment does with the distance of its points",
        items=[("JOINED", "Joined", keys.meaning("attachment", "rest", "joined")),
               ("DISTANCE", "Rod", keys.meaning("attachment", "rest", "distance")),
               ("CORD", "Cord", keys.meaning("attachment", "rest", "cord"))])
    use_stiffness: BoolProperty(name="Soft", description="Springs of a stiffness of their own, in place of joints as stiff as "
                                                         "the material around them")
    stiffness: FloatProperty(
        name="Stiffness", default=100, min=1e-3, soft_max=1e4,
        description="Of the springs of all vertices together [N/m]: a load of 1 N stretches them by its inverse, in metres")
    damping: FloatProperty(
        name="Damping", soft_max=100, **keys.limits("attachment", "damping"), default=keys.default("attachment", "damping"),
        description="Of all vertices together, against relative motion [N·s/m]")
    use_break_force: BoolProperty(name="Breaks", description="Vertices come off at a force")
    break_force: FloatProperty(
        name="Breaking Force", default=50, min=1e-6, soft_max=1e4,
        description="Of all vertices together [N]: a vertex whose force exceeds its share is free from then on")
    use_start: BoolProperty(name="Start", description="The attachment begins after a frame")
    start_frame: IntProperty(name="Start Frame", default=1)
    use_end: BoolProperty(name="End", description="The attachment lets go after a frame")
    end_frame: IntProperty(name="End Frame", default=50)


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
    weight_factor: factor("Weight", "Mass per area or volume")
    stiffness_factor: factor("Stiffness", "Stiffness of stretch and shear")
    bending_factor: factor("Bending", "Stiffness of bending of cloth")
    damping_factor: factor("Damping", "Damping of stretch and bending")
    maps: CollectionProperty(type=MuslinMap)
    attachments: CollectionProperty(type=MuslinAttachment)
    thickness: FloatProperty(
        name="Thickness", subtype="DISTANCE", min=0, soft_max=1, precision=4, update=drop_estimate,
        description=f"Of cloth: {keys.sentence('body', 'thickness', model='shell')}. Of a solid: "
                    f"{keys.sentence('body', 'thickness', model='lattice')}. 0 uses the default")
    voxel_width: FloatProperty(
        name="Voxel Width", subtype="DISTANCE", min=0, soft_max=10, precision=4,
        description=f"{keys.sentence('body', 'voxel_width')}. 0 uses the default")
    separate_parts: BoolProperty(
        name="Separate Parts", default=keys.default("body", "separate_parts", model="lattice"),
        description=keys.sentence("body", "separate_parts"))
    pin_group: StringProperty(
        name="Pin Group", description="Vertices of weight 0.5 or more are held. Soft pins hold by the weight")
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
    use_layer: BoolProperty(
        name="Layer", description="Where cloth crosses something else at the start, what has a higher layer belongs outside")
    layer: IntProperty(name="Layer", default=1, soft_max=10, **keys.limits("body", "layer"),
                       description=keys.sentence("body", "layer"))
    use_pressure: BoolProperty(name="Pressure", description="Inflates cloth that is closed or nearly closed")
    pressure: FloatProperty(
        name="Pressure", default=100, soft_min=-1000, soft_max=1000,
        description=f"{keys.sentence('pressure', 'pressure')}. May be animated")
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
    contact_distance: FloatProperty(
        name="Contact Distance", subtype="DISTANCE", min=0, soft_max=0.1, precision=4,
        description="Surfaces repel each other where the gap is below it. 0: 1/500 of the size of each object, and at most "
                    "a fifth of its edges")
    tangled: EnumProperty(
        name="Tangled Start", default=keys.default("contact", "tangled").upper(),
        description="What is done with surfaces that cross at the start",
        items=[("REFUSE", "Refuse", "Report the places and do not bake"),
               ("REPAIR", "Repair", "Pull them apart before the first frame"),
               ("IGNORE", "Ignore", "Leave them free of each other until they part")])
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
        return self.frame_start, self.frame_end


CLASSES = (MuslinMap, MuslinAttachment, MuslinObject, MuslinScene)


def let_overrides_keep(cls):
    """Makes the properties of a class editable on library overrides, which then keep them when the file is opened."""
    for kind in cls.__annotations__.values():
        kind.keywords["override"] = {"LIBRARY_OVERRIDABLE"}
        if kind.function is CollectionProperty:
            kind.keywords["override"] = {"LIBRARY_OVERRIDABLE", "USE_INSERTION"}


def register():
    for cls in CLASSES:
        let_overrides_keep(cls)
        bpy.utils.register_class(cls)
    bpy.types.Object.muslin = PointerProperty(type=MuslinObject, override={"LIBRARY_OVERRIDABLE"})
    bpy.types.Scene.muslin = PointerProperty(type=MuslinScene, override={"LIBRARY_OVERRIDABLE"})


def unregister():
    del bpy.types.Scene.muslin
    del bpy.types.Object.muslin
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
