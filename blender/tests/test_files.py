"""Axes, caches, scene files, advice and worker: all that needs no Blender. The scenes are read by the program."""

import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import tomllib
import types
import unittest
import unittest.mock

import numpy as np

from support import load

axes, point_cache, scene_text = load("axes"), load("point_cache"), load("scene_text")
advice, worker, fabrics, keys, maps = load("advice"), load("worker"), load("fabrics"), load("keys"), load("maps")

PROGRAM = os.environ.get("MUSLIN_PROGRAM", str(pathlib.Path(__file__).parents[2] / "build" / "release" / "muslin"))


class Keys(unittest.TestCase):
    def test_the_add_on_has_the_declarations_of_the_program(self):
        printed = subprocess.run([PROGRAM, "schema"], check=True, capture_output=True, text=True).stdout
        shipped = (pathlib.Path(__file__).parents[1] / "muslin_cloth" / "scene_schema.json").read_text()
        self.assertTrue(shipped == printed, "write it anew: tools/write_schema build/release/muslin")

    def test_a_panel_gets_ranges_defaults_and_sentences(self):
        self.assertEqual(keys.limits("contact", "friction"), {"min": 0, "max": 100})
        self.assertEqual(keys.limits("time", "steps_per_frame"), {"min": 1, "max": 1000000})
        self.assertEqual(keys.default("contact", "friction"), 0.3)
        self.assertEqual(keys.sentence("body", "thickness", model="shell"), "Thickness in contact [m]")
        self.assertEqual(keys.sentence("force", "air_density"), "Density of the air [kg/m³]")
        self.assertEqual(keys.meaning("body", "model", "shell"), "The mesh itself as thin cloth")
        self.assertEqual(keys.meaning("solver", "effort", "draft"), "To see whether a scene works")
        with self.assertRaises(KeyError):
            keys.default("contact", "frictoin")

    def test_properties_of_the_panel_are_within_their_ranges(self):
        made = []

        def prop(**settings):
            made.append(settings)

        kinds = ("Bool", "Collection", "Enum", "Float", "Int", "Pointer", "String")
        bpy = types.ModuleType("bpy")
        bpy.types = types.SimpleNamespace(PropertyGroup=object, Object=object)
        bpy.props = types.ModuleType("bpy.props")
        for kind in kinds:
            setattr(bpy.props, f"{kind}Property", prop)
        with unittest.mock.patch.dict(sys.modules, {"bpy": bpy, "bpy.props": bpy.props}):
            load("properties")
        self.assertGreater(len(made), 20)
        for settings in made:
            if "min" in settings and "default" in settings:
                self.assertLessEqual(settings["min"], settings["default"], settings)
            if "max" in settings:
                self.assertLessEqual(settings["default"], settings["max"], settings)


class Scratch(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory(prefix="muslin.")
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)


class Axes(unittest.TestCase):
    def test_up_is_up_and_right_stays_right_handed(self):
        np.testing.assert_array_equal(axes.turned([0, 0, 1]), [0, 1, 0])
        np.testing.assert_array_equal(axes.turned([1, 0, 0]), [1, 0, 0])
        self.assertEqual(np.linalg.det(axes.TURN), 1)
        v = np.random.default_rng(1).normal(size=(5, 3))
        np.testing.assert_allclose(axes.turned(v, 2), 2 * v @ axes.TURN.T)

    def test_there_and_back(self):
        rng = np.random.default_rng(2)
        for _ in range(20):
            matrix = np.eye(4)
            matrix[:3] = rng.normal(size=(3, 4))
            local = rng.normal(size=(7, 3))
            back = axes.to_local(axes.to_muslin(local, matrix, 0.01), matrix, 0.01)
            np.testing.assert_allclose(back, local, atol=1e-9)

    def test_without_a_transform_nothing_is_rounded(self):
        local = np.random.default_rng(3).normal(size=(50, 3)).astype(np.float32)
        there = axes.to_muslin(local, np.eye(4), 1.0).astype(np.float32)
        np.testing.assert_array_equal(axes.to_local(there, np.eye(4), 1.0).astype(np.float32), local)


