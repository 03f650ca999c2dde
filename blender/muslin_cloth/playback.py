"""From the cache of a run to a Mesh Cache modifier on every cloth: PC2 files beside the .blend file, in each
object's own space, by a relative path. A machine without this add-on plays them."""

import json
import os
import pathlib

import bpy
import numpy as np

from . import axes, point_cache

MODIFIER = "Muslin"
DESCRIPTION = "bake.json"


def modifier_of(obj):
    """The Mesh Cache modifier that plays the bake, or None."""
    return next((m for m in obj.modifiers if m.type == "MESH_CACHE" and m.name.startswith(MODIFIER)), None)


def own_folder(scene):
    """Returns the folder for bakes of this file."""
    stem = pathlib.Path(bpy.data.filepath).stem
    safe = "".join(c if c.isalnum() or c in "-_ " else "_" for c in scene.name)
    return pathlib.Path(bpy.path.abspath("//")) / f"muslin_{stem}" / safe


def playing_folder(scene):
    """The folder whose bake the scene plays: after Save As under another name that of the earlier file. None if
    it plays none."""
    for obj in scene.objects:
        cache = modifier_of(obj) if obj.type == "MESH" else None
        if cache and cache.filepath:
            folder = pathlib.Path(bpy.path.abspath(cache.filepath)).parent
            if (folder / DESCRIPTION).exists():
                return folder
    return None


def read_description(folder):
    try:
        return json.loads((pathlib.Path(folder) / DESCRIPTION).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None


def write_description(folder, description):
    path = pathlib.Path(folder) / DESCRIPTION
    part = path.with_suffix(".part")
    part.write_text(json.dumps(description), encoding="utf-8")
    os.replace(part, path)


class Playback:
    """Follows a run's caches while they grow."""

    def __init__(self, folder, description):
        self.folder, self.description = pathlib.Path(folder), description
        self._readers, self._writers = {}, {}
        self._matrices = {o["body"]: np.array(o["matrices"], float) for o in description["objects"]}

    def path(self, body):
        return self.folder / f"{body}.pc2"

    def available(self):
        """Last frame that every body has in the run's caches; -1: none."""
        last = None
        for item in self.description["objects"]:
            try:
                samples = self._reader(item["body"]).samples()
            except (OSError, ValueError):
                return -1
            last = samples if last is None else min(last, samples)
        return (last or 0) - 1

    def _reader(self, body):
        if body not in self._readers:
            self._readers[body] = point_cache.Reader(self.folder / "run" / f"{body}.skin.pc2")
        return self._readers[body]

    def _matrix(self, body, frame):
        matrices = self._matrices[body]
        return matrices[min(frame, len(matrices) - 1)]

    def _writer(self, body):
        path, points = self.path(body), self._reader(body).points
        try:
            there = point_cache.Reader(path)
            keep = there.samples() if there.points == points else 0
        except (OSError, ValueError):
            keep = 0
        return point_cache.Writer(path, points, keep)

    def show(self, frame):
        """Extends or truncates the played caches to `frame`."""
        for item in self.description["objects"]:
            body = item["body"]
            if body not in self._writers:
                self._writers[body] = self._writer(body)
            writer, reader = self._writers[body], self._reader(body)
            writer.cut(frame + 1)
            while writer.samples <= frame:
                sample = writer.samples
                points = reader.read(sample)
                writer.append(axes.to_local(points, self._matrix(body, sample), self.description["scale"]))
            writer.flush()

    def remove(self):
        self.close()
        for item in self.description["objects"]:
            self.path(item["body"]).unlink(missing_ok=True)

    def close(self):
        for writer in self._writers.values():
            writer.close()
        self._writers = {}

    def attach(self, scene):
        """Lets the modifiers play: of the objects that play a bake already, whatever they are called by now, and else of
        the one with the name that it had."""
        for item in self.description["objects"]:
            path = self.path(item["body"])
            if not path.exists():
                continue
            named = scene.objects.get(item["object"])
            for obj in players(scene, path) or [named]:
                if obj and obj.type == "MESH" and obj.muslin.role == "CLOTH":
                    attach(obj, path, self.description["frame_start"])


def players(scene, path):
    """The objects whose modifier plays this file."""
    caches = ((obj, modifier_of(obj)) for obj in scene.objects if obj.type == "MESH")
    return [obj for obj, cache in caches
            if cache and cache.filepath and pathlib.Path(bpy.path.abspath(cache.filepath)) == path]


def ensure_modifier(obj):
    """Adds a Mesh Cache modifier after all modifiers that deform the cloth and before those that refine it."""
    cache = modifier_of(obj)
    if cache:
        return cache
    cache = obj.modifiers.new(MODIFIER, "MESH_CACHE")
    refining = ("SUBSURF", "SOLIDIFY", "BEVEL", "MULTIRES", "SMOOTH", "CORRECTIVE_SMOOTH", "WEIGHTED_NORMAL", "WIREFRAME",
                "REMESH", "DECIMATE", "TRIANGULATE", "NODES")
    place = len(obj.modifiers) - 1
    while place > 0 and obj.modifiers[place - 1].type in refining:
        place -= 1
    move_modifier(obj, cache, place)
    return obj.modifiers[place]


def move_modifier(obj, modifier, place):
    if hasattr(obj.modifiers, "move"):  # not in Blender 3.4
        obj.modifiers.move(obj.modifiers.find(modifier.name), place)
        return
    with bpy.context.temp_override(object=obj, active_object=obj):
        bpy.ops.object.modifier_move_to_index(modifier=modifier.name, index=place)


SETTINGS = {"cache_format": "PC2", "deform_mode": "OVERWRITE", "time_mode": "FRAME", "play_mode": "SCENE",
            "interpolation": "LINEAR", "forward_axis": "POS_Y", "up_axis": "POS_Z", "factor": 1.0, "frame_scale": 1.0}


def attach(obj, path, frame_start):
    """Shows sample n in frame frame_start + n. Settings that are already right are not touched."""
    cache = ensure_modifier(obj)
    wanted = dict(SETTINGS, filepath=bpy.path.relpath(str(path)), frame_start=float(frame_start))
    for name, value in wanted.items():
        if getattr(cache, name) != value:
            setattr(cache, name, value)
    obj.update_tag(refresh={"DATA"})


def detach(scene):
    for obj in scene.objects:
        cache = modifier_of(obj) if obj.type == "MESH" else None
        if cache and cache.filepath:
            cache.filepath = ""
            obj.update_tag(refresh={"DATA"})


def remove_files(folder):
    """Removes the files of a bake from its folder, and nothing else."""
    folder = pathlib.Path(folder)
    description = read_description(folder) or {"objects": [], "files": []}
    names = [*description["files"], *(f"{o['body']}.pc2" for o in description["objects"]), "worker.log", DESCRIPTION]
    for name in names:
        (folder / name).unlink(missing_ok=True)
    for sub in ("check", "run"):
        remove_tree(folder / sub)
    for empty in (folder, folder.parent):
        try:
            empty.rmdir()
        except OSError:
            break


def remove_tree(folder):
    """The folder with its files and one level of folders: what a run and a check are."""
    if not folder.is_dir():
        return
    for path in sorted(folder.rglob("*"), reverse=True):
        if path.is_dir():
            path.rmdir()
        else:
            path.unlink()
    folder.rmdir()
