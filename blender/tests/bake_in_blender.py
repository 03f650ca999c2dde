"""Bakes in a real Blender, without a window: playback equals the cache, cancel, resume, kill, undo, reopen."""

import json
import os
import pathlib
import signal
import subprocess
import sys
import time
import tomllib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import bpy
import numpy as np

import host
from host import HostTest, cloth, grid, points, session


class Baking(HostTest):
    def test_playback_equals_the_cache(self):
        obj = cloth(grid())
        start = points(obj, 1)
        bpy.ops.muslin.bake()
        self.assert_plays(obj, "Cloth", 1, 6)
        self.assertLess(np.abs(points(obj, 1) - start).max(), 1e-6)
        self.assertLess(points(obj, 6)[:, 2].min(), start[:, 2].min() - 1e-3, "it falls")
        held = [v.index for v in obj.data.vertices if v.groups]
        self.assertLess(np.abs(points(obj, 6)[held] - start[held]).max(), 1e-6)
        self.assertTrue(obj.modifiers["Muslin"].filepath.startswith("//"))

    def test_report_of_a_bake(self):
        cloth(grid())
        self.assertFalse(bpy.ops.muslin.report.poll())
        bpy.ops.muslin.bake()
        bpy.ops.muslin.report()
        run = session().folder / "run"
        self.assertIn("Certificate of a run", (run / "report.html").read_text(encoding="utf-8"))
        self.assertEqual(json.loads((run / "report.json").read_text(encoding="utf-8"))["verdict"]["broken"], 0)

    def test_any_transform_and_unit(self):
        """Turned, scaled by axis, mirrored, below a parent that moves, in centimetres: in the world nothing slips."""
        scene = bpy.context.scene
        scene.unit_settings.scale_length = 0.01
        scene.gravity = (0, 0, -980)
        parent = bpy.data.objects.new("Parent", None)
        scene.collection.objects.link(parent)
        parent.rotation_euler = (0.3, 0.2, 1.0)
        for frame, x in ((1, 0.0), (6, 40.0)):
            parent.location = (x, 3, 5)
            parent.keyframe_insert("location", frame=frame)
        obj = cloth(grid(size=80))
        obj.parent = parent
        obj.scale = (1.5, 1, -0.7)
        obj.rotation_euler = (0.5, -0.4, 0.1)
        scene.frame_set(1)
        start, world = points(obj, 1), np.array(obj.matrix_world)
        bpy.ops.muslin.bake()
        self.assert_plays(obj, "Cloth", 1, 6, scale=0.01, tolerance=1e-6 * 200)
        self.assertLess(np.abs(points(obj, 1) - start).max(), 1e-4)
        held = [v.index for v in obj.data.vertices if v.groups]
        scene.frame_set(6)
        moved = np.array(obj.matrix_world)
        self.assertGreater(np.abs(moved - world).max(), 1)
        local = np.array([v.co for v in obj.data.vertices])[held]
        expected = local @ moved[:3, :3].T + moved[:3, 3]
        self.assertLess(np.abs(points(obj, 6)[held] - expected).max(), 1e-3, "pins go with the parent")

    def test_pins_follow_an_armature_and_a_shape_key(self):
        """Modifiers above the Muslin modifier move the pins, those below it refine the cloth."""
        scene = bpy.context.scene
        obj = grid()
        held = [v.index for v in obj.data.vertices if v.groups]
        armature = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
        scene.collection.objects.link(armature)
        bpy.context.view_layer.objects.active = armature
        bpy.ops.object.mode_set(mode="EDIT")
        bone = armature.data.edit_bones.new("Bone")
        bone.head, bone.tail = (0, 0, 1.5), (0, 0, 2.0)
        bpy.ops.object.mode_set(mode="OBJECT")
        obj.vertex_groups.new(name="Bone").add(range(len(obj.data.vertices)), 1.0, "REPLACE")
        rig = obj.modifiers.new("Armature", "ARMATURE")
        rig.object = armature
        pose = armature.pose.bones["Bone"]
        pose.rotation_mode = "XYZ"
        for frame, angle in ((1, 0.0), (6, 0.4)):
            pose.rotation_euler = (0, angle, 0)
            pose.keyframe_insert("rotation_euler", frame=frame)
        obj.shape_key_add(name="Basis")
        key = obj.shape_key_add(name="Lift")
        for v in held:
            key.data[v].co.z += 0.1
        for frame, value in ((1, 0.0), (6, 1.0)):
            key.value = value
            key.keyframe_insert("value", frame=frame)
        fine = obj.modifiers.new("Subdivision", "SUBSURF")
        expected = {}
        fine.show_viewport = False
        for frame in range(1, 7):
            expected[frame] = points(obj, frame)[held]
        cloth(obj)
        self.assertEqual([m.type for m in obj.modifiers], ["ARMATURE", "MESH_CACHE", "SUBSURF"])
        fine.show_viewport = True
        bpy.ops.muslin.bake()
        self.assertTrue(fine.show_viewport)
        self.assertGreater(len(points(obj, 2)), len(obj.data.vertices), "it is refined")
        fine.show_viewport = False
        self.assert_plays(obj, "Cloth", 1, 6)
        for frame in range(1, 7):
            self.assertLess(np.abs(points(obj, frame)[held] - expected[frame]).max(), 1e-6, f"frame {frame}")
        self.assertGreater(np.abs(expected[6] - expected[1]).max(), 0.1)

    def test_a_modifier_above_may_refine_what_is_simulated(self):
        obj = grid(n=4)
        obj.modifiers.new("Subdivision", "SUBSURF").subdivision_type = "SIMPLE"
        cloth(obj)
        bpy.ops.object.modifier_move_to_index(modifier="Muslin", index=1)
        bpy.ops.muslin.bake()
        self.assertEqual(len(points(obj, 3)), 81)
        self.assert_plays(obj, "Cloth", 1, 6)

    def test_a_solid_and_a_cloth_in_one_bake(self):
        ball = host.mesh_object("Ball", *icosphere())
        cloth(ball, model="LATTICE", fabric="rubber", voxel_width=0.1)
        ball.location = (3, 0, 1)
        flag = cloth(grid("Flag"))
        bpy.ops.muslin.bake()
        self.assert_plays(ball, "Ball", 1, 6)
        self.assert_plays(flag, "Flag", 1, 6)
        fall = points(ball, 1)[:, 2].mean() - points(ball, 6)[:, 2].mean()
        self.assertAlmostEqual(fall, 0.5 * 9.81 * (5 / 24) ** 2, delta=0.06)

    def test_wind_and_gravity_are_the_scenes(self):
        scene = bpy.context.scene
        obj = cloth(grid())
        scene.use_gravity = False
        bpy.ops.muslin.bake()
        self.assertLess(np.abs(points(obj, 6) - points(obj, 1)).max(), 1e-5, "nothing moves it")
        bpy.ops.object.effector_add(type="WIND", rotation=(0, np.pi / 2, 0))  # blows along +x
        wind = bpy.context.object
        wind.field.strength = 8
        wind.rotation_euler = (np.pi / 2, 0, 0)  # and now along −y
        for frame, strength in ((1, 8.0), (6, 16.0)):
            wind.field.strength = strength
            wind.field.keyframe_insert("strength", frame=frame)
        bpy.ops.object.effector_add(type="HARMONIC")
        bpy.ops.muslin.bake()
        text = (self.bake / "scene.toml").read_text()
        self.assertIn("keyframes", text)
        self.assertNotIn("gravity", text)
        self.assertLess(points(obj, 6)[:, 1].min(), -0.01)
        self.assertTrue(any("Harmonic" in n.text for n in session().notices))

    def test_force_fields_are_fields_of_muslin(self):
        scene = bpy.context.scene
        obj = cloth(grid())
        scene.use_gravity = False
        bpy.ops.object.effector_add(type="FORCE", location=(0, 0, -3))
        force = bpy.context.object
        for frame, strength in ((1, 30.0), (6, 60.0)):
            force.field.strength = strength
            force.field.keyframe_insert("strength", frame=frame)
        force.field.falloff_power, force.field.use_max_distance, force.field.distance_max = 1, True, 20
        bpy.ops.object.effector_add(type="VORTEX", location=(1, 2, 3), rotation=(np.pi / 2, 0, 0))
        bpy.context.object.field.strength = 2
        bpy.ops.object.effector_add(type="DRAG")
        bpy.context.object.field.linear_drag = 0.5
        bpy.ops.object.effector_add(type="WIND")
        bpy.context.object.field.strength, bpy.context.object.field.falloff_power = 3, 2
        bpy.ops.muslin.bake()
        told = tomllib.loads((self.bake / "scene.toml").read_text())["force"]
        self.assertEqual([f["type"] for f in told], ["wind", "radial", "vortex", "drag", "uniform"])
        wind, radial, vortex, drag, uniform = told
        self.assertEqual(wind["velocity"], [0, 0, 0])
        self.assertEqual(radial["acts_as"], "acceleration")
        self.assertEqual(radial["center"], [0, -3, 0])
        self.assertEqual(radial["falloff"], {"power": 1, "min": 0, "length": 1, "max": 20})
        self.assertEqual(radial["strength"]["keyframes"][0], {"time": 0, "value": 30})
        np.testing.assert_allclose(vortex["center"], [1, 3, -2], atol=1e-6)
        np.testing.assert_allclose(vortex["axis"], [0, 0, 1], atol=1e-6)  # Blender's -y
        self.assertEqual(drag["linear"], 0.5)
        np.testing.assert_allclose(uniform["direction"], [0, 1, 0], atol=1e-6)
        self.assertGreater(points(obj, 6)[:, 2].mean() - points(obj, 1)[:, 2].mean(), 0.01, "pushed up")

    def test_a_run_plays_without_the_add_on(self):
        """docs/guide/blender.md: import the mesh, add a Mesh Cache modifier by hand."""
        obj = cloth(grid(), pin_group="")
        bpy.ops.muslin.bake()
        shown = {f: points(obj, f) for f in (1, 4, 6)}
        self.assertGreater(np.abs(shown[6] - shown[1]).max(), 0.1)
        run = self.bake / "run"
        bpy.ops.wm.obj_import(filepath=str(run / "Cloth.skin.obj"))
        other = bpy.context.object
        cache = other.modifiers.new("Cache", "MESH_CACHE")
        cache.cache_format, cache.filepath, cache.frame_start = "PC2", str(run / "Cloth.skin.pc2"), 1
        for frame, there in shown.items():
            self.assertLess(np.abs(points(other, frame) - there).max(), 2e-6)

    def test_release_lets_go(self):
        obj = cloth(grid())
        obj.muslin.use_release, obj.muslin.release_frame = True, 3
        bpy.ops.muslin.bake()
        held = [v.index for v in obj.data.vertices if v.groups]
        self.assertLess(np.abs(points(obj, 3)[held] - points(obj, 1)[held]).max(), 1e-6)
        self.assertLess(points(obj, 6)[held][:, 2].max(), points(obj, 3)[held][:, 2].min() - 0.01)


