"""Direction in a real Blender, without a window: sliders, painted maps, soft pins by weight, attachments, pressure and gravity
over time, layers, library overrides, and what a bake says at its end."""

import json
import pathlib
import sys
import tomllib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import bpy
import numpy as np

import host
from host import HostTest, cloth, grid, points, session


class DirectionTest(HostTest):
    def written(self):
        return tomllib.loads((self.bake / "scene.toml").read_text(encoding="utf-8"))

    def run_json(self):
        return json.loads((self.bake / "run" / "run.json").read_text(encoding="utf-8"))

    def refuse(self, pattern):
        with self.assertRaisesRegex(RuntimeError, pattern):
            bpy.ops.muslin.bake()


def paint(obj, name, weight):
    """A vertex group with weight(x, y, z) at every vertex."""
    group = obj.vertex_groups.new(name=name)
    for v in obj.data.vertices:
        group.add([v.index], float(weight(*v.co)), "REPLACE")
    return name


class Fabrics(DirectionTest):
    def test_a_slider_scales_the_fabric(self):
        obj = cloth(grid())
        bpy.ops.muslin.check()
        mass = session().counts["Cloth"]["mass"]
        obj.muslin.weight_factor = 3
        bpy.ops.muslin.check()
        self.assertAlmostEqual(session().counts["Cloth"]["mass"], 3 * mass, places=6)

    def test_a_map_of_one_value_is_the_slider_bit_for_bit(self):
        obj = cloth(grid(), bending_factor=5)
        bpy.ops.muslin.bake()
        slid = (self.bake / "Cloth.pc2").read_bytes()
        obj.muslin.bending_factor = 1
        entry = obj.muslin.maps.add()
        entry.what, entry.group = "BENDING", paint(obj, "anything", lambda x, y, z: x + 0.5)
        entry.low = entry.high = 5
        bpy.ops.muslin.bake()
        self.assertEqual((self.bake / "Cloth.pc2").read_bytes(), slid)
        entry.high = 500
        bpy.ops.muslin.bake()
        self.assertNotEqual((self.bake / "Cloth.pc2").read_bytes(), slid)
        bpy.ops.muslin.free()
        self.assertFalse((self.folder / "muslin_work").exists(), "the files of maps go too")

    def test_painted_cloth_shrinks_where_it_is_painted(self):
        bpy.context.scene.use_gravity = False
        bpy.context.scene.frame_end = 20
        obj = cloth(grid(n=12))
        entry = obj.muslin.maps.add()
        entry.what, entry.group, entry.high = "SHRINK", paint(obj, "tight", lambda x, y, z: x > 0.01), 0.7
        bpy.ops.muslin.bake()
        columns = points(obj, 20).reshape(13, 13, 3)
        lengths = np.linalg.norm(np.diff(columns, axis=0), axis=2).sum(axis=0)  # of columns 1 m long, from left to right
        self.assertGreater(lengths[0], 0.9)
        np.testing.assert_allclose(lengths[-2:], 0.7, atol=0.05)

    def test_bad_maps_are_refused_by_name(self):
        obj = cloth(grid())
        entry = obj.muslin.maps.add()
        self.refuse("Cloth: a map has no vertex group")
        entry.group = "nobody"
        self.refuse("Cloth: there is no vertex group \"nobody\"")
        entry.group, entry.what = "pins", "BENDING"
        obj.muslin.fabric = "11oz_black_denim"
        self.refuse("Cloth: The bending of \"11oz_black_denim\" is measured curves")

    def test_operators_add_and_remove(self):
        obj = cloth(grid())
        bpy.ops.muslin.map_add()
        self.assertEqual([entry.group for entry in obj.muslin.maps], ["pins"])
        bpy.ops.muslin.map_remove(index=0)
        self.assertEqual(len(obj.muslin.maps), 0)


