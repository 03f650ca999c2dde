"""The Physics tab."""

import textwrap

import bpy
from bpy.types import Panel

from . import bake_state as bs
from . import fabrics
from .advice import ERROR, WARNING, counted, estimate_voxels, split_problem
from .force_fields import fields_notices, unit_scale
from .gather import cloth_objects
from .operators import MUSLIN_MT_presets
from .playback import modifier_of, own_folder
from .session import baking

ICONS = {ERROR: "CANCEL", WARNING: "ERROR", "INFO": "INFO"}


def paragraph(layout, text, width, icon="NONE", alert=False):
    """Draws text over several lines; Blender has no label that wraps."""
    column = layout.column(align=True)
    column.scale_y = 0.8
    column.alert = alert
    characters = max(20, int(width / 6.6 / bpy.context.preferences.system.ui_scale) - 8)
    for i, line in enumerate(textwrap.wrap(text, characters) or [""]):
        column.label(text=line, icon=icon if i == 0 else "BLANK1" if icon != "NONE" else "NONE")


class MuslinPanel:
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "physics"

    @classmethod
    def poll(cls, context):
        return context.object and context.object.type == "MESH" and context.object.muslin.role != "NONE"


class ClothPanel(MuslinPanel):
    @classmethod
    def poll(cls, context):
        return context.object and context.object.type == "MESH" and context.object.muslin.role == "CLOTH"


class PHYSICS_PT_muslin(MuslinPanel, Panel):
    bl_label = "Muslin"

    def draw(self, context):
        layout, scene, obj = self.layout, context.scene, context.object
        width = context.region.width
        if obj.muslin.role == "COLLIDER":
            paragraph(layout, "Muslin cloth collides with this mesh, static or animated.", width)
            if not scene.muslin.use_contact:
                paragraph(layout, "Contact is switched off in the settings of the scene.", width, "ERROR")
                layout.prop(scene.muslin, "use_contact")
            column = layout.column()
            column.use_property_split = True
            column.enabled = scene.muslin.use_contact
            draw_surface(column, obj.muslin)
            return
        session = baking(scene)
        state = session.state if session else bs.State()
        draw_state(layout, scene, session, state, width)
        draw_buttons(layout, context, state)
        if gravity_size(scene) and not 0.1 < gravity_size(scene) / 9.8 < 10:
            paragraph(layout, f"Unit Scale makes gravity {gravity_size(scene):.3g} m/s², far from 9.8: set it under "
                              "Scene > Gravity", width, "ERROR")
        if session:
            for notice in session.notices:
                if notice.level == ERROR and notice.text in state.problem:
                    continue  # said above already
                where = f"{notice.object}: " if notice.object and notice.object != obj.name else ""
                paragraph(layout, where + notice.text, width, ICONS[notice.level], notice.level == ERROR)
            crossing = session.crossing.get(obj.name)
            if crossing:
                layout.operator("muslin.select_crossing", icon="RESTRICT_SELECT_OFF",
                                text=f"Select {counted(len(crossing), 'Crossing Face')}")


def gravity_size(scene):
    """[m/s²]; 0: none."""
    return scene.gravity.length * unit_scale(scene) if scene.use_gravity else 0


def draw_state(layout, scene, session, state, width):
    box = layout.box()
    if session and state.busy:
        share, text = session.progress()
        if hasattr(box, "progress"):
            box.progress(factor=share, text=text)
        else:
            blocks = int(round(20 * share))
            box.label(text="█" * blocks + "░" * (20 - blocks) + f"  {100 * share:.0f} %")
            box.label(text=text)
        return
    if state.problem:
        what, remedy = split_problem(state.problem)
        paragraph(box, what, width, "CANCEL", alert=True)
        if remedy:
            paragraph(box, remedy[:1].upper() + remedy[1:], width, "FORWARD")
    if state.frame >= 0:
        first = session.first_frame
        text = f"Baked: frames {first} to {first + state.frame}"
        if state.frame < state.total:
            text += f" of {first + state.total}"
        box.label(text=text, icon="CHECKMARK")
        if session.folder and bpy.data.filepath and session.folder != own_folder(scene):
            paragraph(box, f"Plays the bake of another file, in {session.folder.parent.name}. Bake makes a new one.",
                      width, "INFO")
    elif not state.problem:
        box.label(text="Nothing is baked" if bpy.data.filepath else "Save the file, then bake", icon="INFO")
    if session and session.message:
        paragraph(box, session.message, width, "INFO")