class Contact(HostTest):
    """Cloth meets colliders, standing and animated."""

    def setUp(self):
        super().setUp()
        bpy.context.scene.muslin.use_contact = True

    def sheet(self, height, n=12):
        xs = np.linspace(-0.3, 0.3, n + 1)
        at = lambda i, j: j * (n + 1) + i
        faces = [(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)) for j in range(n) for i in range(n)]
        return cloth(host.mesh_object("Sheet", [(x, y, height) for y in xs for x in xs], faces))

    def box(self, size=0.5):
        h = size / 2
        corners = [(x, y, z) for x in (-h, h) for y in (-h, h) for z in (-h, h)]
        faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
        obj = host.mesh_object("Box", corners, faces)
        bpy.ops.muslin.collider_add()
        self.assertEqual(obj.muslin.role, "COLLIDER")
        return obj

    def test_a_sheet_lies_on_a_standing_box(self):
        bpy.context.scene.frame_end = 14
        box = self.box()
        box.location.z = -0.25
        obj = self.sheet(0.1)
        bpy.context.scene.muslin.use_automatic_steps, bpy.context.scene.muslin.steps_per_frame = False, 8
        bpy.ops.muslin.bake()
        self.assert_plays(obj, "Sheet", 1, 14)
        middle = points(obj, 14)[6 * 13 + 6]
        self.assertGreater(middle[2], 0.0, "it lies on the box")
        self.assertLess(middle[2], 0.02)
        self.assertNotIn("sequence", (self.bake / "scene.toml").read_text())
        self.assertTrue(any("UV map" in n.text for n in session().notices), "seen from the side it has no area there")
        bpy.context.scene.muslin.use_contact = False
        bpy.ops.muslin.bake()
        self.assertLess(points(obj, 14)[:, 2].max(), -0.5, "without contact it falls through")

    def test_a_collider_that_moves_lifts_the_sheet(self):
        bpy.context.scene.frame_end = 12
        box = self.box()
        for frame, z in ((1, -0.3), (12, 0.0)):
            box.location.z = z
            box.keyframe_insert("location", frame=frame)
        obj = self.sheet(0.0)
        bpy.context.scene.muslin.use_automatic_steps, bpy.context.scene.muslin.steps_per_frame = False, 8
        bpy.ops.muslin.bake()
        self.assertIn("sequence", (self.bake / "scene.toml").read_text())
        self.assertGreater(points(obj, 12)[6 * 13 + 6][2], 0.25, "it is carried up")

    def test_friction_is_the_scenes_or_that_of_cloth_and_collider(self):
        scene = bpy.context.scene
        scene.frame_end, scene.muslin.friction = 12, 0.5
        scene.muslin.use_automatic_steps, scene.muslin.steps_per_frame = False, 8
        scene.gravity = (2.82, 0, -9.4)  # a slope of 0.3, seen from itself
        box = self.box(2)
        box.location.z = -1
        obj = self.sheet(0.003, n=4)

        def way():
            bpy.ops.muslin.bake()
            return (points(obj, 12)[:, 0] - points(obj, 1)[:, 0]).mean()

        self.assertLess(way(), 0.01, "0.5 holds")
        box.muslin.friction = 0.0
        self.assertLess(way(), 0.01, "but is not asked for")
        box.muslin.use_friction = True
        free = 0.5 * 2.82 * (11 / scene.render.fps) ** 2
        self.assertAlmostEqual(way(), free, delta=0.1 * free, msg="no friction on what has none")
        box.muslin.friction, obj.muslin.use_friction, obj.muslin.friction = 0.02, True, 0.5
        self.assertAlmostEqual(way(), free * (1 - 0.1 / 0.3), delta=0.1 * free, msg="0.1 is the mean of 0.02 and 0.5")

    def test_cloth_that_crosses_at_the_start_is_pulled_apart(self):
        box = self.box()
        box.location.z = 0.0
        self.sheet(0.1)
        bpy.ops.muslin.bake()
        start = json.loads((self.bake / "run" / "run.json").read_text())["tangled_start"]
        self.assertGreater(start["crossings"], 0)