class Pins(DirectionTest):
    def test_soft_pins_hold_by_their_weight(self):
        bpy.context.scene.frame_end = 12
        obj = grid(pins=None)
        paint(obj, "pins", lambda x, y, z: (0.5 - x) if z > 1.4 else 0)
        cloth(obj, use_soft_pins=True, pin_stiffness=200, pin_group="pins")
        bpy.ops.muslin.bake()
        self.assertEqual(self.written()["pin"][0]["weight"], {"map": "Cloth.pins.csv", "from": 0, "to": 1})
        start, end = points(obj, 1), points(obj, 12)
        upper = start[:, 2] > 1.45
        drop = (start - end)[upper, 2]
        held, loose = drop[np.argmin(start[upper, 0])], drop[np.argmax(start[upper, 0])]
        self.assertLess(held, 0.25 * loose)

    def test_partial_weights_of_hard_pins_are_told(self):
        obj = grid()
        obj.vertex_groups["pins"].add([0, 1, 2], 0.3, "REPLACE")
        cloth(obj)
        bpy.ops.muslin.bake()
        self.assertTrue(any("3 vertices have weights between 0 and 1" in n.text for n in session().notices))


class Attachments(DirectionTest):
    """A sheet whose upper edge is attached to a bar."""

    def hung(self, group="top", weight=lambda x, y, z: z > 1.45, **settings):
        bpy.context.scene.frame_end = 12
        bar = host.mesh_object("Bar", [(-0.6, -0.02, 1.5), (0.6, -0.02, 1.5), (0.6, 0.02, 1.5), (-0.6, 0.02, 1.5)],
                               [(0, 1, 2, 3)])
        bpy.ops.muslin.collider_add()
        obj = cloth(grid(pins=None))
        paint(obj, group, weight)
        bpy.context.view_layer.objects.active = obj
        bpy.ops.muslin.attachment_add()
        entry = obj.muslin.attachments[0]
        self.assertEqual((entry.target, entry.group), (bar, group), "the only other muslin object is suggested")
        for name, value in settings.items():
            setattr(entry, name, value)
        return obj, bar, entry

    def edge(self, obj, frame):
        upper = points(obj, 1)[:, 2] > 1.45
        return points(obj, frame)[upper]

    def test_cloth_hangs_from_a_collider_and_follows_it(self):
        obj, bar, _ = self.hung()
        for frame, x in ((1, 0.0), (12, 0.1)):
            bar.location.x = x
            bar.keyframe_insert("location", frame=frame)
        bpy.context.scene.frame_set(1)
        bpy.ops.muslin.bake()
        self.assertLess(points(obj, 12)[:, 2].min(), points(obj, 1)[:, 2].min() + 0.01)
        np.testing.assert_allclose(self.edge(obj, 12), self.edge(obj, 1) + [0.1, 0, 0], atol=0.01)
        told = self.written()
        self.assertEqual(told["attachment"], [{"body": "Cloth", "name": "attachment 1 of Cloth", "to": "Bar",
                                               "where": {"group": "attached1"}, "rest": "joined"}])
        self.assertFalse(told["collider"][0]["contact"], "contact is off in this scene")

    def test_a_weight_is_a_map_and_stiffness_a_spring(self):
        obj, _, _ = self.hung(weight=lambda x, y, z: (0.5 - x) * (z > 1.45), use_stiffness=True, stiffness=100, damping=1)
        bpy.ops.muslin.bake()
        told = self.written()["attachment"][0]
        self.assertEqual(told["weight"], {"map": "Cloth.attached1.csv", "from": 0, "to": 1})
        self.assertEqual((told["stiffness"], told["damping"]), (100, 1))
        drop = (self.edge(obj, 1) - self.edge(obj, 12))[:, 2]
        self.assertLess(drop[0], 0.25 * drop[-1], "it holds by the weight")
        bpy.ops.muslin.free()
        self.assertFalse((self.folder / "muslin_work").exists(), "the files of weights go too")

    def test_it_begins_and_ends_in_frames_of_the_scene_and_breaks(self):
        obj, _, entry = self.hung(use_end=True, end_frame=6)
        bpy.ops.muslin.bake()
        np.testing.assert_allclose(self.edge(obj, 6), self.edge(obj, 1), atol=0.01)
        self.assertLess(self.edge(obj, 12)[:, 2].max(), 1.5 - 0.05, "it falls")
        entry.use_start, entry.start_frame = True, 6
        with self.assertRaisesRegex(RuntimeError, "ends in frame 6, before it begins"):
            bpy.ops.muslin.bake()
        entry.use_start = entry.use_end = False
        entry.use_break_force, entry.break_force = True, 0.01
        bpy.ops.muslin.bake()
        self.assertEqual(self.run_json()["attachments"][0]["holding"], 0)
        self.assertLess(self.edge(obj, 12)[:, 2].max(), 1.5 - 0.3)

    def test_it_may_change_from_the_current_frame(self):
        obj, _, entry = self.hung()
        bpy.ops.muslin.bake()
        bpy.context.scene.frame_set(6)
        entry.use_end, entry.end_frame = True, 7
        bpy.ops.muslin.bake_from_current()
        np.testing.assert_allclose(self.edge(obj, 6), self.edge(obj, 1), atol=0.01)
        self.assertLess(self.edge(obj, 12)[:, 2].max(), 1.5 - 0.05, "it falls")

    def test_two_cloths_are_sewn_together(self):
        first = grid("First")
        cloth(first)
        second = cloth(grid("Second", pins=None))
        second.location.z = -1.0
        paint(second, "seam", lambda x, y, z: z > 1.45)
        entry = second.muslin.attachments.add()
        entry.target, entry.group = first, "seam"
        bpy.ops.muslin.bake()
        seam = points(second, 6)[points(second, 1)[:, 2] > 0.45]
        hem = points(first, 6)[points(first, 1)[:, 2] < 0.55]
        self.assertLess(np.abs(seam - hem).max(), 0.01)

    def test_bad_attachments_are_refused_by_name(self):
        obj, bar, entry = self.hung()
        entry.group = "nobody"
        self.refuse("Cloth: There is no vertex group \"nobody\" to attach")
        entry.group = ""
        self.refuse("Cloth: An attachment has no vertex group")
        entry.group = paint(obj, "bare", lambda x, y, z: 0)
        self.refuse("No vertex of \"bare\" has a weight above 0")
        bar.muslin.role = "NONE"
        self.refuse("Cloth: It is attached to \"Bar\", which is neither muslin cloth nor a collider")
        entry.target = None
        self.refuse("Cloth: An attachment has no object")
        bpy.ops.muslin.attachment_remove(index=0)
        self.assertEqual(len(obj.muslin.attachments), 0)