def draw_buttons(layout, context, state):
    if state.busy:
        layout.operator("muslin.cancel", icon="CANCEL")
        return
    column = layout.column(align=True)
    row = column.row(align=True)
    row.scale_y = 1.3
    row.operator("muslin.bake", icon="PHYSICS")
    if state.resumable:
        row.operator("muslin.resume", icon="PLAY")
    baked = column.column(align=True)
    baked.enabled = state.frame >= 0
    baked.operator("muslin.bake_from_current", icon="TRACKING_FORWARDS_SINGLE")
    row = column.row(align=True)
    row.operator("muslin.check", icon="VIEWZOOM")
    row.operator("muslin.report", icon="TEXT")
    free = row.row(align=True)
    free.enabled = state.frame >= 0
    free.operator("muslin.free", icon="TRASH")


class PHYSICS_PT_muslin_cloth(ClothPanel, Panel):
    bl_label = "Fabric"
    bl_parent_id = "PHYSICS_PT_muslin"

    def draw(self, context):
        layout, obj = self.layout, context.object
        layout.use_property_split = True
        m = obj.muslin
        row = layout.row(align=True)
        row.menu("MUSLIN_MT_presets", text=MUSLIN_MT_presets.bl_label)
        row.operator("muslin.preset_add", text="", icon="ADD")
        row.operator("muslin.preset_add", text="", icon="REMOVE").remove_active = True
        layout.prop(m, "model")
        layout.prop(m, "fabric")
        about = fabrics.description(m.fabric)
        if about:
            paragraph(layout, about, context.region.width, "INFO")
        guesses = fabrics.guesses(m.fabric, m.model.lower())
        if guesses:
            paragraph(layout, guesses, context.region.width, "QUESTION")
        column = layout.column(align=True)
        for name in ("weight_factor", "stiffness_factor", "bending_factor", "damping_factor"):
            if name != "bending_factor" or m.model == "SHELL":
                column.prop(m, name)
        layout.prop(m, "thickness")
        if m.model == "LATTICE":
            row = layout.row(align=True)
            row.prop(m, "voxel_width")
            row.operator("muslin.suggest_width", text="", icon="LIGHT")
            layout.prop(m, "separate_parts")
        else:
            layout.prop(m, "rest_shape")
            layout.prop(m, "use_stretch_limit")
            if m.use_stretch_limit:
                layout.prop(m, "stretch_limit")
            draw_optional(layout, m, "Pressure", "use_pressure", "pressure")
        column = layout.column()
        column.enabled = context.scene.muslin.use_contact
        column.prop(m, "use_self_contact")
        draw_surface(column, m)
        draw_counts(layout, context, m)


def draw_optional(column, owner, heading, use, value):
    """A number with the switch before it."""
    row = column.row(heading=heading)
    row.prop(owner, use, text="")
    sub = row.row()
    sub.enabled = getattr(owner, use)
    sub.prop(owner, value, text="")


def draw_surface(column, m):
    """What both cloth and colliders have."""
    for use, value in (("use_friction", "friction"), ("use_layer", "layer")):
        column.prop(m, use)
        if getattr(m, use):
            column.prop(m, value)


def draw_counts(layout, context, m):
    session = baking(context.scene)
    counts = session.counts.get(context.object.name) if session else None
    if m.model == "LATTICE" and m.area and m.voxel_width:
        n = estimate_voxels(m.area, m.volume, m.closed, m.thickness, m.voxel_width)
        layout.label(text=f"About {counted(n, 'voxel')}")
    if counts and counts["model"] == m.model.lower():
        what = counted(counts["voxels"], "voxel") if m.model == "LATTICE" else counted(counts["triangles"], "triangle")
        layout.label(text=f"Checked: {what}, {counted(counts['vertices'], 'vertex', 'vertices')}, {counts['mass']:.4g} kg")


class PHYSICS_PT_muslin_maps(ClothPanel, Panel):
    bl_label = "Maps"
    bl_parent_id = "PHYSICS_PT_muslin"

    def draw(self, context):
        layout, obj = self.layout, context.object
        for index, entry in enumerate(obj.muslin.maps):
            box = layout.box().column(align=True)
            row = box.row(align=True)
            row.prop(entry, "what", text="")
            row.prop_search(entry, "group", obj, "vertex_groups", text="")
            row.operator("muslin.map_remove", text="", icon="X").index = index
            row = box.row(align=True)
            row.prop(entry, "low")
            row.prop(entry, "high")
        layout.operator("muslin.map_add", icon="ADD")


