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


# The numbers that a slider or a painted map scales. Curves are pairs of strain or curvature and force or moment.
SCALED = {
    "weight": ("areal_density", "density"),
    "stiffness": ("membrane_warp", "membrane_weft", "membrane_shear", "warp_curve", "weft_curve", "shear_curve",
                  "edge_modulus", "face_diagonal_modulus", "body_diagonal_modulus", "volume_modulus", "youngs_modulus"),
    "bending": ("bending_warp", "bending_weft", "bending_bias", "bending_warp_curve", "bending_weft_curve"),
    "damping": ("stiffness_damping", "bending_damping"),
}


def numbers(name, model):
    """The numbers of a material of the library for the model, "shell" or "lattice"; None if it is not one."""
    return next((m[model] for m in materials() if m["name"] == name and model in m), None)


def scaled(numbers_, what, factor):
    """{key: value} of the numbers of `what`, a key of SCALED, times the factor."""
    result = {}
    for key in SCALED[what]:
        value = numbers_.get(key)
        if isinstance(value, list):
            result[key] = [[x, y * factor] for x, y in value]
        elif value:
            result[key] = value * factor
    return result