class OverTime(DirectionTest):
    def test_pressure_and_gravity_are_keyed(self):
        scene = bpy.context.scene
        for frame, z in ((1, 0.0), (6, -9.8)):
            scene.gravity = (0, 0, z)
            scene.keyframe_insert("gravity", frame=frame)
        bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2, radius=0.2)
        ball = cloth(bpy.context.object, use_pressure=True)
        for frame, pressure in ((1, 0.0), (6, 50.0)):
            ball.muslin.pressure = pressure
            ball.keyframe_insert("muslin.pressure", frame=frame)
        scene.frame_set(1)
        bpy.ops.muslin.bake()
        told = self.written()
        pressures = [k["value"] for k in told["pressure"][0]["pressure"]["keyframes"]]
        self.assertEqual((len(pressures), pressures[0], pressures[-1]), (6, 0, 50))
        gravity = next(f for f in told["force"] if f["type"] == "gravity")["keyframes"]
        self.assertAlmostEqual(gravity[-1]["value"][1], -9.8, places=5)
        radius = lambda frame: np.linalg.norm(np.ptp(points(ball, frame), axis=0))
        self.assertGreater(radius(6), 1.001 * radius(1), "it is inflated")


class Outcome(DirectionTest):
    def test_what_is_held_back_is_told_in_frames_of_the_scene(self):
        """A pin that is animated through a collider."""
        scene = bpy.context.scene
        scene.muslin.use_contact, scene.frame_start, scene.frame_end = True, 101, 112
        wall = host.mesh_object("Wall", [(-2, 0.3, -1), (2, 0.3, -1), (2, 0.3, 3), (-2, 0.3, 3)], [(0, 1, 2, 3)])
        bpy.ops.muslin.collider_add()
        self.assertEqual(wall.muslin.role, "COLLIDER")
        obj = grid()
        for frame, y in ((101, 0.0), (112, 0.8)):
            obj.location.y = y
            obj.keyframe_insert("location", frame=frame)
        scene.frame_set(101)
        cloth(obj)
        bpy.ops.muslin.bake()
        held = self.run_json()["held_back"]["frames"]
        self.assertTrue(held)
        told = [n.text for n in session().notices if "could not follow" in n.text]
        self.assertEqual(len(told), 1)
        self.assertIn(str(held[0] + 101), told[0])
        self.assertIn("animation", told[0])
        bpy.ops.wm.save_mainfile()
        bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)
        self.assertTrue(any("could not follow" in n.text for n in session().notices), "it is told after reopening too")

    def test_a_tangled_start_is_refused_if_asked(self):
        scene = bpy.context.scene
        scene.muslin.use_contact, scene.muslin.tangled = True, "REFUSE"
        first = cloth(grid("First"), use_layer=True, layer=3)
        cloth(grid("Second")).rotation_euler = (0, 0, 1.5)
        self.refuse("\"First\".*\"Second\".*choose Repair under Tangled Start")
        bpy.context.view_layer.objects.active = first
        bpy.ops.muslin.select_crossing()
        bpy.ops.object.mode_set(mode="OBJECT")
        middle = [np.hypot(*p.center[:2]) < 0.15 for p in first.data.polygons]
        self.assertEqual([p.select for p in first.data.polygons], middle, "the other sheet stands across it in the middle")
        scene.muslin.tangled = "IGNORE"
        bpy.ops.muslin.bake()
        self.assertEqual(self.written()["contact"]["tangled"], "ignore")
        self.assertEqual(self.written()["body"][0]["layer"], first.muslin.layer)

    def test_an_end_before_the_start_is_refused(self):
        scene = bpy.context.scene
        scene.muslin.use_scene_range, scene.muslin.frame_start, scene.muslin.frame_end = False, 10, 5
        cloth(grid())
        self.refuse("ends in frame 5, before it begins in frame 10")

    def test_a_cloth_modifier_above_is_told(self):
        obj = grid()
        obj.modifiers.new("Cloth", "CLOTH")
        cloth(obj)
        bpy.ops.muslin.check()
        self.assertTrue(any("simulates this mesh too" in n.text for n in session().notices))


