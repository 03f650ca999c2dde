"""Writes the files that muslin reads from Blender's scene."""

import contextlib
import os
import pathlib
import time

import bpy
import numpy as np

from . import attachments, axes, maps, point_cache
from .advice import ERROR, INFO, WARNING, Notice, counted, suggest_width
from .force_fields import Fields, along_z, field_objects, fields_notices, has_falloff, unit_scale
from .playback import modifier_of
from .scene_text import Cloth, Collider, Painted, SceneInput, Wind, body_names, obj_text, scene_toml

PIN_WEIGHT = 0.5  # from which a vertex is held exactly
PINS = "pins"  # names the file of the weights of soft pins


class Problem(Exception):
    """A reason why a scene cannot be baked; the text names the object and the remedy."""


def cloth_objects(scene):
    return [o for o in scene.objects if o.type == "MESH" and o.muslin.role == "CLOTH"]


def collider_objects(scene):
    """All of them, or without contact those that cloth is attached to."""
    wanted = None if scene.muslin.use_contact else attachments.targets(scene)
    return [o for o in scene.objects
            if o.type == "MESH" and o.muslin.role == "COLLIDER" and (wanted is None or o in wanted)]


def own_friction(obj):
    """None if the scene's setting applies."""
    return obj.muslin.friction if obj.muslin.use_friction else None


def own_layer(obj):
    """None if it has no place in an order."""
    return obj.muslin.layer if obj.muslin.use_layer else None


def gravity_of(scene):
    """That of the current frame, (3,) in muslin's axes [m/s²]."""
    gravity = axes.turned(scene.gravity, unit_scale(scene)) if scene.use_gravity else np.zeros(3)
    return tuple(float(x) for x in gravity)


def pressure_of(obj):
    """That of the current frame [Pa]; 0: none."""
    m = obj.muslin
    return m.pressure if m.use_pressure and m.model == "SHELL" else 0.0


def frame_rate(scene):
    return scene.render.fps / scene.render.fps_base


def depsgraph_of(scene):
    context = bpy.context
    if context.scene == scene:
        return context.evaluated_depsgraph_get()
    return scene.view_layers[0].depsgraph


@contextlib.contextmanager
def below_the_cloth(objects):
    """The Muslin modifier and all that comes after it are off: what is evaluated is what the cloth is made of
    and what its pins follow."""
    switched = []
    for obj in objects:
        cache, after = modifier_of(obj), False
        for modifier in obj.modifiers:
            after = after or modifier == cache
            if after and modifier.show_viewport:
                switched.append((obj.name, modifier.name))
                modifier.show_viewport = False
    try:
        yield
    finally:
        for name, modifier in switched:
            obj = bpy.data.objects.get(name)
            if obj and modifier in obj.modifiers:
                obj.modifiers[modifier].show_viewport = True


class Snapshot:
    """A mesh as evaluated: arrays, in the object's own space."""

    def __init__(self, obj, depsgraph, topology=False, groups=()):
        evaluated = obj.evaluated_get(depsgraph)
        self.matrix = np.array(evaluated.matrix_world)
        keep = {"preserve_all_data_layers": True, "depsgraph": depsgraph} if topology else {}
        mesh = evaluated.to_mesh(**keep)
        try:
            count = len(mesh.vertices)
            points = np.empty(3 * count, np.float32)
            mesh.vertices.foreach_get("co", points)
            self.points = points.reshape(-1, 3).astype(float)
            if topology:
                self._read_topology(mesh, obj, groups)
        finally:
            evaluated.to_mesh_clear()

    def _read_topology(self, mesh, obj, groups):
        """`groups`: names of those whose weights are wanted, for pins, attachments and maps of the object."""
        self.corners = np.empty(len(mesh.loops), np.int32)
        mesh.loops.foreach_get("vertex_index", self.corners)
        self.sizes = np.empty(len(mesh.polygons), np.int32)
        mesh.polygons.foreach_get("loop_total", self.sizes)
        self.uvs = None
        if mesh.uv_layers.active and len(mesh.loops):
            uvs = np.empty(2 * len(mesh.loops), np.float32)
            mesh.uv_layers.active.data.foreach_get("uv", uvs)
            self.uvs = uvs.reshape(-1, 2)
        self.unwrapped = self.uvs is None or uv_areas(self.uvs, self.sizes).all()
        if not self.unwrapped:
            self.uvs = None  # threads need a direction on every polygon
        indices = {obj.vertex_groups[name].index: name for name in groups}
        self.weights = {name: np.zeros(len(mesh.vertices)) for name in groups}
        for vertex in mesh.vertices if indices else ():
            for entry in vertex.groups:
                if entry.group in indices:
                    self.weights[indices[entry.group]][vertex.index] = entry.weight
        pins = self.weights.get(obj.muslin.pin_group, np.zeros(0))
        self.pinned = np.flatnonzero(pins > 0 if obj.muslin.use_soft_pins else pins >= PIN_WEIGHT)
        self.attached = attachments.vertices(obj, self.weights) if groups else {}

    def world(self, scale):
        return axes.to_muslin(self.points, self.matrix, scale)

    def obj(self, scale, points=None):
        flip = np.linalg.det(self.matrix[:3, :3]) < 0
        return obj_text(self.world(scale) if points is None else points, self.corners, self.sizes, self.uvs,
                        {"pinned": self.pinned, **self.attached}, flip)


