"""The materials of the muslin program, asked once. No Blender needed."""

import json

from . import worker

_materials = {}  # program → list of what `muslin materials --json` gives
program = ""  # set by the preferences


def materials():
    if program and program not in _materials:
        try:
            code, out, _ = worker.ask(program, "materials", "--json")
            _materials[program] = json.loads(out) if code == 0 else []
        except (OSError, ValueError):
            return []
    return _materials.get(program, [])


def names(model):
    """Those that have numbers for the model, "shell" or "lattice"."""
    return [m["name"] for m in materials() if model in m]


def description(name):
    return next((m["description"] for m in materials() if m["name"] == name), "")


def guesses(name, model):
    """A sentence on which numbers of a material for the model, "shell" or "lattice", are not measured; "" if all are."""
    listed = next((m["guesses"] for m in materials() if m["name"] == name), [])
    words = [key.split(".")[1].replace("_", " ") for key in listed if key.startswith(model + ".")]
    return f"Guesses, not measured: {', '.join(words)}" if words else ""