class PointCache(Scratch):
    def test_grows_and_is_cut(self):
        path = self.folder / "a.pc2"
        samples = np.random.default_rng(4).normal(size=(5, 3, 3)).astype(np.float32)
        out = point_cache.Writer(path, 3)
        for i, sample in enumerate(samples):
            out.append(sample)
            out.flush()
            self.assertEqual(point_cache.Reader(path).samples(), i + 1)
        out.cut(4)
        out.close()
        self.assertEqual(path.stat().st_size, 32 + 4 * 36)
        out = point_cache.Writer(path, 3, keep=2)
        out.append(samples[4])
        out.close()
        reader = point_cache.Reader(path)
        self.assertEqual((reader.points, reader.samples()), (3, 3))
        for sample, want in zip(range(3), samples[[0, 1, 4]]):
            np.testing.assert_array_equal(reader.read(sample), want)

    def test_a_promise_without_data_is_not_a_sample(self):
        path = self.folder / "a.pc2"
        out = point_cache.Writer(path, 2)
        out.append(np.zeros((2, 3)))
        out.append(np.ones((2, 3)))
        out.close()
        with open(path, "r+b") as file:
            file.truncate(32 + 24 + 23)
        self.assertEqual(point_cache.Reader(path).samples(), 1)
        with self.assertRaises(ValueError):
            point_cache.Reader(path).read(1)

    def test_refuses_what_is_no_cache(self):
        for content in (b"", b"POINTCACHE2", b"x" * 40):
            (self.folder / "bad.pc2").write_bytes(content)
            with self.assertRaises(ValueError):
                point_cache.Reader(self.folder / "bad.pc2")
        out = point_cache.Writer(self.folder / "a.pc2", 2)
        self.addCleanup(out.close)
        with self.assertRaises(ValueError):
            out.append(np.zeros((3, 3)))