def uv_areas(uvs, sizes):
    """Returns for each polygon whether it has an area in the texture."""
    first = np.concatenate([[0], np.cumsum(sizes)[:-1]])
    following = np.arange(1, len(uvs) + 1)
    following[first + sizes - 1] = first
    a, b = uvs.astype(float), uvs[following].astype(float)
    areas = np.add.reduceat(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], first) / 2
    return np.abs(areas) > 1e-12


def groups_of(obj):
    """The names of the vertex groups that its pins, attachments and maps use. Raises Problem."""
    if obj.muslin.role != "CLOTH":
        return []
    names = []
    for entry in obj.muslin.maps:
        if not entry.group:
            raise Problem(f"{obj.name}: a map has no vertex group: choose one under Maps, or remove the map")
        if entry.group not in obj.vertex_groups:
            raise Problem(f"{obj.name}: there is no vertex group \"{entry.group}\": choose one under Maps")
        names.append(entry.group)
    pins = obj.muslin.pin_group
    if pins and pins not in obj.vertex_groups:
        raise Problem(f"{obj.name}: there is no vertex group \"{pins}\" to pin: choose one under Pins")
    names += [entry.group for entry in obj.muslin.attachments]
    return names + [pins] if pins else names


def require_ready(scene):
    """Makes the checks that need no evaluation. Raises Problem."""
    if not bpy.data.filepath:
        raise Problem("Save the file first: the bake is stored in a folder beside it")
    if not cloth_objects(scene):
        raise Problem("No object of this scene is muslin cloth: select a mesh and choose Muslin Cloth under Physics")
    first, last = scene.muslin.frames(scene)
    if last < first:
        raise Problem(f"The range ends in frame {last}, before it begins in frame {first}: set Start and End under Scene")
    for obj in cloth_objects(scene):
        if obj.library:
            raise Problem(f"{obj.name} is linked from another file and cannot play a bake: Object > Library Override > "
                          "Make, then bake")
    for obj in cloth_objects(scene) + collider_objects(scene):
        if obj.mode == "EDIT":
            raise Problem(f"{obj.name} is in Edit Mode: leave it with Tab, so that the mesh is up to date")
        if not obj.visible_get():
            raise Problem(f"{obj.name} is hidden, so Blender does not animate it: show it, or remove its muslin role")
    for obj in cloth_objects(scene):
        try:
            attachments.require_ready(obj, scene)
        except attachments.Refused as refused:
            raise Problem(f"{obj.name}: {refused}") from None
        groups_of(obj)


def snapshot(obj, depsgraph, topology=False):
    taken = Snapshot(obj, depsgraph, topology, groups_of(obj) if topology else ())
    if not np.isfinite(taken.matrix).all() or not np.isfinite(taken.points).all():
        raise Problem(f"{obj.name} has a coordinate that is not a number: check its transform, modifiers and drivers")
    if abs(np.linalg.det(taken.matrix[:3, :3])) < 1e-12 * max(np.abs(taken.matrix[:3, :3]).max(), 1e-30) ** 3:
        raise Problem(f"{obj.name} has a scale of 0 along an axis: give it a scale that is not 0")
    return taken