class PHYSICS_PT_muslin_pins(ClothPanel, Panel):
    bl_label = "Pins"
    bl_parent_id = "PHYSICS_PT_muslin"

    def draw(self, context):
        layout, obj = self.layout, context.object
        layout.use_property_split = True
        m = obj.muslin
        layout.prop_search(m, "pin_group", obj, "vertex_groups", text="Pin Group")
        column = layout.column()
        column.enabled = bool(m.pin_group)
        column.prop(m, "pin_animated")
        draw_optional(column, m, "Soft", "use_soft_pins", "pin_stiffness")
        draw_optional(column, m, "Release", "use_release", "release_frame")
        cache = modifier_of(obj)
        if cache and m.pin_group and m.pin_animated:
            above = [x.name for x in obj.modifiers[: obj.modifiers.find(cache.name)]]
            text = f"Follows {', '.join(above)}" if above else "Follows the object and its shape keys"
            paragraph(layout, text + "; what stands below the Muslin modifier refines the cloth", context.region.width,
                      "INFO")


class PHYSICS_PT_muslin_attachments(ClothPanel, Panel):
    bl_label = "Attachments"
    bl_parent_id = "PHYSICS_PT_muslin"

    def draw(self, context):
        layout, obj = self.layout, context.object
        for index, entry in enumerate(obj.muslin.attachments):
            column = layout.box().column()
            row = column.row(align=True)
            row.prop(entry, "target", text="")
            row.prop_search(entry, "group", obj, "vertex_groups", text="")
            row.operator("muslin.attachment_remove", text="", icon="X").index = index
            column.row().prop(entry, "rest", expand=True)
            column.use_property_split = True
            draw_optional(column, entry, "Soft", "use_stiffness", "stiffness")
            if entry.use_stiffness:
                column.prop(entry, "damping")
            draw_optional(column, entry, "Breaks", "use_break_force", "break_force")
            draw_optional(column, entry, "Start", "use_start", "start_frame")
            draw_optional(column, entry, "End", "use_end", "end_frame")
        layout.operator("muslin.attachment_add", icon="ADD")


class PHYSICS_PT_muslin_scene(ClothPanel, Panel):
    bl_label = "Scene"
    bl_parent_id = "PHYSICS_PT_muslin"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout, scene = self.layout, context.scene
        layout.use_property_split = True
        m = scene.muslin
        layout.prop(m, "use_scene_range")
        if not m.use_scene_range:
            column = layout.column(align=True)
            column.prop(m, "frame_start")
            column.prop(m, "frame_end")
        layout.prop(m, "effort")
        layout.prop(m, "use_automatic_steps")
        if not m.use_automatic_steps:
            layout.prop(m, "steps_per_frame")
        layout.prop(m, "air_density")
        layout.prop(m, "use_contact")
        column = layout.column()
        column.enabled = m.use_contact
        column.prop(m, "friction")
        column.prop(m, "contact_distance")
        column.prop(m, "tangled")
        layout.prop(m, "keep_states")
        gravity = gravity_size(scene)
        layout.label(text=f"Gravity {gravity:.4g} m/s²" if gravity else "No gravity", icon="FORCE_FORCE")
        names = [o.name for o in cloth_objects(scene)]
        layout.label(text="One bake of: " + ", ".join(names), icon="MOD_CLOTH")
        for notice in fields_notices(scene):
            paragraph(layout, f"{notice.object}: {notice.text}", context.region.width, "INFO")


def draw_add(self, context):
    """Adds two buttons to Blender's kinds of physics."""
    obj = context.object
    if not obj or obj.type != "MESH":
        return
    column = self.layout.column(align=True)
    if obj.muslin.role == "NONE":
        column.operator("muslin.cloth_add", icon="MOD_CLOTH")
        column.operator("muslin.collider_add", icon="MOD_PHYSICS")
    else:
        label = "Muslin Cloth" if obj.muslin.role == "CLOTH" else "Muslin Collider"
        column.operator("muslin.remove", text=label, icon="X")


CLASSES = (PHYSICS_PT_muslin, PHYSICS_PT_muslin_cloth, PHYSICS_PT_muslin_maps, PHYSICS_PT_muslin_pins,
           PHYSICS_PT_muslin_attachments, PHYSICS_PT_muslin_scene)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    if hasattr(bpy.types, "PHYSICS_PT_add"):
        bpy.types.PHYSICS_PT_add.append(draw_add)


def unregister():
    if hasattr(bpy.types, "PHYSICS_PT_add"):
        bpy.types.PHYSICS_PT_add.remove(draw_add)
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