class SceneText(Scratch):
    def square(self, name, height=1, **words):
        points = [(x, height, z) for x, z in ((0, 0), (1, 0), (1, 1), (0, 1))]
        text = scene_text.obj_text(points, [0, 1, 2, 3], [4], **words)
        (self.folder / f"{name}.obj").write_text(text)

    def scene(self):
        return scene_text.SceneInput(
            title='A "quoted" title\n', frames=12, frame_rate=23.976, steps_per_frame=3, gravity=[(0, -9.81, 0)],
            wind=scene_text.Wind([(1, 0, 0), (2, 0, 0)], gust=0.5, gust_length=2, seed=7),
            cloths=[scene_text.Cloth("a b", "shell", "cotton", pinned=True, pin="a b.pc2", rest_mesh="a b.obj"),
                    scene_text.Cloth("solid", "lattice", "rubber", thickness=0.2, voxel_width=0.2,
                                     separate_parts=True, pinned=True,
                                     release=0.25, pin_stiffness=40, self_contact=False)])

    def check(self, scene, moving=False):
        self.square("a b", uvs=[(0, 0), (1, 0), (1, 1), (0, 1)], groups={"pinned": [0, 1]})
        self.square("solid", height=3, groups={"pinned": [2]})
        (self.folder / "scene.toml").write_text(scene_text.scene_toml(scene, moving))
        return worker.ask(PROGRAM, "check", "--json", str(self.folder / "scene.toml"))

    def test_the_program_reads_it(self):
        scene = self.scene()
        scene.cloths[0].friction, scene.cloths[0].stretch_limit = 0.18, 1.05
        writer = point_cache.Writer(self.folder / "a b.pc2", 4)
        writer.append(np.zeros((4, 3)))
        writer.close()
        for moving in (False, True):
            code, out, err = self.check(scene, moving)
            self.assertEqual((code, err), (0, ""))
            told = json.loads(out)
            self.assertEqual([b["name"] for b in told["bodies"]], ["a b", "solid"])
            self.assertEqual([b["model"] for b in told["bodies"]], ["shell", "lattice"])
            self.assertEqual([b.get("stretch_limit") for b in told["bodies"]], [1.05, None])
            self.assertEqual(told["time"]["frames"], 12)
            self.assertEqual([p["name"] for p in told["pins"]], ["pins of a b", "pins of solid"])
            self.assertEqual(told["pins"][0]["vertices"], 2)
            self.assertEqual([f["type"] for f in told["forces"]], ["gravity", "wind"])

    def test_the_program_reads_fields(self):
        scene = self.scene()
        falloff = {"power": 2.0, "min": 0.5, "length": 1.0, "max": 9.0}
        scene.fields = [
            scene_text.Field("radial", [3, 4], "acceleration", (0, -1, 0), falloff),
            scene_text.Field("vortex", [2, 2], "wind", vectors={"axis": (0, 0, 1)}, numbers={"radius": 1.0}),
            scene_text.Field("uniform", [2], "wind", vectors={"direction": (0, 0, 1)}),
            scene_text.Field("turbulence", [1], "wind", numbers={"largest": 0.5, "seed": 3}),
            scene_text.Field("drag", [], numbers={"linear": 0.5, "quadratic": 0.0})]
        code, out, err = self.check(scene)
        self.assertEqual((code, err), (0, ""))
        self.assertEqual([f["type"] for f in json.loads(out)["forces"]][2:], [f.type for f in scene.fields])
        told = tomllib.loads(scene_text.scene_toml(scene))["force"][2:]
        self.assertEqual(told[0]["falloff"], falloff)
        self.assertEqual([k["value"] for k in told[0]["strength"]["keyframes"]], [3, 4])
        self.assertEqual((told[1]["strength"], told[1]["axis"], told[3]["seed"]), (2, [0, 0, 1], 3))
        scene.air_density = 0  # a vacuum has no air to move
        told = tomllib.loads(scene_text.scene_toml(scene))["force"][1:]
        self.assertEqual([f["type"] for f in told], ["radial", "drag"])

    def test_the_program_reads_attachments(self):
        scene = self.scene()
        scene.cloths[0].pinned = False
        scene.cloths[0].attachments = [scene_text.Attachment(
            "attachment 1 of a b", "pinned", "solid", "cord", scene_text.Painted(maps.map_file("a b", "attached1"), 0, 1),
            40, 2, 15, 0.25, 0.5), scene_text.Attachment("attachment 2 of a b", "pinned", "floor")]
        scene.colliders = [scene_text.Collider("floor")]
        self.square("floor", height=-1)
        (self.folder / maps.map_file("a b", "attached1")).write_text(maps.weights_text([0.5, 0, 1, 1]))
        for contact in (True, False):
            scene.contact = contact
            code, out, err = self.check(scene)
            self.assertEqual((code, err), (0, ""))
            self.assertEqual([a["joints"] for a in json.loads(out)["attachments"]], [1, 2], "one vertex has no weight")

    def test_the_program_reads_maps_sliders_and_keys(self):
        fabrics.program = PROGRAM
        scene = self.scene()
        cloth, solid = scene.cloths
        cloth.numbers, cloth.own_numbers = maps.adjusted(
            "a b", "shell", "cotton", {"weight": 2, "damping": 1}, [("bending", 1, 100), ("shrink", 1, 0.8)])
        solid.numbers, _ = maps.adjusted("solid", "lattice", "rubber", {"stiffness": 0.5}, [])
        cloth.pin_stiffness, cloth.pin_weight = 30, scene_text.Painted(maps.map_file("a b", "pins"), 0, 1)
        cloth.layer, scene.distance, scene.tangled = 2, 0.004, "refuse"
        scene.colliders = [scene_text.Collider("floor", layer=0)]
        self.square("floor", height=-1)
        scene.gravity = [(0, -9.81, 0), (0, 0, 0)]
        for what in ("bending", "shrink", "pins"):
            (self.folder / maps.map_file("a b", what)).write_text(maps.weights_text([0, 0.25, 0.5, 1]))
        code, out, err = self.check(scene)
        self.assertEqual((code, err), (0, ""))
        told = json.loads(out)["bodies"][0]
        self.assertAlmostEqual(told["mass"], 2 * 0.1503, places=6)
        varied = {m["key"]: m for m in told["maps"]}
        base = fabrics.numbers("cotton", "shell")
        self.assertLessEqual({"bending_warp", "bending_weft", "bending_bias", "rest_scale_warp"}, set(varied))
        self.assertAlmostEqual(varied["bending_warp"]["max"] / base["bending_warp"], 100)
        told = tomllib.loads(scene_text.scene_toml(scene))
        self.assertEqual(told["force"][0]["keyframes"][1], {"time": 1 / 23.976, "value": [0, 0, 0]})
        self.assertEqual((told["body"][0]["layer"], told["collider"][0]["layer"]), (2, 0))
        self.assertEqual(told["contact"], {"friction": 0.3, "tangled": "refuse", "distance": 0.004})

    def test_it_says_what_was_asked(self):
        scene = self.scene()
        told = tomllib.loads(scene_text.scene_toml(scene))
        self.assertEqual(told["title"], 'A "quoted" title\n')
        self.assertEqual(told["pin"][0]["sequence"], "a b.pc2")
        self.assertEqual(told["pin"][1]["until"], 0.25)
        self.assertEqual(told["force"][1]["keyframes"][1], {"time": 1 / 23.976, "value": [2, 0, 0]})
        self.assertEqual(told["force"][1]["gust"], 0.5)
        scene.wind = scene_text.Wind([(3, 0, 0)] * 5)
        self.assertEqual(tomllib.loads(scene_text.scene_toml(scene))["force"][1]["velocity"], [3, 0, 0])
        self.assertEqual(told["contact"], {"friction": 0.3, "tangled": "repair"})
        self.assertEqual(told["time"]["steps_per_frame"], 3)
        self.assertEqual(told["solver"], {"effort": "normal"})
        scene.steps_per_frame, scene.effort = None, "exact"
        other = tomllib.loads(scene_text.scene_toml(scene))
        self.assertEqual((other["time"]["steps_per_frame"], other["solver"]["effort"]), ("auto", "exact"))
        self.assertEqual([b.get("self_contact", True) for b in told["body"]], [True, False])
        scene.colliders = [scene_text.Collider("ball"), scene_text.Collider("arm", "arm.pc2")]
        colliders = tomllib.loads(scene_text.scene_toml(scene))["collider"]
        self.assertEqual(colliders[0], {"name": "ball", "shape": "mesh", "mesh": "ball.obj"})
        self.assertEqual(colliders[1]["sequence"], "arm.pc2")
        self.assertFalse([b for b in told["body"] if "stretch_limit" in b])
        scene.cloths[0].friction, scene.colliders[1].friction = 0.0, 0.18
        scene.cloths[0].stretch_limit = 1.05
        told = tomllib.loads(scene_text.scene_toml(scene))
        self.assertEqual([b.get("friction") for b in told["body"]], [0, None])
        self.assertEqual([b.get("stretch_limit") for b in told["body"]], [1.05, None])
        self.assertEqual([c.get("friction") for c in told["collider"]], [None, 0.18])
        scene.contact = False
        told = tomllib.loads(scene_text.scene_toml(scene))
        self.assertNotIn("contact", told)
        self.assertEqual([c["contact"] for c in told["collider"]], [False] * len(scene.colliders))
        self.assertEqual([b["contact"] for b in told["body"]], [False, False])
        scene.wind, scene.air_density, scene.gravity = None, 0, [(0, 0, 0)] * 2
        self.assertNotIn("force", tomllib.loads(scene_text.scene_toml(scene)))

    def test_a_mesh_keeps_its_order_and_can_be_turned_around(self):
        self.square("f", flip=True)
        self.assertIn("f 4 3 2 1", (self.folder / "f.obj").read_text())
        self.square("g", uvs=[(0, 0), (1, 0), (1, 1), (0, 1)])
        self.assertIn("f 1/1 2/2 3/3 4/4", (self.folder / "g.obj").read_text())

    def test_names_fit_files_and_differ(self):
        names = scene_text.body_names(["Cloth", "cloth", "a/b", "a:b", "..", "é.001", "x" * 200])
        self.assertEqual(len({n.lower() for n in names}), 7)
        for name in names:
            self.assertRegex(name, r"^[\w-]{1,64}$")