def notices_of(obj, taken):
    """Notices from data that only Blender has."""
    notices = []

    def say(level, text):
        notices.append(Notice(level, text, obj.name))

    group = obj.muslin.pin_group
    if group and not len(taken.pinned):
        least = "above 0" if obj.muslin.use_soft_pins else "of 0.5 or more"
        say(ERROR, f"No vertex of \"{group}\" has a weight {least}: paint it, or clear Pin Group")
    elif group and not obj.muslin.use_soft_pins:
        partial = int(np.count_nonzero((taken.weights[group] > 0) & (taken.weights[group] < 1)))
        if partial:
            n = counted(partial, "vertex has a weight", "vertices have weights")
            say(WARNING, f"{n} between 0 and 1 in \"{group}\": from 0.5 on they are held, below they are free. Soft, under "
                         "Pins, holds by the weight")
    notices += attachments.notices_of(obj, taken.weights)
    if obj.muslin.model == "SHELL" and not taken.unwrapped:
        say(INFO, "Some polygons have no area in the UV map, which gives the threads their direction: they run along the "
                  "longest side instead. UV > Unwrap lets you choose")
    scale = np.linalg.norm(taken.matrix[:3, :3], axis=0)
    if scale.max() > 1.0001 * scale.min():
        say(INFO, "The scale differs by axis and is not applied: it is baked as you see it in the world")
    cache = modifier_of(obj)
    for modifier in obj.modifiers:
        if modifier == cache:
            break
        if modifier.type in ("CLOTH", "SOFT_BODY") and modifier.show_viewport:
            say(WARNING, f"{modifier.name} above Muslin simulates this mesh too, and the cloth follows it: remove it")
        if modifier.type in ("SUBSURF", "MULTIRES") and modifier.levels != modifier.render_levels:
            say(WARNING, f"{modifier.name} above Muslin has other levels in renders: make them equal, or move it below")
    return notices


class Air:
    """Combines the wind and turbulence fields that are the same everywhere into one velocity of the air [m/s]."""

    def __init__(self, scene):
        self.velocities, self.gust, self.gust_length, self.seed = [], 0.0, 0.0, 1
        self._scene = scene

    def sample(self, depsgraph):
        scale = unit_scale(self._scene)
        velocity, square = np.zeros(3), 0.0
        for obj in field_objects(self._scene):
            evaluated = obj.evaluated_get(depsgraph)
            field = evaluated.field
            if field.type == "WIND":
                if not has_falloff(field):
                    velocity += field.strength * scale * along_z(evaluated)
                square += (field.noise * field.strength * scale) ** 2
                if field.noise:
                    self.gust_length = max(self.gust_length, 1.0)
                    self.seed = field.seed
            elif field.type == "TURBULENCE" and not has_falloff(field):
                square += (field.strength * scale) ** 2
                self.gust_length = max(self.gust_length, field.size * scale)
                self.seed = field.seed
        self.velocities.append(tuple(float(x) for x in axes.turned(velocity)))
        self.gust = max(self.gust, square**0.5)

    def wind(self):
        return Wind(self.velocities, self.gust, self.gust_length or 1.0, max(int(self.seed), 0))


def scene_input(scene, names, snapshots, first, last):
    """The scene as it stands at the first frame. `names`: object → body; `snapshots`: object → Snapshot."""
    props = scene.muslin
    scale, rate = unit_scale(scene), frame_rate(scene)
    result = SceneInput(title=f"{scene.name} of {os.path.basename(bpy.data.filepath)}", frames=last - first,
                        frame_rate=rate, steps_per_frame=props.steps(), gravity=[gravity_of(scene)],
                        air_density=props.air_density, contact=props.use_contact,
                        effort=props.effort.lower(), friction=props.friction,
                        distance=props.contact_distance * scale, tangled=props.tangled.lower())

    def seconds(frame):
        """Less than a step after the frame: in the frame itself things still hold."""
        return (max(frame - first, 0) + 0.5 / (props.steps() or 1000)) / rate

    for obj in cloth_objects(scene):
        m, name = obj.muslin, names[obj.name]
        cloth = Cloth(name=name, model=m.model.lower(), material=m.fabric, thickness=m.thickness * scale,
                      pinned=len(snapshots[obj.name].pinned) > 0, self_contact=m.use_self_contact,
                      friction=own_friction(obj), layer=own_layer(obj), pressures=[pressure_of(obj)])
        if m.fabric.endswith(".toml"):
            cloth.material = bpy.path.abspath(m.fabric)
        try:
            cloth.numbers, cloth.own_numbers = maps.adjusted(
                name, cloth.model, cloth.material,
                {"weight": m.weight_factor, "stiffness": m.stiffness_factor, "bending": m.bending_factor,
                 "damping": m.damping_factor}, [(x.what.lower(), x.low, x.high) for x in m.maps])
        except maps.Refused as refused:
            raise Problem(f"{obj.name}: {refused}") from None
        if m.model == "LATTICE":
            cloth.voxel_width = (m.voxel_width or suggestion(obj, snapshots[obj.name])) * scale
            cloth.separate_parts = m.separate_parts
        else:
            if m.rest_shape == "BASE":
                cloth.rest_mesh = name + ".rest.obj"
            if m.use_stretch_limit:
                cloth.stretch_limit = m.stretch_limit
        if m.use_soft_pins and cloth.pinned:
            cloth.pin_stiffness = m.pin_stiffness
            if snapshots[obj.name].weights[m.pin_group].min() < 1:
                cloth.pin_weight = Painted(maps.map_file(name, PINS), 0, 1)
        if m.use_release and cloth.pinned:
            cloth.release = seconds(m.release_frame)
        cloth.attachments = attachments.of_object(obj, names, snapshots[obj.name].weights, seconds)
        result.cloths.append(cloth)
    for obj in collider_objects(scene):
        result.colliders.append(Collider(names[obj.name], friction=own_friction(obj), layer=own_layer(obj)))
    return result


