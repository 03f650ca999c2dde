"""The operators. A button starts a bake in the background; a call from a script blocks until the bake is done."""

import bpy
from bl_operators.presets import AddPresetBase
from bpy.props import IntProperty
from bpy.types import Menu, Operator

from . import bake_state as bs
from . import playback, worker
from .advice import problem_line
from .gather import Problem, depsgraph_of, measure, snapshot, suggestion
from .preferences import find_program
from .session import baking, session_of, start_clock, wait


class SessionOperator(Operator):
    """Feeds an event to the session of the scene."""

    def event(self, context):
        raise NotImplementedError

    @classmethod
    def poll(cls, context):
        return context.scene is not None

    def feed(self, context):
        session = session_of(context.scene)
        session.message = ""
        session.feed(self.event(context))
        if session.message:
            self.report({"WARNING"}, session.message)
        return session

    def invoke(self, context, _event):
        self.feed(context)
        start_clock()
        return {"FINISHED"}

    def execute(self, context):
        session = self.feed(context)
        wait(session)
        if session.state.phase == bs.Phase.FAILED:
            self.report({"ERROR"}, session.state.problem)  # raises RuntimeError in the script that called
            return {"CANCELLED"}
        return {"FINISHED"}


class MUSLIN_OT_bake(SessionOperator):
    bl_idname = "muslin.bake"
    bl_label = "Bake"
    bl_description = "Simulate all muslin cloth of this scene from the first frame on, in a separate process"

    def event(self, context):
        first, last = context.scene.muslin.frames(context.scene)
        return bs.Bake(last - first)


class MUSLIN_OT_bake_from_current(SessionOperator):
    bl_idname = "muslin.bake_from_current"
    bl_label = "Bake from Current Frame"
    bl_description = ("Keep the frames up to this one and simulate later ones again, with pins, forces and colliders "
                      "as they now are")

    @classmethod
    def poll(cls, context):
        return context.scene is not None and context.scene.muslin.keep_states

    def event(self, context):
        session = session_of(context.scene)
        first, last = context.scene.muslin.frames(context.scene)
        return bs.BakeFrom(context.scene.frame_current - session.first_frame, last - first)


class MUSLIN_OT_resume(SessionOperator):
    bl_idname = "muslin.resume"
    bl_label = "Resume"
    bl_description = "Continue an interrupted bake, with the scene as it was then"

    def event(self, context):
        return bs.Resume()


class MUSLIN_OT_cancel(SessionOperator):
    bl_idname = "muslin.cancel"
    bl_label = "Cancel"
    bl_description = "Stop after the current step and keep the baked frames. Press again to stop at once"

    def event(self, context):
        return bs.Cancel()


class MUSLIN_OT_free(SessionOperator):
    bl_idname = "muslin.free"
    bl_label = "Free Bake"
    bl_description = "Remove the bake and its files"

    def event(self, context):
        return bs.Free()


class MUSLIN_OT_check(Operator):
    bl_idname = "muslin.check"
    bl_label = "Check"
    bl_description = "Check meshes and settings; report errors and what will be built"

    def start(self, context):
        session = session_of(context.scene)
        problem = session.check()
        if problem:
            self.report({"WARNING"}, problem)
        return session

    def invoke(self, context, _event):
        self.start(context)
        start_clock()
        return {"FINISHED"}

    def execute(self, context):
        wait(self.start(context))
        return {"FINISHED"}


class MUSLIN_OT_select_crossing(Operator):
    bl_idname = "muslin.select_crossing"
    bl_label = "Select Crossing Faces"
    bl_description = "Select the faces of this mesh that cross something in the first frame"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        session = baking(context.scene) if context.scene else None
        return session is not None and is_mesh(context) and bool(session.crossing.get(context.object.name))

    def execute(self, context):
        obj = context.object
        faces = baking(context.scene).crossing[obj.name]
        if faces[-1] >= len(obj.data.polygons):
            self.report({"WARNING"}, "A modifier above Muslin changes the faces: they cannot be selected in this mesh")
            return {"CANCELLED"}
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_mode(type="FACE")
        bpy.ops.mesh.select_all(action="DESELECT")
        bpy.ops.object.mode_set(mode="OBJECT")
        for face in faces:
            obj.data.polygons[face].select = True
        bpy.ops.object.mode_set(mode="EDIT")
        return {"FINISHED"}


class MUSLIN_OT_report(Operator):
    bl_idname = "muslin.report"
    bl_label = "Report"
    bl_description = "Examine the bake and open its certificate in the browser: numbers, sources, a verdict per promise"

    @classmethod
    def poll(cls, context):
        session = baking(context.scene) if context.scene else None
        return session is not None and session.state.frame >= 0

    def execute(self, context):
        program, run = find_program(), session_of(context.scene).folder / "run"
        if not program:
            self.report({"ERROR"}, "The program muslin was not found: set its place in Preferences > Add-ons > "
                                   "Muslin Cloth")
            return {"CANCELLED"}
        page = run / "report.html"
        code, _, err = worker.ask(program, "report", str(run), "-o", str(page), "--quiet")
        if code != 0:
            self.report({"ERROR"}, problem_line(err))
            return {"CANCELLED"}
        if not bpy.app.background:
            bpy.ops.wm.url_open(url=page.resolve().as_uri())
        return {"FINISHED"}


