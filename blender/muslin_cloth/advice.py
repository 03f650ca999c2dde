"""Notices about meshes and bakes, and the program's messages, in Blender's terms. Needs no Blender."""

import re
from dataclasses import dataclass

ERROR, WARNING, INFO = "ERROR", "WARNING", "INFO"


@dataclass(frozen=True)
class Notice:
    level: str
    text: str
    object: str = ""


def counted(n, one, many=None):
    return f"{n:,} {one if n == 1 else many or one + 's'}".replace(",", " ")


def of_report(report, model, name):
    """Notices about a mesh from what `muslin check MESH --json` says of it. `model`: "shell", "lattice" or
    "collider"."""
    notices = []

    def say(level, text):
        notices.append(Notice(level, text, name))

    shell = model == "shell"
    bad = ERROR if shell else WARNING
    if report["faces"] == 0:
        say(ERROR, "The mesh has no faces: fill it, or choose another object")
        return notices
    if report["non_manifold_edges"] and not shell:
        n = counted(report["non_manifold_edges"], "edge is", "edges are")
        say(WARNING, f"{n} shared by three or more faces: Select > All by Trait > Non Manifold, and separate them")
    if report["degenerate_faces"]:
        n = counted(report["degenerate_faces"], "face has", "faces have")
        say(bad, f"{n} no area: Mesh > Clean Up > Degenerate Dissolve")
    if report["duplicate_faces"]:
        n = counted(report["duplicate_faces"], "face is", "faces are")
        say(bad, f"{n} there twice: Mesh > Merge > By Distance")
    if report["unused_vertices"]:
        n = counted(report["unused_vertices"], "vertex belongs", "vertices belong")
        say(bad, f"{n} to no face: Mesh > Clean Up > Delete Loose")
    if report["near_border_vertices"] > 1:
        n = counted(report["near_border_vertices"], "vertex", "vertices")
        say(WARNING, f"{n} on borders nearly coincide with others, so that the borders come apart: "
                     f"Mesh > Merge > By Distance, {1.5 * report['near_border_distance']:.2g} m")
    if report["flipped_edges"]:
        n = counted(report["flipped_edges"], "edge", "edges")
        say(WARNING, f"Faces disagree about their front side along {n}: Mesh > Normals > Recalculate Outside")
    if model == "lattice" and not report["closed"]:
        say(INFO, f"The mesh is open along {counted(report['open_edges'], 'edge')}: it is baked with its thickness")
    if shell and report["closed"]:
        say(INFO, "The mesh is closed: as a shell it is a hollow skin; choose Solid to fill it")
    size = max(b - a for a, b in zip(report["min"], report["max"]))
    if size > (20 if shell else 200) or size < 1e-3:
        say(WARNING, f"It is {size:.4g} m across: check the scale of the object and Unit Scale of the scene")
    return notices


def of_polygons(sizes, name):
    """n-gons are allowed, but how they are cut decides how they fold."""
    large = sum(1 for n in sizes if n > 4)
    if not large:
        return []
    return [Notice(INFO, f"{counted(large, 'n-gon is', 'n-gons are')} cut into triangles: Face > Triangulate shows how",
                   name)]


def problem_line(stderr):
    """Returns the error that muslin printed: the last line that begins with `muslin: `, without that prefix."""
    lines = [line for line in stderr.splitlines() if line.startswith("muslin: ")]
    errors = [line for line in lines if not line.startswith(("muslin: warning: ", "muslin: resumed with "))]
    return errors[-1][len("muslin: "):] if errors else ""


def split_problem(text):
    """Returns (problem, remedy) of an error `…; remedy`."""
    what, mark, remedy = text.rpartition("; ")
    return (what, remedy) if mark else (text, "")