class Lifecycle(HostTest):
    """Bakes that are begun, cancelled, resumed or lost."""

    def begin(self, frames=600, **settings):
        bpy.context.scene.frame_end = frames
        obj = cloth(grid(n=12), **settings)
        s = session()
        s.feed(self.events().Bake(frames - 1))
        return obj, s

    def events(self):
        return host.module("bake_state")

    def tick_until(self, s, condition, seconds=60):
        end = time.monotonic() + seconds
        while not condition():
            s.tick()
            self.assertLess(time.monotonic(), end, f"{s.state}")
            time.sleep(0.01)

    def test_cancel_and_resume_give_what_one_bake_gives(self):
        bs = self.events()
        obj, s = self.begin(400)
        self.tick_until(s, lambda: s.state.frame >= 2)
        s.feed(bs.Cancel())
        self.tick_until(s, lambda: not s.state.busy)
        self.assertEqual(s.state.phase, bs.Phase.STOPPED)
        self.assertLess(s.state.frame, 399)
        points(obj, 3)
        bpy.ops.muslin.resume()
        self.assertEqual(s.state.phase, bs.Phase.DONE)
        resumed = (self.bake / "Cloth.pc2").read_bytes()
        self.assertEqual(resumed.count(b"POINTCACHE2"), 1)
        bpy.ops.muslin.bake()
        self.assertEqual((self.bake / "Cloth.pc2").read_bytes(), resumed)

    def test_cancel_before_the_worker_keeps_the_old_bake(self):
        bs = self.events()
        bpy.context.scene.frame_end = 3
        cloth(grid())
        bpy.ops.muslin.bake()
        before = (self.bake / "Cloth.pc2").read_bytes()
        s = session()
        s.feed(bs.Bake(400))
        s.feed(bs.Cancel())
        self.assertEqual((s.state.phase, s.state.frame), (bs.Phase.DONE, 2))
        self.assertEqual((self.bake / "Cloth.pc2").read_bytes(), before)
        self.assertFalse((self.bake / "check").exists())

    def test_a_killed_worker_is_noticed_and_resumed(self):
        bs = self.events()
        obj, s = self.begin(60)
        self.tick_until(s, lambda: s.state.frame >= 3)
        os.kill(s.worker.pid, signal.SIGKILL)
        self.tick_until(s, lambda: not s.state.busy)
        self.assertEqual(s.state.phase, bs.Phase.FAILED)
        self.assertIn("killed", s.state.problem)
        self.assertTrue(s.state.resumable)
        bpy.ops.muslin.resume()
        self.assertEqual((s.state.phase, s.state.frame), (bs.Phase.DONE, 59))
        self.assert_plays(obj, "Cloth", 1, 5)
        killed = (self.bake / "Cloth.pc2").read_bytes()
        bpy.ops.muslin.bake()
        self.assertEqual((self.bake / "Cloth.pc2").read_bytes(), killed)

    def test_a_blender_that_crashed_finds_its_worker_again(self):
        """The worker goes on; a Blender that opens the file later follows it, and can stop it."""
        bs = self.events()
        obj, s = self.begin(3000)
        self.save()
        self.tick_until(s, lambda: s.state.frame >= 2)
        self.save()
        host.module("session").sessions.clear()  # a crash: nobody says goodbye
        bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)
        host.enable()
        s2 = session()
        self.assertIsNot(s2, s)
        self.assertEqual(s2.state.phase, bs.Phase.RUNNING)
        before = s2.state.frame
        self.tick_until(s2, lambda: s2.state.frame > before)
        s2.feed(bs.Cancel())
        self.tick_until(s2, lambda: not s2.state.busy)
        self.assertEqual(s2.state.phase, bs.Phase.STOPPED)
        s.worker.wait(30)  # it is still a child of this process
        self.assertEqual(s.worker.ended(), 130)

    def test_opening_another_file_stops_the_worker(self):
        bs = self.events()
        obj, s = self.begin(3000)
        self.tick_until(s, lambda: s.state.frame >= 2)
        self.save()
        worker = s.worker
        bpy.ops.wm.read_homefile(use_empty=True)
        worker.wait(30)
        self.assertEqual(worker.ended(), 130)
        bpy.ops.wm.open_mainfile(filepath=str(self.folder / "work.blend"))
        s = session()
        self.assertEqual(s.state.phase, bs.Phase.STOPPED)
        self.assertTrue(s.state.resumable)

    def test_bake_on_from_a_frame_with_other_pins_and_wind(self):
        scene = bpy.context.scene
        obj = cloth(grid())
        bpy.ops.muslin.bake()
        before = {f: points(obj, f) for f in range(1, 7)}
        bpy.ops.object.effector_add(type="WIND", rotation=(np.pi / 2, 0, 0))
        bpy.context.object.field.strength = 15
        scene.frame_end = 8
        scene.frame_set(3)
        bpy.ops.muslin.bake_from_current()
        self.assertEqual(session().state.frame, 7)
        for frame in (1, 2, 3):
            np.testing.assert_array_equal(points(obj, frame), before[frame])
        self.assertGreater(np.abs(points(obj, 6) - before[6]).max(), 1e-3)
        self.assert_plays(obj, "Cloth", 1, 8)
        # A setting that cannot change during a bake is named, and no frame is lost.
        obj.muslin.fabric = "denim"
        scene.frame_set(4)
        after = points(obj, 8)
        scene.frame_set(4)
        with self.assertRaisesRegex(RuntimeError, "Fabric changed since the first frame.*from the start"):
            bpy.ops.muslin.bake_from_current()
        self.assertEqual(session().state.frame, 7)
        np.testing.assert_array_equal(points(obj, 8), after)

    def test_undo_leaves_playback_alone(self):
        obj = cloth(grid())
        bpy.ops.ed.undo_push(message="before")
        bpy.ops.muslin.bake()
        shown = points(obj, 5)
        obj.name = "Renamed"
        bpy.ops.ed.undo_push(message="after")
        with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
            bpy.ops.ed.undo()
        obj = bpy.data.objects["Cloth"]
        np.testing.assert_array_equal(points(obj, 5), shown)

    def test_free_takes_all_away(self):
        obj = cloth(grid())
        start = points(obj, 5)
        bpy.ops.muslin.bake()
        other = self.bake / "notes.obj"
        other.write_text("not muslin's")
        bpy.ops.muslin.free()
        self.assertEqual([p.name for p in self.bake.iterdir()], ["notes.obj"])
        np.testing.assert_array_equal(points(obj, 5), start)
        other.unlink()
        bpy.ops.muslin.bake()
        bpy.ops.muslin.free()
        self.assertFalse((self.folder / "muslin_work").exists())

    def test_reopened_without_the_add_on_it_plays(self):
        obj = cloth(grid())
        bpy.ops.muslin.bake()
        self.save()
        shown = {f: points(obj, f) for f in (1, 3, 6)}
        moved = self.folder.parent / (self.folder.name + ".moved")
        self.addCleanup(host.shutil.rmtree, moved, True)
        host.shutil.copytree(self.folder, moved)
        script = moved / "look.py"
        script.write_text("import bpy, numpy as np\nassert not hasattr(bpy.types.Object, 'muslin')\n"
                          "out = {}\nfor f in (1, 3, 6):\n    bpy.context.scene.frame_set(f)\n"
                          "    m = bpy.data.objects['Cloth'].evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()\n"
                          "    out[str(f)] = np.array([v.co for v in m.vertices])\nnp.savez('look.npz', **out)\n")
        subprocess.run([*other_blender(), str(moved / "work.blend"), "--python", str(script)], cwd=moved, check=True,
                       capture_output=True)
        with np.load(moved / "look.npz") as seen:
            for frame, there in shown.items():
                self.assertLess(np.abs(seen[str(frame)] - there).max(), 1e-6)

    def test_a_file_saved_before_its_bake_plays_it(self):
        obj = cloth(grid())
        self.save()
        bpy.ops.muslin.bake()
        shown = points(obj, 5)
        bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)  # without saving
        self.assertEqual(session().state.phase, self.events().Phase.DONE)
        np.testing.assert_array_equal(points(bpy.data.objects["Cloth"], 5), shown)

    def test_save_as_another_name_plays_the_old_bake_and_makes_its_own(self):
        bs = self.events()
        obj = cloth(grid())
        bpy.ops.muslin.bake()
        shown = points(obj, 5)
        self.save("second.blend")
        bpy.ops.wm.open_mainfile(filepath=str(self.folder / "second.blend"))
        obj = bpy.data.objects["Cloth"]
        np.testing.assert_array_equal(points(obj, 5), shown)
        self.assertEqual(session().state.phase, bs.Phase.DONE)
        self.assertEqual(session().folder, self.bake)
        bpy.ops.muslin.bake()
        self.assertEqual(session().folder, self.folder / "muslin_second" / "Scene")
        bpy.ops.muslin.free()
        self.assertTrue((self.bake / "Cloth.pc2").exists(), "that of the first file stays")

    def test_two_scenes_of_a_file_have_a_bake_each(self):
        cloth(grid("First"))
        bpy.ops.muslin.bake()
        second = bpy.data.scenes.new("Second")
        second.frame_start, second.frame_end = 10, 13
        bpy.context.window.scene = second
        obj = cloth(grid("First"))
        bpy.ops.muslin.bake()
        self.assertTrue((self.folder / "muslin_work" / "Second" / (obj.name.replace(".", "_") + ".pc2")).exists())
        self.assertEqual(obj.modifiers["Muslin"].frame_start, 10)
        self.assertEqual(session().state.frame, 3)


