"""The package as an extension of Blender 4.2: its manifest holds, it installs, bakes and goes again. And a run's way
through USD and Alembic: positions come back equal. Needs the bpy module; tools/bpy_tests sets that up."""

import os
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
os.environ["BLENDER_USER_RESOURCES"] = tempfile.mkdtemp(prefix="muslin.resources.")  # nothing of the user's is touched
os.environ["MUSLIN_ADDON"] = "bl_ext.user_default.muslin_cloth"

import bpy
import numpy as np

import host
from host import HostTest, cloth, grid, points

CLI = pathlib.Path(bpy.utils.system_resource("SCRIPTS")) / "addons_core" / "bl_pkg" / "cli" / "blender_ext.py"


def package(folder):
    made = subprocess.run([sys.executable, str(HERE.parent / "package"), "-o", str(folder)], check=True,
                          capture_output=True, text=True)
    return made.stdout.strip()


class Extension(HostTest):
    def setUp(self):
        self.zip = package(tempfile.mkdtemp(prefix="muslin.package."))
        bpy.ops.wm.read_factory_settings(use_empty=True)
        bpy.ops.extensions.package_install_files(filepath=self.zip, repo="user_default", enable_on_install=True)
        super().setUp()

    def test_the_manifest_holds(self):
        for what in (self.zip, str(HERE.parent / "muslin_cloth")):
            told = subprocess.run([sys.executable, str(CLI), "validate", what], capture_output=True, text=True, check=False)
            self.assertEqual(told.returncode, 0, told.stdout + told.stderr)
        broken = self.folder / "muslin_cloth"
        broken.mkdir()
        text = (HERE.parent / "muslin_cloth" / "blender_manifest.toml").read_text()
        (broken / "blender_manifest.toml").write_text(text.replace('tags = ["Physics"', 'tags = ["Phys"'))
        told = subprocess.run([sys.executable, str(CLI), "validate", str(broken)], capture_output=True, check=False)
        self.assertNotEqual(told.returncode, 0, "the check can fail")

    def test_it_bakes_and_goes_again(self):
        obj = cloth(grid())
        bpy.ops.muslin.bake()
        self.assert_plays(obj, "Cloth", 1, 6)
        self.save()
        bpy.ops.preferences.addon_disable(module=host.ADDON)
        self.assertFalse(hasattr(bpy.types.Object, "muslin"))
        bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)
        obj = bpy.data.objects["Cloth"]
        p = host.module("point_cache").Reader(self.bake / "Cloth.pc2").read(5)
        self.assertLess(np.abs(points(obj, 6) - p).max(), 1e-6)


class RoundTrips(HostTest):
    """A run as other programs exchange it. Blender is z up, its files keep time in frames of the scene."""

    def setUp(self):
        super().setUp()
        self.obj = cloth(grid(), pin_group="")
        bpy.ops.muslin.bake()
        self.shown = {f: points(self.obj, f) for f in range(1, 7)}
        self.assertGreater(np.abs(self.shown[6] - self.shown[1]).max(), 0.01)

    def assert_same(self, obj, frames=range(1, 7)):
        for frame in frames:
            seen = points(obj, frame)
            self.assertEqual(seen.shape, self.shown[frame].shape)
            self.assertLess(np.abs(seen - self.shown[frame]).max(), 2e-6, f"frame {frame}")

    def reopen(self):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        scene = bpy.context.scene
        scene.frame_start, scene.frame_end, scene.render.fps = 1, 6, 24

    def meshes(self):
        return [o for o in bpy.data.objects if o.type == "MESH"]

    def test_the_usd_of_muslin_export(self):
        """`muslin export RUN x.usda`: frame 0 is time code 0."""
        path = str(self.folder / "run.usda")
        subprocess.run([host.PROGRAM, "export", str(self.bake / "run"), path], check=True, capture_output=True)
        self.reopen()
        bpy.ops.wm.usd_import(filepath=path, set_frame_range=False)
        obj = self.meshes()[0]
        for frame in range(1, 7):
            seen = points(obj, frame - 1)  # time code n is Blender's frame n
            self.assertLess(np.abs(seen - self.shown[frame]).max(), 2e-6, f"frame {frame}")

    def test_usd_from_blender_and_back(self):
        path = str(self.folder / "scene.usdc")
        bpy.ops.wm.usd_export(filepath=path, export_animation=True, selected_objects_only=False)
        self.reopen()
        bpy.ops.wm.usd_import(filepath=path, set_frame_range=False)
        self.assert_same(self.meshes()[0])

    def test_alembic_from_blender_and_back(self):
        path = str(self.folder / "scene.abc")
        bpy.ops.wm.alembic_export(filepath=path, start=1, end=6, as_background_job=False)
        self.reopen()
        bpy.ops.wm.alembic_import(filepath=path, as_background_job=False, set_frame_range=False)
        self.assert_same(self.meshes()[0])


if __name__ == "__main__":
    host.main()