class Advice(unittest.TestCase):
    def report(self, **changes):
        return dict({"faces": 10, "non_manifold_edges": 0, "degenerate_faces": 0, "duplicate_faces": 0,
                     "unused_vertices": 0, "flipped_edges": 0, "closed": False, "open_edges": 4, "min": [0, 0, 0],
                     "max": [1, 1, 0], "near_border_vertices": 0, "near_border_distance": 0}, **changes)

    def levels(self, model="shell", **changes):
        return [n.level for n in advice.of_report(self.report(**changes), model, "Cloth")]

    def test_a_good_cloth_needs_none(self):
        self.assertEqual(self.levels(), [])

    def test_each_fault_is_said_and_stops_a_shell_only(self):
        for fault in ("degenerate_faces", "duplicate_faces", "unused_vertices"):
            self.assertEqual(self.levels(**{fault: 2}), [advice.ERROR], fault)
            self.assertIn(advice.WARNING, self.levels("lattice", **{fault: 2}), fault)
            self.assertNotIn(advice.ERROR, self.levels("lattice", **{fault: 2}), fault)
        self.assertEqual(self.levels(flipped_edges=1), [advice.WARNING])
        self.assertEqual(self.levels(non_manifold_edges=1), [])
        self.assertIn(advice.WARNING, self.levels("lattice", non_manifold_edges=1))
        self.assertEqual(self.levels(near_border_vertices=42, near_border_distance=1.5e-5), [advice.WARNING])
        self.assertEqual(self.levels(max=[80, 1, 0]), [advice.WARNING])
        self.assertEqual(self.levels(faces=0), [advice.ERROR])
        self.assertEqual(self.levels(max=[1000, 1, 0]), [advice.WARNING])

    def test_grammar_of_one(self):
        said = advice.of_report(self.report(unused_vertices=1), "shell", "Cloth")[0].text
        self.assertTrue(said.startswith("1 vertex belongs"))

    def test_the_error_among_what_the_program_prints(self):
        log = "muslin: warning: thin\n 40 %  frame 4\nmuslin: a.toml:3:1: no; do\nmuslin: resumed with force\n"
        self.assertEqual(advice.problem_line(log), "a.toml:3:1: no; do")
        self.assertEqual(advice.split_problem("no; or; do"), ("no; or", "do"))
        self.assertEqual(advice.problem_line(""), "")

    def test_the_suggested_width_gives_about_as_many_voxels_as_promised(self):
        cube = (6.0, 1.0, True, 0.0)
        sheet = (2.0, 0.0, False, 0.0)
        thick = (2.0, 0.0, False, 0.1)
        for shape in (cube, sheet, thick):
            width = advice.suggest_width(*shape)
            self.assertAlmostEqual(advice.estimate_voxels(*shape, width) / 8000, 1, delta=0.2)
        self.assertEqual(advice.suggest_width(0, 0, False, 0), 0)