def measure(taken):
    """(area, volume, closed) of the mesh as it stands in the world, in scene units."""
    points = taken.points @ taken.matrix[:3, :3].T
    area = volume = 0.0
    edges = {}
    start = 0
    center = points.mean(0) if len(points) else 0
    for size in taken.sizes:
        ring = taken.corners[start:start + size]
        start += size
        p = points[ring] - center
        fan = np.cross(p[1:-1] - p[0], p[2:] - p[0])
        area += np.linalg.norm(fan.sum(0)) / 2
        volume += (fan @ p[0]).sum() / 6
        for a, b in zip(ring, np.roll(ring, -1)):
            key = (min(a, b), max(a, b))
            edges[key] = edges.get(key, 0) + 1
    closed = bool(edges) and all(n > 1 for n in edges.values())
    return area, abs(volume), closed


def suggestion(obj, taken):
    return suggest_width(*measure(taken), obj.muslin.thickness)


def base_points(obj):
    points = np.empty(3 * len(obj.data.vertices), np.float32)
    obj.data.vertices.foreach_get("co", points)
    return points.reshape(-1, 3).astype(float)


class Capture:
    """Samples a scene frame by frame into `folder`. step() until it is True, then commit(), or abandon()."""

    def __init__(self, scene, folder, first, last):
        require_ready(scene)
        self.scene_name, self.folder = scene.name, pathlib.Path(folder)
        self.first, self.last, self.frame = first, last, first
        self.scale = unit_scale(scene)
        objects = cloth_objects(scene) + collider_objects(scene)
        self.names = dict(zip((o.name for o in objects), body_names(o.name for o in objects)))
        self.cloths = [o.name for o in cloth_objects(scene)]
        self.matrices = {name: [] for name in self.cloths}
        self.snapshots, self.writers, self.moves = {}, {}, {}
        self.air, self.fields = Air(scene), Fields(scene)
        self.gravity, self.pressures = [], {name: [] for name in self.cloths}  # one a frame
        self.folder.mkdir(parents=True, exist_ok=True)

    def scene(self):
        scene = bpy.data.scenes.get(self.scene_name)
        if scene is None:
            raise Problem(f"The scene {self.scene_name} was removed")
        return scene

    def begin(self):
        """Takes the first frame, with the meshes."""
        scene = self.scene()
        with below_the_cloth(cloth_objects(scene)), at_frame(scene, self.first):
            depsgraph = depsgraph_of(scene)
            for name in self.names:
                self.snapshots[name] = snapshot(scene.objects[name], depsgraph, topology=True)
        self.input = scene_input(scene, self.names, self.snapshots, self.first, self.last)

    def notices(self):
        scene = self.scene()
        found = [n for name in self.cloths for n in notices_of(scene.objects[name], self.snapshots[name])]
        return found + fields_notices(scene)

    def write_meshes(self, folder):
        folder.mkdir(parents=True, exist_ok=True)
        for name, body in self.names.items():
            taken = self.snapshots[name]
            (folder / f"{body}.obj").write_text(taken.obj(self.scale), encoding="utf-8")
            for what, group in self.painted(name):
                (folder / maps.map_file(body, what)).write_text(maps.weights_text(taken.weights[group]), encoding="utf-8")
        for cloth in self.input.cloths:
            if not cloth.rest_mesh:
                continue
            name = next(n for n, body in self.names.items() if body == cloth.name)
            taken, base = self.snapshots[name], base_points(bpy.data.objects[name])
            if len(base) != len(taken.points):
                raise Problem(f"{name}: its base mesh has {len(base)} vertices, with the modifiers above Muslin "
                              f"{len(taken.points)}: set Rest Shape to At the Start")
            points = axes.to_muslin(base, taken.matrix, self.scale)
            (folder / cloth.rest_mesh).write_text(taken.obj(self.scale, points), encoding="utf-8")

    def painted(self, name):
        """(what, vertex group) of the maps of an object, the weights of soft pins and attachments among them."""
        if name not in self.cloths:
            return []
        obj = bpy.data.objects[name]
        m = obj.muslin
        pins = [(PINS, m.pin_group)] if m.use_soft_pins and m.pin_group else []
        return [(x.what.lower(), x.group) for x in m.maps] + pins + attachments.painted(obj)

    def follows(self, name):
        """Returns true if the object's points are needed in every frame."""
        if name not in self.cloths:
            return True
        return len(self.snapshots[name].pinned) > 0 and bpy.data.objects[name].muslin.pin_animated

    def step(self, seconds):
        """Samples frames for about this long; True when all are done."""
        end = time.monotonic() + seconds
        scene = self.scene()
        with below_the_cloth(cloth_objects(scene)), at_frame(scene, self.frame):
            while self.frame <= self.last:
                scene.frame_set(self.frame)
                self._sample(scene)
                self.frame += 1
                if time.monotonic() > end:
                    break
        return self.frame > self.last

    def _sample(self, scene):
        depsgraph = depsgraph_of(scene)
        self.air.sample(depsgraph)
        self.fields.sample(depsgraph)
        self.gravity.append(gravity_of(scene))
        for name, body in self.names.items():
            obj = scene.objects.get(name)
            if obj is None:
                raise Problem(f"{name} was deleted or renamed while it was sampled: bake again")
            if name in self.matrices:
                matrix = np.array(obj.evaluated_get(depsgraph).matrix_world)
                self.matrices[name].append(matrix)
                self.pressures[name].append(pressure_of(obj))
            if not self.follows(name):
                continue
            taken, first = snapshot(obj, depsgraph), self.snapshots[name]
            if len(taken.points) != len(first.points):
                raise Problem(f"{name} has {counted(len(first.points), 'vertex', 'vertices')} in frame {self.first} and "
                              f"{len(taken.points)} in frame {self.frame}: a modifier that changes the mesh must stand "
                              "below Muslin")
            points, start = taken.world(self.scale), first.world(self.scale)
            held = first.pinned if name in self.matrices else slice(None)
            size = max(float(np.ptp(start, axis=0).max()), 1e-9)
            if np.abs(points[held] - start[held]).max() > 1e-6 * size:
                self.moves[name] = True
            if name not in self.writers:
                self.writers[name] = point_cache.Writer(self.part(body), len(points))
            self.writers[name].append(points)

    def part(self, body):
        return self.folder / f"{body}.motion.pc2.part"

    def commit(self):
        """Puts everything in place; returns what playback needs."""
        for name, writer in self.writers.items():
            writer.close()
            body = self.names[name]
            target = self.folder / f"{body}.motion.pc2"
            if not self.moves.get(name):
                self.part(body).unlink()
                target.unlink(missing_ok=True)
                continue
            os.replace(self.part(body), target)
            for part in self.input.cloths:
                if part.name == body:
                    part.pin = target.name
            for part in self.input.colliders:
                if part.name == body:
                    part.sequence = target.name
        self.writers = {}
        self.input.wind, self.input.fields, self.input.gravity = self.air.wind(), self.fields.all(), self.gravity
        for name in self.cloths:
            next(c for c in self.input.cloths if c.name == self.names[name]).pressures = self.pressures[name]
        self.write_meshes(self.folder)
        (self.folder / "scene.toml").write_text(scene_toml(self.input), encoding="utf-8")
        objects = []
        for name in self.cloths:
            matrices = np.array(self.matrices[name])
            if (matrices == matrices[0]).all():
                matrices = matrices[:1]
            objects.append({"object": name, "body": self.names[name], "matrices": matrices.tolist()})
        files = [f"{body}.obj" for body in self.names.values()] + ["scene.toml"]
        files += [maps.map_file(body, what) for name, body in self.names.items() for what, _ in self.painted(name)]
        files += [c.rest_mesh for c in self.input.cloths if c.rest_mesh]
        files += [part.pin for part in self.input.cloths if part.pin]
        files += [part.sequence for part in self.input.colliders if part.sequence]
        return {"version": 1, "scene": self.scene_name, "frame_start": self.first, "frames": self.last - self.first,
                "scale": self.scale, "objects": objects, "files": files,
                "names": {body: name for name, body in self.names.items()}}

    def abandon(self):
        for name, writer in self.writers.items():
            writer.close()
            self.part(self.names[name]).unlink(missing_ok=True)
        self.writers = {}


@contextlib.contextmanager
def at_frame(scene, frame):
    """The scene at another frame, and back."""
    now, sub = scene.frame_current, scene.frame_subframe
    scene.frame_set(frame)
    try:
        yield
    finally:
        scene.frame_set(now, subframe=sub)
