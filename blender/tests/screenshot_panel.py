"""Draws the panel in a real window and takes pictures of it: `blender/tests/screenshots OUT` runs it under Xvfb.

blender --factory-startup --python screenshot_panel.py -- OUT"""

import os
import pathlib
import shutil
import sys
import tempfile
import traceback

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import bpy

import host
from host import cloth, grid

OUT = pathlib.Path(sys.argv[sys.argv.index("--") + 1]).resolve()
steps = []


def step(function):
    steps.append(function)
    return function


def window():
    return bpy.context.window_manager.windows[0]


def picture(name):
    bpy.ops.wm.redraw_timer(type="DRAW_WIN_SWAP", iterations=1)
    with bpy.context.temp_override(window=window()):
        bpy.ops.screen.screenshot(filepath=str(OUT / f"{name}.png"))


def properties_area():
    """A tall one, split off the view."""
    view = next(a for a in window().screen.areas if a.type == "VIEW_3D")
    known = set(window().screen.areas)
    with bpy.context.temp_override(window=window(), area=view):
        bpy.ops.screen.area_split(direction="VERTICAL", factor=0.52)
    area = next(a for a in window().screen.areas if a not in known)
    area.type = "PROPERTIES"
    return area


@step
def scene_with_a_flag():
    folder = tempfile.mkdtemp(prefix="muslin.")
    for obj in list(bpy.data.objects):
        if obj.type == "MESH":
            bpy.data.objects.remove(obj)
    obj = grid("Flag", n=24, size=1.0, pins=None)
    obj.vertex_groups.new(name="pins").add([25 * j for j in (0, 8, 16, 24)], 1.0, "REPLACE")  # along its hoist
    obj.location.z = -0.5
    bpy.context.scene.frame_end = 300
    bpy.context.scene.muslin.use_automatic_steps = False
    bpy.context.scene.muslin.steps_per_frame = 6
    bpy.context.scene.muslin.use_contact = False  # the bake ends soon
    bpy.ops.object.effector_add(type="WIND", location=(-1, 0.6, 0.3), rotation=(0, 1.5708, 0.3))
    bpy.context.object.field.strength = 4
    bpy.context.view_layer.objects.active = obj
    bpy.ops.wm.save_as_mainfile(filepath=folder + "/flag.blend")
    properties_area()
    for view in (a for a in window().screen.areas if a.type == "VIEW_3D"):
        region = view.spaces[0].region_3d
        region.view_distance, region.view_location = 3.0, (0, 0, 0.4)
        view.spaces[0].shading.type = "SOLID"


def tallest():
    return max((a for a in window().screen.areas if a.type == "PROPERTIES"), key=lambda a: a.height)


def scroll(operator):
    area = tallest()
    region = next(r for r in area.regions if r.type == "WINDOW")
    with bpy.context.temp_override(window=window(), area=area, region=region):
        for _ in range(15):  # lines
            operator()


@step
def physics():
    tallest().spaces[0].context = "PHYSICS"


@step
def before():
    picture("1_add")


@step
def added():
    cloth(bpy.context.view_layer.objects.active)
    bpy.context.scene.frame_set(1)


@step
def painted():
    obj = bpy.context.view_layer.objects.active
    entry = obj.muslin.maps.add()
    entry.what, entry.group, entry.high = "BENDING", "pins", 20
    obj.muslin.weight_factor = 1.5
    pole = host.mesh_object("Pole", [(-0.55, 0, 0), (-0.5, 0, 0), (-0.5, 0, 1), (-0.55, 0, 1)], [(0, 1, 2, 3)])
    bpy.ops.muslin.collider_add()
    pole.hide_set(True)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.muslin.attachment_add()
    assert obj.muslin.attachments[0].target == pole
    obj.muslin.attachments[0].use_break_force = True


@step
def settings():
    picture("2_settings")
    scroll(bpy.ops.view2d.scroll_down)


@step
def lower_settings():
    picture("2_settings_lower")
    scroll(bpy.ops.view2d.scroll_up)
    obj = bpy.context.view_layer.objects.active
    bpy.data.objects.remove(obj.muslin.attachments[0].target)
    obj.muslin.attachments.clear()
    obj.muslin.maps.clear()
    bpy.context.view_layer.objects.active.muslin.weight_factor = 1
    assert bpy.ops.muslin.check("INVOKE_DEFAULT") == {"FINISHED"}


@step
def checked():
    if host.session().question:
        return "again"
    picture("3_checked")
    bpy.ops.muslin.bake("INVOKE_DEFAULT")


@step
def running():
    """The clock of the add-on runs the bake: nothing here ticks it."""
    state = host.session().state
    if state.frame < 30 and state.busy:
        return "again"
    assert state.busy, f"it should still be at work: {state}"
    bpy.context.scene.frame_set(24)
    picture("4_baking")
    bpy.ops.muslin.cancel("INVOKE_DEFAULT")


@step
def stopped():
    state = host.session().state
    if state.busy:
        return "again"
    assert state.resumable, state
    picture("5_stopped")
    bpy.ops.muslin.resume("INVOKE_DEFAULT")


@step
def done():
    state = host.session().state
    if state.busy:
        return "again"
    assert state.phase.value == "done", state
    assert bpy.data.is_dirty, "closing asks to save"
    bpy.context.scene.frame_set(60)
    picture("6_done")


@step
def bad():
    obj = bpy.context.view_layer.objects.active
    mesh = obj.data
    mesh.vertices.add(3)
    bpy.context.scene.frame_set(1)
    bpy.ops.muslin.bake("INVOKE_DEFAULT")


@step
def refused():
    state = host.session().state
    if state.busy:
        return "again"
    assert "Delete Loose" in state.problem, state
    picture("7_refused")
    bpy.ops.muslin.remove()
    bpy.ops.muslin.collider_add()
    obj = bpy.context.view_layer.objects.active
    bpy.context.scene.muslin.use_contact = obj.muslin.use_friction = True


@step
def collider():
    assert bpy.context.view_layer.objects.active.muslin.role == "COLLIDER"
    picture("8_collider")


def run():
    try:
        if steps[0]() != "again":
            steps.pop(0)
    except Exception:
        traceback.print_exc()
        leave(1)
    if not steps:
        print("screenshots done")
        leave(0)
    return 0.3


def leave(code):
    folder = pathlib.Path(bpy.data.filepath).parent
    host.module("session").stop_all()
    if folder.name.startswith("muslin."):
        shutil.rmtree(folder, ignore_errors=True)
    sys.stdout.flush()
    os._exit(code)


OUT.mkdir(parents=True, exist_ok=True)
host.enable()
bpy.app.timers.register(run, first_interval=1.0)