class Estimates(Scratch):
    def test_estimates_against_the_program(self):
        """A cube and a ball of 0.1 m voxels: within a fifth of what is built."""
        n = 12
        grid = [(i, j) for j in range(n) for i in range(2 * n)]
        points = [(np.sin(t) * np.cos(p), np.cos(t), np.sin(t) * np.sin(p))
                  for t in (np.pi * (j + 0.5) / n for j in range(n)) for p in (np.pi * i / n for i in range(2 * n))]
        points += [(0, 1, 0), (0, -1, 0)]
        at = lambda i, j: j * 2 * n + i % (2 * n)
        faces = [(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)) for i, j in grid if j < n - 1]
        faces += [(2 * n * n, at(i + 1, 0), at(i, 0)) for i in range(2 * n)]
        faces += [(2 * n * n + 1, at(i, n - 1), at(i + 1, n - 1)) for i in range(2 * n)]
        text = scene_text.obj_text(points, [v for f in faces for v in f], [len(f) for f in faces])
        (self.folder / "ball.obj").write_text(text)
        scene = scene_text.SceneInput("ball", 1, 24, 1, cloths=[scene_text.Cloth("ball", "lattice", "rubber",
                                                                                 voxel_width=0.1)])
        (self.folder / "scene.toml").write_text(scene_text.scene_toml(scene))
        code, out, err = worker.ask(PROGRAM, "check", "--json", str(self.folder / "scene.toml"))
        self.assertEqual(code, 0, err)
        built = json.loads(out)["bodies"][0]["voxels"]
        estimate = advice.estimate_voxels(4 * np.pi, 4 / 3 * np.pi, True, 0, 0.1)
        self.assertAlmostEqual(estimate / built, 1, delta=0.2)