def is_mesh(context):
    return context.object is not None and context.object.type == "MESH"


class RoleOperator(Operator):
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return is_mesh(context)


class MUSLIN_OT_cloth_add(RoleOperator):
    bl_idname = "muslin.cloth_add"
    bl_label = "Muslin Cloth"
    bl_description = "Let muslin simulate this mesh"

    def execute(self, context):
        context.object.muslin.role = "CLOTH"
        playback.ensure_modifier(context.object)
        return {"FINISHED"}


class MUSLIN_OT_collider_add(RoleOperator):
    bl_idname = "muslin.collider_add"
    bl_label = "Muslin Collider"
    bl_description = "Let muslin cloth collide with this mesh, static or animated"

    def execute(self, context):
        context.object.muslin.role = "COLLIDER"
        return {"FINISHED"}


class MUSLIN_OT_remove(RoleOperator):
    bl_idname = "muslin.remove"
    bl_label = "Remove"
    bl_description = "Remove muslin from this mesh; its bake is no longer played"

    def execute(self, context):
        obj = context.object
        cache = playback.modifier_of(obj)
        if cache:
            obj.modifiers.remove(cache)
        obj.muslin.role = "NONE"
        return {"FINISHED"}


class RemoveEntry(RoleOperator):
    """Removes one of a list of the object."""
    index: IntProperty(options={"HIDDEN"})

    def execute(self, context):
        getattr(context.object.muslin, self.entries).remove(self.index)
        return {"FINISHED"}


class MUSLIN_OT_map_add(RoleOperator):
    bl_idname = "muslin.map_add"
    bl_label = "Add Map"
    bl_description = "Let a number of the fabric vary with the weights of a vertex group"

    def execute(self, context):
        entry = context.object.muslin.maps.add()
        if context.object.vertex_groups.active:
            entry.group = context.object.vertex_groups.active.name
        return {"FINISHED"}


class MUSLIN_OT_map_remove(RemoveEntry):
    bl_idname = "muslin.map_remove"
    bl_label = "Remove Map"
    bl_description = "Let the number be the same everywhere"

    entries = "maps"


class MUSLIN_OT_attachment_add(RoleOperator):
    bl_idname = "muslin.attachment_add"
    bl_label = "Add Attachment"
    bl_description = "Hold a vertex group to another muslin object"

    def execute(self, context):
        obj = context.object
        entry = obj.muslin.attachments.add()
        if obj.vertex_groups.active:
            entry.group = obj.vertex_groups.active.name
        others = [o for o in context.scene.objects if o != obj and o.type == "MESH" and o.muslin.role != "NONE"]
        if len(others) == 1:
            entry.target = others[0]
        return {"FINISHED"}


class MUSLIN_OT_attachment_remove(RemoveEntry):
    bl_idname = "muslin.attachment_remove"
    bl_label = "Remove Attachment"
    bl_description = "Let the vertices go"

    entries = "attachments"


class MUSLIN_MT_presets(Menu):
    bl_label = "Fabric Presets"
    preset_subdir = "muslin_cloth"
    preset_operator = "script.execute_preset"
    draw = Menu.draw_preset


class MUSLIN_OT_preset_add(AddPresetBase, Operator):
    bl_idname = "muslin.preset_add"
    bl_label = "Add Fabric Preset"
    bl_description = "Save fabric, sliders and stretch limit under a name, or remove a saved one"
    preset_menu = "MUSLIN_MT_presets"
    preset_subdir = "muslin_cloth"
    preset_defines = ["muslin = bpy.context.object.muslin"]
    preset_values = [f"muslin.{name}" for name in (
        "model", "fabric", "weight_factor", "stiffness_factor", "bending_factor", "damping_factor", "thickness",
        "use_stretch_limit", "stretch_limit", "use_friction", "friction")]


class MUSLIN_OT_suggest_width(RoleOperator):
    bl_idname = "muslin.suggest_width"
    bl_label = "Suggest"
    bl_description = "The voxel width that gives about 8000 voxels"

    def execute(self, context):
        obj = context.object
        try:
            taken = snapshot(obj, depsgraph_of(context.scene), topology=True)
        except Problem as problem:
            self.report({"WARNING"}, str(problem))
            return {"CANCELLED"}
        m = obj.muslin
        m.area, m.volume, m.closed = measure(taken)
        m.voxel_width = suggestion(obj, taken)
        return {"FINISHED"}


CLASSES = (MUSLIN_OT_bake, MUSLIN_OT_bake_from_current, MUSLIN_OT_resume, MUSLIN_OT_cancel, MUSLIN_OT_free,
           MUSLIN_OT_check, MUSLIN_OT_select_crossing, MUSLIN_OT_report, MUSLIN_OT_cloth_add, MUSLIN_OT_collider_add, MUSLIN_OT_remove,
           MUSLIN_OT_map_add, MUSLIN_OT_map_remove, MUSLIN_OT_attachment_add, MUSLIN_OT_attachment_remove,
           MUSLIN_MT_presets, MUSLIN_OT_preset_add, MUSLIN_OT_suggest_width)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