class Bad(HostTest):
    """Errors are said where the artist looks, before anything is simulated."""

    def refuse(self, pattern):
        with self.assertRaisesRegex(RuntimeError, pattern):
            bpy.ops.muslin.bake()
        s = session()
        self.assertRegex(s.state.problem, pattern)
        self.assertFalse((self.bake / "run").exists())

    def test_an_unsaved_file(self):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        host.enable()
        cloth(grid())
        self.refuse("Save the file first")

    def test_no_cloth(self):
        self.refuse("No object of this scene is muslin cloth")

    def test_no_program(self):
        cloth(grid())
        host.enable(program="/nowhere/muslin")
        self.refuse("program muslin was not found")

    def test_a_mesh_without_faces(self):
        cloth(host.mesh_object("Points", [(0, 0, 0), (1, 0, 0)], []))
        self.refuse("Points.*no faces")

    def test_loose_vertices_and_faces_without_area(self):
        cloth(host.mesh_object("Loose", [(0, 0, 0), (0, 0, 1), (1, 0, 0), (5, 5, 5)], [(0, 1, 2)]))
        self.refuse("Loose: 1 vertex belongs to no face.*Delete Loose")
        bpy.data.objects.remove(bpy.data.objects["Loose"])
        cloth(host.mesh_object("Thin", [(0, 0, 0), (0, 0, 1), (1, 0, 0), (0, 0, 2), (0, 0, 3)], [(0, 1, 2), (1, 3, 4)]))
        self.refuse("Thin: 1 face has no area.*Degenerate")

    def test_pins_that_are_not_there(self):
        obj = cloth(grid())
        obj.muslin.pin_group = "nobody"
        self.refuse("Cloth: there is no vertex group \"nobody\"")
        obj.vertex_groups.new(name="weak").add([0, 1], 0.4, "REPLACE")
        obj.muslin.pin_group = "weak"
        self.refuse("Cloth: No vertex of \"weak\" has a weight of 0.5")

    def test_a_scale_of_nothing(self):
        obj = cloth(grid())
        obj.scale.x = 0
        self.refuse("Cloth has a scale of 0 along an axis")

    def test_edit_mode_and_hidden(self):
        obj = cloth(grid())
        bpy.ops.object.mode_set(mode="EDIT")
        self.refuse("Cloth is in Edit Mode")
        bpy.ops.object.mode_set(mode="OBJECT")
        obj.hide_set(True)
        self.refuse("Cloth is hidden")

    def test_a_mesh_that_changes_over_time(self):
        obj = grid(pins=None)
        obj.vertex_groups.new(name="pins").add([0, 1, 9, 10], 1.0, "REPLACE")  # they are built first
        build = obj.modifiers.new("Build", "BUILD")
        build.frame_start, build.frame_duration = -20, 40
        cloth(obj)
        self.refuse("in frame 1 and .* in frame 2: a modifier that changes the mesh must stand below Muslin")

    def test_a_fabric_that_does_not_exist(self):
        cloth(grid(), fabric="coton")
        self.refuse("cotton")

    def test_a_folder_that_cannot_be_written(self):
        cloth(grid())
        (self.folder / "muslin_work").write_text("a file in the way")
        self.refuse("choose a folder that can be written")

    def test_what_is_allowed_is_only_mentioned(self):
        obj = grid()
        obj.scale = (1, 1, 2)
        cloth(obj)
        bpy.ops.muslin.check()
        s = session()
        self.assertEqual(s.state.phase, host.module("bake_state").Phase.EMPTY)
        self.assertTrue(any("not applied" in n.text for n in s.notices))
        self.assertFalse(any(n.level == "ERROR" for n in s.notices))
        self.assertEqual(s.counts["Cloth"]["vertices"], 81)
        self.assertFalse((self.folder / "muslin_work").exists(), "a check leaves nothing behind")


def icosphere(radius=0.5):
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2, radius=radius)
    obj = bpy.context.object
    vertices, faces = [tuple(v.co) for v in obj.data.vertices], [tuple(p.vertices) for p in obj.data.polygons]
    bpy.data.objects.remove(obj)
    return vertices, faces


def other_blender():
    """A Blender of its own, without the add-on."""
    if bpy.app.binary_path:
        return [bpy.app.binary_path, "-b", "--factory-startup", "--python-exit-code", "3"]
    return [sys.executable, str(pathlib.Path(__file__).with_name("bpy_blender.py"))]


if __name__ == "__main__":
    host.main()