class Maps(unittest.TestCase):
    def setUp(self):
        fabrics.program = PROGRAM

    def test_sliders_multiply_numbers_and_curves(self):
        base = fabrics.numbers("cotton", "shell")
        self.assertEqual(maps.adjusted("c", "shell", "cotton", {"weight": 1, "bending": 1}, []), ({}, {}))
        numbers, own = maps.adjusted("c", "shell", "cotton", {"stiffness": 3, "damping": 0.5}, [])
        self.assertEqual(own, {})
        for key, factor in (("membrane_warp", 3), ("membrane_shear", 3), ("stiffness_damping", 0.5)):
            self.assertEqual(numbers[key], factor * base[key])
        self.assertFalse({"areal_density", "bending_warp", "stretch_limit"} & set(numbers))
        curve = fabrics.numbers("11oz_black_denim", "shell")["warp_curve"]
        numbers, _ = maps.adjusted("c", "shell", "11oz_black_denim", {"stiffness": 2}, [])
        self.assertEqual(numbers["warp_curve"], [[x, 2 * y] for x, y in curve])

    def test_a_map_of_a_slider_is_their_product(self):
        numbers, _ = maps.adjusted("c", "shell", "cotton", {"weight": 3}, [("weight", 1, 2)])
        base = fabrics.numbers("cotton", "shell")["areal_density"]
        self.assertEqual(numbers, {"areal_density": scene_text.Painted("c.weight.csv", 3 * base, 2 * 3 * base)})

    def test_what_does_not_fit_is_refused_with_a_remedy(self):
        for model, fabric, factors, varied, words in (
                ("shell", "cotton", {}, [("weight", 1, 2), ("weight", 1, 3)], "Two maps vary the weight"),
                ("shell", "/a/mill.toml", {"weight": 2}, [], "set its sliders to 1"),
                ("shell", "11oz_black_denim", {}, [("bending", 1, 2)], "measured curves.*choose another fabric"),
                ("lattice", "rubber", {}, [("bending", 1, 2)], "has no bending"),
                ("lattice", "rubber", {}, [("shrink", 1, 2)], "Only cloth shrinks")):
            with self.assertRaisesRegex(maps.Refused, words):
                maps.adjusted("c", model, fabric, factors, varied)
        maps.adjusted("c", "shell", "/a/mill.toml", {"weight": 1}, [("shrink", 1, 0.9)])  # needs no numbers

    def test_warnings_of_a_run_name_objects_and_frames_of_the_scene(self):
        names = {"shirt_2": "Shirt.002"}
        found = advice.warnings_of(
            ["body shirt_2: a triangle was long, beyond its `stretch_limit` of 1.05, at the end of frames 3 to 5, 8 and 10",
             "up to 4 of their vertices in frame 0", "said before"], names, {"said before"}, first_frame=100)
        self.assertEqual([(n.level, n.object) for n in found], [("WARNING", "Shirt.002"), ("WARNING", "")])
        self.assertEqual(found[0].text, "A triangle was long, beyond its Stretch Limit of 1.05, at the end of frames 103 to "
                                        "105, 108 and 110")
        self.assertEqual(found[1].text, "Up to 4 of their vertices in frame 100")


class Package(Scratch):
    def test_the_zip_holds_the_add_on_and_is_the_same_each_time(self):
        import subprocess
        import sys
        import zipfile
        script = pathlib.Path(__file__).parents[1] / "package"
        made = []
        for name in ("a", "b"):
            told = subprocess.run([sys.executable, script, "-o", self.folder / name, "--program", PROGRAM], check=True,
                                  capture_output=True, text=True)
            made.append(pathlib.Path(told.stdout.strip()))
        self.assertRegex(made[0].name, r"^muslin-blender-\d+\.\d+\.\d+\.zip$")
        self.assertEqual(made[0].read_bytes(), made[1].read_bytes())
        with zipfile.ZipFile(made[0]) as inside:
            names = set(inside.namelist())
            modes = {i.filename: i.external_attr >> 16 & 0o777 for i in inside.infolist()}
        sources = {f"muslin_cloth/{p.name}" for p in (script.parent / "muslin_cloth").glob("*.py")}
        self.assertLessEqual(sources | {"muslin_cloth/blender_manifest.toml", "muslin_cloth/LICENSE"}, names)
        self.assertEqual(modes["muslin_cloth/bin/muslin"], 0o755)


