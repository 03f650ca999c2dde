"""Helpers that tests inside Blender share: the add-on switched on, scratch folders, cloth to bake.

Run a test file with `blender -b --factory-startup --python-exit-code 3 --python FILE` or with a Python that has
the bpy module. MUSLIN_PROGRAM is the muslin program."""

import os
import pathlib
import shutil
import sys
import tempfile
import unittest

import bpy
import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
ADDON = os.environ.get("MUSLIN_ADDON", "muslin_cloth")
PROGRAM = os.environ.get("MUSLIN_PROGRAM", str(HERE.parent.parent / "build" / "release" / "muslin"))


def enable(program=PROGRAM):
    """Switches the add-on on; its modules by name."""
    import addon_utils
    if str(HERE.parent) not in sys.path:
        sys.path.insert(0, str(HERE.parent))
    if not addon_utils.check(ADDON)[1]:
        addon_utils.enable(ADDON, default_set=True)
    bpy.context.preferences.addons[ADDON].preferences.program = program


def module(name):
    import importlib
    return importlib.import_module(f"{ADDON}.{name}")


def session(scene=None):
    return module("session").session_of(scene or bpy.context.scene)


def grid(name="Cloth", n=8, size=1.0, pins="top"):
    """A square in the xz plane, n by n quads, with UVs; its upper edge in the vertex group `pins`."""
    xs = np.linspace(-size / 2, size / 2, n + 1)
    vertices = [(x, 0.0, z + 1.0) for z in xs for x in xs]
    at = lambda i, j: j * (n + 1) + i
    faces = [(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)) for j in range(n) for i in range(n)]
    return mesh_object(name, vertices, faces, [at(i, n) for i in range(n + 1)] if pins else [])


def mesh_object(name, vertices, faces, pinned=()):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], faces)
    uvs = mesh.uv_layers.new()
    for loop in mesh.loops:
        x, _, z = mesh.vertices[loop.vertex_index].co
        uvs.data[loop.index].uv = (x, z)
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    if len(pinned):
        obj.vertex_groups.new(name="pins").add(list(pinned), 1.0, "REPLACE")
    return obj


def cloth(obj, **settings):
    with bpy.context.temp_override(object=obj, active_object=obj):
        bpy.ops.muslin.cloth_add()
    if obj.vertex_groups.get("pins"):
        obj.muslin.pin_group = "pins"
    for name, value in settings.items():
        setattr(obj.muslin, name, value)
    return obj


def points(obj, frame=None):
    """World positions of the object as shown."""
    scene = bpy.context.scene
    if frame is not None:
        scene.frame_set(frame)
    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    co = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", co)
    m = np.array(evaluated.matrix_world)
    evaluated.to_mesh_clear()
    return co.reshape(-1, 3).astype(float) @ m[:3, :3].T + m[:3, 3]


def cached(folder, body, frame, scale=1.0):
    """The points in the cache of the run, in Blender's world."""
    p = module("point_cache").Reader(folder / "run" / f"{body}.skin.pc2").read(frame) / scale
    return np.stack([p[:, 0], -p[:, 2], p[:, 1]], -1)


class HostTest(unittest.TestCase):
    """An empty saved file in a folder of its own."""

    def setUp(self):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        enable()
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="muslin."))
        self.addCleanup(shutil.rmtree, self.folder, True)
        self.addCleanup(bpy.ops.wm.read_factory_settings, use_empty=True)  # nothing plays from it any more
        scene = bpy.context.scene
        scene.frame_start, scene.frame_end = 1, 6
        scene.render.fps = 24
        scene.muslin.use_automatic_steps, scene.muslin.steps_per_frame = False, 2
        scene.muslin.use_contact = False  # costs time; tests of contact switch it on
        self.save("work.blend")

    def save(self, name="work.blend"):
        bpy.ops.wm.save_as_mainfile(filepath=str(self.folder / name))

    @property
    def bake(self):
        return self.folder / "muslin_work" / "Scene"

    def assert_plays(self, obj, body, first, last, scale=1.0, tolerance=1e-6):
        for frame in range(first, last + 1):
            shown, there = points(obj, frame), cached(self.bake, body, frame - first, scale)
            self.assertEqual(shown.shape, there.shape)
            self.assertLess(np.abs(shown - there).max(), tolerance, f"frame {frame}")


def main():
    words = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    result = unittest.main(module="__main__", argv=["test", *words], exit=False, verbosity=2).result
    code = 0 if result.wasSuccessful() else 3
    if not bpy.app.binary_path:
        # The bpy module may crash while Python takes it down, after all is done and told.
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)
    if code:
        raise SystemExit(code)