class Identity(DirectionTest):
    def test_a_new_object_with_an_old_name_does_not_play_the_bake(self):
        obj = cloth(grid())
        bpy.ops.muslin.bake()
        shown = points(obj, 5)
        obj.name = "Old"
        new = cloth(grid("Cloth"))
        bpy.ops.wm.save_mainfile()
        bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)
        np.testing.assert_array_equal(points(bpy.data.objects["Old"], 5), shown)
        self.assertEqual(bpy.data.objects["Cloth"].modifiers["Muslin"].filepath, "")

    def linked(self):
        """A cloth of another file, linked into a new one."""
        cloth(grid(), fabric="silk")
        self.save("library.blend")
        library = str(self.folder / "library.blend")
        bpy.ops.wm.read_factory_settings(use_empty=True)
        host.enable()
        bpy.context.scene.frame_end = 3
        with bpy.data.libraries.load(library, link=True) as (there, here):
            here.objects = ["Cloth"]
        bpy.context.scene.collection.objects.link(here.objects[0])
        bpy.context.view_layer.objects.active = here.objects[0]
        self.save("user.blend")
        return here.objects[0]

    def test_a_linked_cloth_is_refused(self):
        self.linked()
        self.refuse("Cloth is linked from another file.*Library Override")

    def test_an_override_keeps_its_settings_and_plays(self):
        obj = self.linked().override_create(remap_local_usages=True)
        bpy.context.view_layer.objects.active = obj
        self.assertEqual(obj.muslin.fabric, "silk")
        obj.muslin.fabric, obj.muslin.bending_factor = "denim", 2
        bpy.ops.muslin.cloth_add()
        bpy.ops.muslin.bake()
        shown = points(obj, 3)
        bpy.ops.wm.save_mainfile()
        bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)
        obj = next(o for o in bpy.data.objects if not o.library)
        self.assertEqual((obj.muslin.fabric, obj.muslin.bending_factor), ("denim", 2))
        np.testing.assert_array_equal(points(obj, 3), shown)


if __name__ == "__main__":
    host.main()