class Workers(Scratch):
    def script(self, text):
        path = self.folder / "program"
        path.write_text("#!/bin/sh\n" + text)
        path.chmod(0o755)
        return str(path)

    def wait(self, condition):
        end = time.monotonic() + 20
        while not condition():
            self.assertLess(time.monotonic(), end)
            time.sleep(0.01)

    def test_how_a_worker_ends(self):
        for text, code in (("exit 0", 0), ("exit 4", 4), ("kill -9 $$", -9)):
            work = worker.Worker(self.script("echo muslin: said >&2\n" + text), [], self.folder / "log")
            self.wait(lambda: work.ended() is not None)
            self.assertEqual(work.ended(), code)
            self.assertIn("muslin: said", work.problem())
            work.interrupt(), work.kill()  # too late, and no harm

    def test_questions_are_asked_in_turn_and_can_be_dropped(self):
        program = self.script("echo $1; echo e$1 >&2; exit $1")
        question = worker.Question(program, [["0"], ["3"]])
        self.wait(question.done)
        self.assertEqual(question.answers, [(0, "0\n", "e0\n"), (3, "3\n", "e3\n")])
        question = worker.Question(self.script("exec sleep 60"), [["1"], ["2"]])
        question.cancel()
        self.wait(question.done)
        self.assertLessEqual(len(question.answers), 1)
        question = worker.Question(str(self.folder / "none"), [[]])
        self.wait(question.done)
        self.assertIn("none", question.error)

    def test_the_lock_tells_whether_a_run_is_written(self):
        (self.folder / "checkpoint").mkdir()
        self.assertFalse(worker.is_locked(self.folder))
        lock = self.folder / "checkpoint" / "lock"
        lock.touch()
        self.assertFalse(worker.is_locked(self.folder))
        import fcntl
        with open(lock, "rb") as held:
            fcntl.flock(held, fcntl.LOCK_EX)
            self.assertTrue(worker.is_locked(self.folder))
            self.assertIsNone(worker.Orphan(self.folder, os.getpid(), "").ended())
        for status, code in (("finished", 0), ("interrupted", 130), ("failed", 4), ("running", -signal.SIGTERM)):
            (self.folder / "run.json").write_text(json.dumps({"status": status}))
            self.assertEqual(worker.Orphan(self.folder, 0, "").ended(), code)

    def test_which_program(self):
        mine = self.script("exit 0")
        self.assertEqual(worker.find_program(mine), mine)
        self.assertEqual(worker.find_program("/nowhere/muslin"), "", "a wrong preference is not passed over")
        with unittest.mock.patch.object(worker, "__file__", str(self.folder / "worker.py")):
            bundled = self.folder / "bin" / worker.PROGRAM
            bundled.parent.mkdir()
            bundled.write_text("#!/bin/sh\n")
            bundled.chmod(0o644)  # as installers of Blender unpack it
            self.assertEqual(worker.find_program(), str(bundled))
            self.assertTrue(os.access(bundled, os.X_OK))
        fabrics.program = PROGRAM
        self.assertIn("cotton", fabrics.names("shell"))
        self.assertIn("rubber", fabrics.names("lattice"))
        self.assertTrue(fabrics.description("cotton"))

    def test_guesses_of_a_fabric_are_told_for_its_model(self):
        fabrics.program = PROGRAM
        self.assertIn("bending warp", fabrics.guesses("cotton", "shell"))
        self.assertNotIn("diagonal", fabrics.guesses("cotton", "shell"))
        self.assertTrue(fabrics.guesses("steel", "lattice").startswith("Guesses, not measured: stiffness damping"))
        self.assertEqual(fabrics.guesses("thesis_flag", "lattice"), "")
        self.assertEqual(fabrics.guesses("no such fabric", "shell"), "")


if __name__ == "__main__":
    unittest.main()