# Terms that the command line and the panel name differently.
WORDS = (("restart the run without --resume", "use Bake, from the start"),
         ("restart the run", "use Bake, from the start"), ("time.steps_per_frame", "Steps per Frame"),
         ("`steps_per_frame`", "Steps per Frame"), ("`voxel_width`", "Voxel Width"), ("voxel_width", "Voxel Width"),
         ("`thickness`", "Thickness"), (", then continue with --resume", ", then press Resume"),
         ("`stretch_limit`", "Stretch Limit"), ("set `separate_parts = true`", "check Separate Parts"),
         ("`rest_mesh`", "Rest Shape"), ("`self_contact = false`", "Self Contact off"), ("`self_contact`", "Self Contact"),
         ("give `stiffness`, a larger `break_force`, or `rest = \"distance\"`",
          "check Soft, raise Breaks, or choose Rod under Attachments"),
         ("lower `stiffness` and `damping`, or leave them out for joints as stiff as the bodies",
          "lower Soft and Damping under Attachments, or uncheck Soft"),
         ("`tangled = \"repair\"`", "Repair under Tangled Start"), ("`layer`", "Layer"),
         ("their keyframes", "their animation"),
         ("; --picture FILE.png shows where", ", or choose Repair under Tangled Start"))


PARTS = ((".material", "Fabric"), (".voxel_width", "Voxel Width"), (".thickness", "Thickness"), (".model", "Kind"),
         (".rest_mesh", "Rest Shape"), (".mesh", "The mesh"))


def in_blender(problem, names):
    """An error of muslin without the paths of files the artist never saw, bodies by their objects' names."""
    for mark in ("scene.toml: ", "scene.toml:"):
        if mark in problem.split("; ")[0]:
            problem = problem.split(mark, 1)[1]
            problem = problem.lstrip("0123456789:").lstrip()
            break
    for body, name in names.items():
        mark = f"/{body}.obj: "
        if mark in problem.split("; ")[0]:
            problem = f"{name}: {problem.split(mark, 1)[1]}"
    changed = "the bodies are not those of the run to resume; changed: "
    if changed in problem:
        settings = problem.split(changed)[1].split("; ")[0].split(", ")
        parts = dict.fromkeys(next((panel for key, panel in PARTS if key in s), s) for s in settings)
        return f"{', '.join(parts)} changed since the first frame; undo the change, or use Bake, from the start"
    for body, name in names.items():
        problem = problem.replace(f"`{body}`", f"\"{name}\"")
    for word, in_panel in WORDS:
        problem = problem.replace(word, in_panel)
    return problem


def crossing_faces(crossings, names):
    """{object: numbers of its faces that cross something, ascending} of what `muslin check SCENE --json` lists."""
    faces = {}
    for crossing in crossings:
        for body, face in zip(crossing["bodies"], crossing["faces"]):
            if face is not None and body in names:
                faces.setdefault(names[body], set()).add(face)
    return {name: sorted(found) for name, found in faces.items()}


def warnings_of(warnings, names, said=(), first_frame=0):
    """The program's warnings as notices of objects, without those `said`. `names`: body → object; frames of the run
    count from `first_frame`."""
    notices = []
    for warning in warnings:
        body, colon, text = warning.removeprefix("body ").partition(": ")
        if not warning.startswith("body ") or not colon:
            body, text = "", warning
        if text in said:
            continue
        text = re.sub(r"\bframes? \d+(?:(?: to |, | and )\d+)*",
                      lambda found: re.sub(r"\d+", lambda n: str(int(n[0]) + first_frame), found[0]), text)
        text = in_blender(text, names)
        notices.append(Notice(WARNING, text[:1].upper() + text[1:], names.get(body, "")))
    return notices


def estimate_voxels(area, volume, closed, thickness, width):
    """Estimates the number of voxels of a lattice: the volume inside, and half a voxel over the whole surface."""
    if width <= 0:
        return 0
    if closed and volume > 0:
        return round(volume / width**3 + 0.75 * area / width**2)
    layers = max(1.0, (thickness or width) / width) + 0.5
    return round(area / width**2 * layers)


def suggest_width(area, volume, closed, thickness, target=8000):
    """Returns the voxel width that gives about `target` voxels, to two digits."""
    if area <= 0:
        return 0.0
    low, high = 1e-9 * area**0.5, 10 * area**0.5
    for _ in range(200):
        middle = (low * high) ** 0.5
        if estimate_voxels(area, volume, closed, thickness, middle) > target:
            low = middle
        else:
            high = middle
    return float(f"{high:.2g}")
