"""Modules of the add-on that need no Blender, loaded without its __init__, which does."""

import importlib
import pathlib
import sys
import types

ADDON = pathlib.Path(__file__).resolve().parent.parent / "muslin_cloth"


def load(name):
    if "muslin_cloth" not in sys.modules:
        package = types.ModuleType("muslin_cloth")
        package.__path__ = [str(ADDON)]
        sys.modules["muslin_cloth"] = package
    return importlib.import_module("muslin_cloth." + name)
